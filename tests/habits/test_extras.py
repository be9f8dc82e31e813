"""Without an extra roughgas simulates all the same, and says in a line what to install."""

import pytest
from tests.habits.conftest import python

from roughgas.base import EXTRAS

POINT = "cooling --scale small --r 0.9 --beta 0.5"
WITHOUT_ANY = {
    "run": f"run {POINT} -o point.nc",
    "summary": f"run {POINT} --seed 2",
    "trajectory": f"trajectory {POINT} --times 0 1 -o gas.xyz",
    "show": "show point.nc",
    "reduce": "reduce point.nc -o cooling.nc",
    "theory": "theory --r 0.9 --beta 0.5",
    "completion": "completion bash",
}
WITH_ONE = {
    "figures": f"movie {POINT} -o gas.gif",
    "report": "document text.md -o text.html",
    "trajectories": f"trajectory {POINT} -o gas.gsd",
}
BLOCKED = """
import sys
sys.modules.update(dict.fromkeys({packages!r}))
from roughgas import cli, steps
main = (steps if sys.argv[1] in steps.STEPS else cli).main
sys.exit(main(sys.argv[1:]))
"""

EXAMINED = """
import sys
sys.modules.update(dict.fromkeys({packages!r}))
from roughgas import doctor
names = "libraries", "extras", "Snakemake"
doctor.CHECKS = dict((name, doctor.CHECKS[name]) for name in names)
doctor.doctor(False)
"""


def told(line, folder):
    """A finished process of `roughgas`, in an environment without the packages of any extra."""
    packages = [package for brought in EXTRAS.values() for package in brought]
    return python("-c", BLOCKED.format(packages=packages), *line.split(), cwd=folder)


def test_what_simulates_needs_no_extra(tmp_path):
    for name, line in WITHOUT_ANY.items():
        done = told(line, tmp_path)
        assert done.returncode == 0, (name, done.stderr)
    assert (tmp_path / "gas.xyz").exists()


@pytest.mark.parametrize("extra", WITH_ONE)
def test_an_extra_that_lacks_is_named_in_a_line(extra, tmp_path):
    (tmp_path / "text.md").write_text("# A text\n")
    done = told(WITH_ONE[extra], tmp_path)
    package = EXTRAS[extra][0]
    said = f"{package} is not installed: pip install 'roughgas[{extra}]'"
    assert (done.returncode, done.stdout) == (1, "")
    assert done.stderr == f"roughgas: error: {said}\n"
    assert [path.name for path in tmp_path.iterdir()] == ["text.md"]


def test_the_doctor_says_what_is_left_out(tmp_path):
    packages = [package for brought in EXTRAS.values() for package in brought]
    done = python("-c", EXAMINED.format(packages=packages), cwd=tmp_path)
    assert done.returncode == 0, done.stdout + done.stderr
    assert (
        "none; not installed: workflow, figures, movies, report, crate, trajectories" in done.stdout
    )
