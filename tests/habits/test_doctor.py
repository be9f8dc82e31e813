"""`roughgas doctor` on installations that are broken on purpose."""

import json
import sys

import pytest
from tests.habits.conftest import ROOT, python, roughgas

from roughgas import doctor
from roughgas.doctor import CHECKS, OK, PROBLEM, WARNING

ONE = """
import json, sys
from roughgas import doctor
doctor.CHECKS = {sys.argv[1]: doctor.CHECKS[sys.argv[1]]}
print(json.dumps([found for _, found in doctor.examine()]))
"""


def check(name, monkeypatch):
    """The diagnosis of one check, as the doctor gives it."""
    monkeypatch.setattr(doctor, "CHECKS", {name: CHECKS[name]})
    ((_, found),) = doctor.examine()
    return found


def check_alone(name, cwd, program=ONE, **others):
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
    assert sys.executable in found["packages"]["said"]


def test_the_configuration_in_use_is_told(tmp_path, monkeypatch):
    monkeypatch.chdir(ROOT)
    found = check("configuration", monkeypatch)
    assert found.verdict == OK and f"{ROOT / 'config.yaml'}, of this folder" in found.said
    monkeypatch.chdir(tmp_path)
    found = check("configuration", monkeypatch)
    assert found.verdict == OK and "the one that comes with roughgas" in found.said
    (tmp_path / "config.yaml").write_text("scale: paper\n")
    found = check("configuration", monkeypatch)
    assert found.verdict == PROBLEM and found.said.startswith("config.yaml")


def test_a_problem_is_told_in_words_and_by_the_exit_status(monkeypatch, capsys):
    monkeypatch.setattr(doctor, "CHECKS", {"versions": doctor.package, "movies": doctor.movie})
    monkeypatch.setenv("IMAGEIO_FFMPEG_EXE", "/bin/false")
    with pytest.raises(SystemExit) as stop:
        doctor.doctor(as_json=False, clean=False)
    assert stop.value.code == 1
    fine, problem, remedy, _, last = capsys.readouterr().out.splitlines()
    assert fine.startswith("ok ") and problem.startswith("problem  movies ")
    assert remedy.strip().startswith("-> unset IMAGEIO_FFMPEG_EXE") and last == "1 problem"


@pytest.mark.parametrize(
    ("name", "changes", "verdict", "said", "remedy"),
    [
        ("kernel", {"NUMBA_DISABLE_JIT": "1"}, PROBLEM, "NUMBA_DISABLE_JIT", ""),
        ("kernel cache", {"ROUGHGAS_CACHE_DIR": "/proc/x"}, WARNING, "/proc/x", "ROUGHGAS_CACHE"),
        ("movies", {"IMAGEIO_FFMPEG_EXE": "/bin/false"}, PROBLEM, "/bin/false", "unset IMAGEIO"),
        ("Snakemake", {"XDG_CACHE_HOME": "/proc/sys"}, PROBLEM, "be written", "XDG_CACHE_HOME"),
    ],
)
def test_what_the_environment_breaks(monkeypatch, name, changes, verdict, said, remedy):
    for variable, value in changes.items():
        monkeypatch.setenv(variable, value)
    found = check(name, monkeypatch)
    assert found.verdict == verdict and said in found.said and remedy in found.remedy, found


def test_a_file_that_shadows_a_library(tmp_path):
    (tmp_path / "argcomplete.py").write_text("__version__ = '1'")
    found = check_alone("packages", tmp_path, PYTHONPATH=f"{tmp_path}:{ROOT / 'src'}")
    assert found[0] == WARNING and f"{tmp_path / 'argcomplete.py'} away" in found[2]


def test_a_library_that_is_missing_or_broken(monkeypatch):
    monkeypatch.setitem(sys.modules, "tqdm", None)
    monkeypatch.setattr(doctor, "MODULES", "tqdm")
    monkeypatch.setattr(doctor.util, "find_spec", lambda _: None)
    found = check("packages", monkeypatch)
    assert found.verdict == PROBLEM and "tqdm" in found.said and "make setup" in found.remedy


def test_other_versions_than_the_pinned_ones(tmp_path, monkeypatch):
    lock = (ROOT / "requirements.lock").read_text()
    (tmp_path / "requirements.lock").write_text(lock.replace("pyyaml==", "pyyaml==99.", 1))
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(doctor, "PACKAGE", tmp_path / "nowhere" / "src" / "roughgas")
    found = check("versions", monkeypatch)
    assert found.verdict == WARNING and "pyyaml " in found.said and "99." in found.said


@pytest.mark.parametrize(
    ("broken", "said"),
    [
        ({"KNOWN": "others"}, "other bits"),
        ({"TRIAL": "import os; os.kill(os.getpid(), 11)"}, "crashed with signal 11"),
    ],
)
def test_a_kernel_that_is_wrong_or_crashes(monkeypatch, broken, said):
    for name, value in broken.items():
        monkeypatch.setattr(doctor, name, value)
    found = check("kernel", monkeypatch)
    assert found.verdict == PROBLEM and said in found.said and "kernel cache" in found.remedy


def test_sources_of_another_folder(tmp_path, monkeypatch):
    (tmp_path / "src" / "roughgas").mkdir(parents=True)
    monkeypatch.chdir(tmp_path)
    found = check("roughgas", monkeypatch)
    assert found.verdict == WARNING and str(tmp_path) in found.said


def test_disks_that_cannot_be_written_or_are_full(tmp_path, mounts):
    (tmp_path / "disk").mkdir()
    inside = f"import os; os.chdir('disk')\n{ONE}"
    found = check_alone("this folder", tmp_path, inside, mount=("ro", "disk"))
    assert found[0] == PROBLEM and "cannot be written" in found[1]
    found = check_alone("this folder", tmp_path, inside, mount=("size=1m", "disk"))
    assert found[0] == WARNING and "make room" in found[2]
    found = check_alone("temporary files", tmp_path, mount=("size=4k", "disk"), TMPDIR="disk")
    assert found[0] != OK and "disk" in found[1]


def test_kernels_of_other_versions_are_removed_on_request(tmp_path, monkeypatch, capsys):
    old = tmp_path / "kernels-0123456789abcdef"
    old.mkdir()
    (old / "code.nbc").write_bytes(bytes(2**20))
    monkeypatch.setenv("ROUGHGAS_CACHE_DIR", str(tmp_path))
    doctor.doctor(as_json=False, clean=True)
    assert capsys.readouterr().out.endswith("1 MiB: removed\n")
    assert [path.name.startswith("kernels-") for path in tmp_path.iterdir()] == [True]
    assert not old.exists()
