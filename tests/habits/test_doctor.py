"""`roughgas doctor` on installations that are broken on purpose, in processes of their own."""

import json
import sys

import pytest

from habits.conftest import ROOT, python, roughgas
from roughgas.doctor import CHECKS, OK, PROBLEM, WARNING

ONE = """
import json, sys
from roughgas import doctor
doctor.CHECKS = {sys.argv[1]: doctor.CHECKS[sys.argv[1]]}
print(json.dumps([found for _, found in doctor.examine()]))
"""


def check(name, cwd, program=ONE, **others):
    done = python("-c", program, name, cwd=cwd, **others)
    assert done.returncode == 0, done.stderr
    (found,) = json.loads(done.stdout)
    return found


def test_an_installation_as_it_should_be():
    done = roughgas("doctor", "--json", cwd=ROOT)
    found = json.loads(done.stdout)
    assert list(found) == list(CHECKS)
    problems = {name: about for name, about in found.items() if about["verdict"] == PROBLEM}
    assert (done.returncode, problems, done.stderr) == (0, {}, "")
    assert found["kernel"]["said"] == "the trial run gives the same bits as elsewhere"


def test_a_problem_is_told_in_words_and_by_the_exit_status(tmp_path):
    (tmp_path / "config.yaml").write_text("scal: paper\n")
    done = roughgas("doctor", cwd=tmp_path)
    assert done.returncode == 1
    lines = done.stdout.splitlines()
    place = next(k for k, line in enumerate(lines) if line.startswith("problem"))
    assert "config.yaml" in lines[place] and "did you mean scale?" in lines[place]
    assert lines[place + 1].strip() == "-> correct it"
    assert lines[-1].startswith("1 problem")


@pytest.mark.parametrize(
    ("name", "changes", "verdict", "said", "remedy"),
    [
        ("environment", {"NUMBA_OPT": "0"}, WARNING, "NUMBA_OPT=0", "unset NUMBA_OPT"),
        ("kernel", {"NUMBA_DISABLE_JIT": "1"}, PROBLEM, "NUMBA_DISABLE_JIT", ""),
        ("kernel cache", {"ROUGHGAS_CACHE_DIR": "/proc/x"}, WARNING, "/proc/x", "ROUGHGAS_CACHE"),
        ("movies", {"IMAGEIO_FFMPEG_EXE": "/bin/false"}, PROBLEM, "/bin/false", "unset IMAGEIO"),
        ("Snakemake", {"XDG_CACHE_HOME": "/proc"}, PROBLEM, "cannot be written", "XDG_CACHE_HOME"),
    ],
)
def test_what_the_environment_breaks(tmp_path, name, changes, verdict, said, remedy):
    if changes.get("XDG_CACHE_HOME") == "/proc":
        changes = {"XDG_CACHE_HOME": "/proc/sys"}
    found = check(name, tmp_path, **changes)
    assert found[0] == verdict and said in found[1] and remedy in found[2], found


@pytest.mark.parametrize(
    ("text", "verdict"), [("raise RuntimeError('no')", PROBLEM), ("__version__ = '1'", WARNING)]
)
def test_a_file_that_shadows_a_library(tmp_path, text, verdict):
    (tmp_path / "emcee.py").write_text(text)
    found = check("packages", tmp_path, PYTHONPATH=f"{tmp_path}:{ROOT / 'src'}")
    assert found[0] == verdict and str(tmp_path / "emcee.py") in found[1] + found[2]
    assert "move it away" in found[2]


def test_other_versions_than_the_pinned_ones(tmp_path):
    lock = (ROOT / "requirements.lock").read_text()
    (tmp_path / "requirements.lock").write_text(lock.replace("pyyaml==", "pyyaml==99.", 1))
    program = (
        "from roughgas.doctor import installation\n"
        "installation.PACKAGE = installation.Path('/nowhere/src/roughgas')\n" + ONE
    )
    found = check("versions", tmp_path, program)
    assert found[0] == WARNING and "pyyaml" in found[1] and "99." in found[1]


@pytest.mark.parametrize(
    ("break_it", "said"),
    [
        ("trials.KNOWN = 'others'", "other bits"),
        ("trials.PROGRAM = 'import os; os.kill(os.getpid(), 11)'", "crashed with signal 11"),
    ],
)
def test_a_kernel_that_is_wrong_or_crashes(tmp_path, break_it, said):
    found = check("kernel", tmp_path, f"from roughgas.doctor import trials\n{break_it}\n{ONE}")
    assert found[0] == PROBLEM and said in found[1] and "kernel cache" in found[2]


def test_sources_of_another_folder(tmp_path):
    (tmp_path / "src" / "roughgas").mkdir(parents=True)
    found = check("roughgas", tmp_path)
    assert found[0] == WARNING and str(tmp_path) in found[1]


def test_disks_that_cannot_be_written_or_are_full(tmp_path, mounts):
    (tmp_path / "disk").mkdir()
    inside = f"import os; os.chdir('disk')\n{ONE}"
    found = check("this folder", tmp_path, inside, mount=("ro", "disk"))
    assert found[0] == PROBLEM and "cannot be written" in found[1]
    found = check("this folder", tmp_path, inside, mount=("size=1m", "disk"))
    assert found[0] == WARNING and "make room" in found[2]
    found = check("temporary files", tmp_path, mount=("size=4k", "disk"), TMPDIR="disk")
    assert found[0] != OK and "disk" in found[1]


def test_kernels_of_other_versions_are_removed_on_request(tmp_path):
    old = tmp_path / "kernels-0123456789abcdef"
    old.mkdir()
    (old / "code.nbc").write_bytes(bytes(2**20))
    keep = {"ROUGHGAS_CACHE_DIR": str(tmp_path)}
    assert "1 folders of other versions, 1 MiB" in check("kernel cache", tmp_path, **keep)[1]
    done = roughgas("doctor", "--clean", cwd=tmp_path, **keep)
    assert done.returncode == 0 and done.stdout.endswith("1 MiB: removed\n")
    assert [path.name.startswith("kernels-") for path in tmp_path.iterdir()] == [True]
    assert not old.exists() and sys.executable in check("Python", tmp_path)[1]
