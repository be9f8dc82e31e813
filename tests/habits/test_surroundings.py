"""An installation and its surroundings: the doctor, extras, folders, a reader that leaves."""

import json
import os
import subprocess
import sys
from argparse import Namespace

import pytest
from schedules import TINY
from tests.habits.conftest import ROOT, environment, point, python, roughgas

from roughgas import doctor
from roughgas.base import EXTRAS

pytestmark = pytest.mark.slow


def test_who_reads_only_the_beginning_sees_no_traceback(tmp_path):
    reader, writer = os.pipe()
    os.close(reader)
    done = subprocess.run(
        [sys.executable, "-m", "roughgas", "experiments"],
        stdout=writer,
        stderr=subprocess.PIPE,
        env=environment(ROUGHGAS_CACHE_DIR=str(tmp_path)),
    )
    os.close(writer)
    assert (done.returncode, done.stderr) == (141, b"")


def test_closed_streams(tmp_path):
    command = [sys.executable, "-m", "roughgas", *point("point.nc")]
    script = 'exec "$@" <&- >&- 2>&-'
    done = subprocess.run(["sh", "-c", script, "sh", *command], cwd=tmp_path, env=environment())
    assert done.returncode == 0
    assert [path.name for path in tmp_path.iterdir()] == ["point.nc"]


def test_a_full_disk_is_said_in_one_line(tmp_path, mounts):
    (tmp_path / "disk").mkdir()
    done = roughgas(*point("disk/point.nc"), cwd=tmp_path, mount=("size=4k", "disk"))
    assert done.returncode == 1 and done.stderr.count("\n") == 1
    assert done.stderr.startswith("roughgas: error: cannot write disk/point.nc")
    assert "is the disk full" in done.stderr


def test_what_is_no_file_is_not_replaced(tmp_path):
    """A device, which root could replace, or here a pipe."""
    os.mkfifo(tmp_path / "pipe")
    done = roughgas(*point("pipe"), cwd=tmp_path)
    assert done.returncode == 1
    assert done.stderr == f"roughgas: error: {tmp_path / 'pipe'}: exists and is not a file\n"
    assert (tmp_path / "pipe").is_fifo()


def test_memory_that_runs_out(tmp_path):
    script = 'ulimit -v 2000000; exec "$@"'
    many = {"particles": 10**8, "box": [10**5, 10**5]}
    command = [sys.executable, "-m", "roughgas", *point("point.nc", TINY | many)]
    done = subprocess.run(
        ["sh", "-c", script, "sh", *command],
        cwd=tmp_path,
        env=environment(),
        capture_output=True,
        text=True,
    )
    assert done.returncode == 1
    said = [line for line in done.stderr.splitlines() if " so far" not in line]  # where it is slow
    assert len(said) == 1 and list(tmp_path.iterdir()) == []
    assert said[0].startswith("roughgas: error: out of memory. Unable to allocate")


def check(name, monkeypatch, capsys):
    """What one check says, and whether it is content."""
    monkeypatch.setattr(doctor, "CHECKS", {name: doctor.CHECKS[name]})
    try:
        doctor.doctor(Namespace(json=True))
        status = 0
    except SystemExit as stop:
        status = stop.code
    found = json.loads(capsys.readouterr().out)[name]
    assert found["ok"] == (status == 0)
    return found["said"], found["ok"]


def test_an_installation_as_it_should_be():
    done = roughgas("doctor", "--json", cwd=ROOT)
    found = json.loads(done.stdout)
    assert list(found) == list(doctor.CHECKS)
    problems = {name: about for name, about in found.items() if not about["ok"]}
    assert (done.returncode, problems, done.stderr) == (0, {}, "")
    assert sys.executable in found["libraries"]["said"]
    assert str(ROOT / "config.yaml") in found["configuration"]["said"]


def test_a_problem_is_told_in_words_and_by_the_exit_status(monkeypatch, capsys):
    monkeypatch.setattr(doctor, "CHECKS", {name: doctor.CHECKS[name] for name in ("extras",)})
    monkeypatch.setitem(sys.modules, "gsd", None)
    doctor.doctor(Namespace(json=False))
    assert capsys.readouterr().out.endswith("crate, article; not installed: trajectories\n")
    monkeypatch.setattr(doctor, "LIBRARIES", "tqdm gsd")
    monkeypatch.setattr(doctor, "CHECKS", {"libraries": (doctor._libraries, "mend it")})
    with pytest.raises(SystemExit) as stop:
        doctor.doctor(Namespace(json=False))
    said = capsys.readouterr().out
    assert stop.value.code == 1 and said.startswith("problem  libraries ")
    assert "gsd" in said and said.endswith("-> mend it\n")


@pytest.mark.parametrize(
    ("broken", "said"),
    [
        ({"KNOWN": 0.3}, "a trial run has R = 0.4453"),
        ({"TRIAL": "import os; os.kill(os.getpid(), 11)"}, "a trial run crashed: signal 11"),
    ],
)
def test_a_kernel_that_is_wrong_or_crashes(monkeypatch, capsys, broken, said):
    for name, value in broken.items():
        monkeypatch.setattr(doctor, name, value)
    told, fine = check("kernel", monkeypatch, capsys)
    assert not fine and said in told


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
