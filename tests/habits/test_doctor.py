"""`roughgas doctor` on installations that are broken on purpose."""

import json
import sys

import pytest
from tests.habits.conftest import ROOT, python, roughgas

from roughgas import doctor

ALONE = """
import json, sys
from roughgas import doctor
doctor.CHECKS = {sys.argv[1]: doctor.CHECKS[sys.argv[1]]}
doctor.doctor(as_json=True)
"""


def check(name, monkeypatch, capsys):
    """What one check says, and whether it is content."""
    monkeypatch.setattr(doctor, "CHECKS", {name: doctor.CHECKS[name]})
    try:
        doctor.doctor(as_json=True)
        status = 0
    except SystemExit as stop:
        status = stop.code
    found = json.loads(capsys.readouterr().out)[name]
    assert found["ok"] == (status == 0)
    return found["said"], found["ok"]


def check_alone(name, cwd, program=ALONE, **others):
    return json.loads(python("-c", program, name, cwd=cwd, **others).stdout)[name]


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
    doctor.doctor(as_json=False)
    assert capsys.readouterr().out.endswith("crate; not installed: trajectories\n")
    monkeypatch.setattr(doctor, "LIBRARIES", "tqdm gsd")
    monkeypatch.setattr(doctor, "CHECKS", {"libraries": (doctor._libraries, "mend it")})
    with pytest.raises(SystemExit) as stop:
        doctor.doctor(as_json=False)
    said = capsys.readouterr().out
    assert stop.value.code == 1 and said.startswith("problem  libraries ")
    assert "gsd" in said and said.endswith("-> mend it\n")


@pytest.mark.parametrize(
    ("name", "changes", "said", "remedy"),
    [
        ("kernel", {"NUMBA_DISABLE_JIT": "1"}, "NUMBA_DISABLE_JIT", "remove the kernels"),
        ("kernel cache", {"ROUGHGAS_CACHE_DIR": "/proc/x"}, "/proc/x", "ROUGHGAS_CACHE"),
        ("Snakemake", {"XDG_CACHE_HOME": "/proc/sys"}, "be written", "XDG_CACHE_HOME"),
    ],
)
def test_what_the_environment_breaks(monkeypatch, capsys, name, changes, said, remedy):
    for variable, value in changes.items():
        monkeypatch.setenv(variable, value)
    told, fine = check(name, monkeypatch, capsys)
    assert not fine and said in told and remedy in told.partition(" -> ")[2], told


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


def test_disks_that_cannot_be_written_or_are_full(tmp_path, mounts):
    (tmp_path / "disk").mkdir()
    inside = f"import os; os.chdir('disk')\n{ALONE}"
    found = check_alone("this folder", tmp_path, inside, mount=("ro", "disk"))
    assert not found["ok"] and "Read-only" in found["said"]
    found = check_alone("this folder", tmp_path, inside, mount=("size=1m", "disk"))
    assert not found["ok"] and "make room" in found["said"]
