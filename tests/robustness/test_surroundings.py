"""An installation and its surroundings: the doctor, extras, folders, a reader that leaves."""

import json
import os
import subprocess
import sys

import pytest
from schedules import TINY
from tests.robustness.conftest import ROOT, environment, python, roughgas, run_arguments

from roughgas import doctor
from roughgas.base import EXTRAS

pytestmark = pytest.mark.slow


def test_a_reader_that_leaves_early_sees_no_traceback(tmp_path):
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


def test_a_run_with_closed_streams_writes_its_point(tmp_path):
    command = [sys.executable, "-m", "roughgas", *run_arguments("point.nc")]
    script = 'exec "$@" <&- >&- 2>&-'
    done = subprocess.run(["sh", "-c", script, "sh", *command], cwd=tmp_path, env=environment())
    assert done.returncode == 0
    assert [path.name for path in tmp_path.iterdir()] == ["point.nc"]


def test_a_full_disk_is_reported_in_one_line(tmp_path, mounts):
    (tmp_path / "disk").mkdir()
    done = roughgas(*run_arguments("disk/point.nc"), cwd=tmp_path, mount=("size=4k", "disk"))
    assert done.returncode == 1 and done.stderr.count("\n") == 1
    assert done.stderr.startswith("roughgas: error: cannot write disk/point.nc")
    assert "is the disk full" in done.stderr


def test_a_pipe_is_not_replaced(tmp_path):
    """A device, which root could replace, or here a pipe."""
    os.mkfifo(tmp_path / "pipe")
    done = roughgas(*run_arguments("pipe"), cwd=tmp_path)
    assert done.returncode == 1
    assert done.stderr == f"roughgas: error: {tmp_path / 'pipe'}: exists and is not a file\n"
    assert (tmp_path / "pipe").is_fifo()


def test_exhausted_memory_is_reported_in_one_line(tmp_path):
    script = 'ulimit -v 2000000; exec "$@"'
    huge = {"particles": 10**8, "box": [10**5, 10**5]}
    command = [sys.executable, "-m", "roughgas", *run_arguments("point.nc", TINY | huge)]
    done = subprocess.run(
        ["sh", "-c", script, "sh", *command],
        cwd=tmp_path,
        env=environment(),
        capture_output=True,
        text=True,
    )
    assert done.returncode == 1
    messages = [
        line for line in done.stderr.splitlines() if " so far" not in line
    ]  # progress, if slow
    assert len(messages) == 1 and list(tmp_path.iterdir()) == []
    assert messages[0].startswith("roughgas: error: out of memory. Unable to allocate")


def run_check(name, monkeypatch, capsys):
    """Return the text of a check of the doctor, and whether it passes."""
    monkeypatch.setattr(doctor, "CHECKS", {name: doctor.CHECKS[name]})
    try:
        doctor.print_checks(in_json=True)
        status = 0
    except SystemExit as stop:
        status = stop.code
    report = json.loads(capsys.readouterr().out)[name]
    assert report["ok"] == (status == 0)
    return report["said"], report["ok"]


def test_a_sound_installation_has_no_problems():
    done = roughgas("doctor", "--json", cwd=ROOT)
    report = json.loads(done.stdout)
    assert list(report) == list(doctor.CHECKS)
    problems = {name: entry for name, entry in report.items() if not entry["ok"]}
    assert (done.returncode, problems, done.stderr) == (0, {}, "")
    assert sys.executable in report["libraries"]["said"]
    assert str(ROOT / "config.yaml") in report["configuration"]["said"]


def test_a_problem_is_stated_in_words_and_by_the_exit_status(monkeypatch, capsys):
    monkeypatch.setattr(doctor, "CHECKS", {name: doctor.CHECKS[name] for name in ("extras",)})
    monkeypatch.setitem(sys.modules, "gsd", None)
    doctor.print_checks(in_json=False)
    assert capsys.readouterr().out.endswith("not installed: trajectories\n")
    monkeypatch.setattr(doctor, "REQUIRED_LIBRARIES", "tqdm gsd")
    monkeypatch.setattr(doctor, "CHECKS", {"libraries": (doctor._libraries, "mend it")})
    with pytest.raises(SystemExit) as stop:
        doctor.print_checks(in_json=False)
    output = capsys.readouterr().out
    assert stop.value.code == 1 and output.startswith("problem  libraries ")
    assert "gsd" in output and output.endswith("-> mend it\n")


@pytest.mark.parametrize(
    ("broken", "message"),
    [
        ({"EXPECTED_RATIO": 0.3}, "a trial run has R = 0.4453"),
        (
            {"TRIAL_PROGRAM": "import os; os.kill(os.getpid(), 11)"},
            "a trial run crashed: signal 11",
        ),
    ],
)
def test_a_kernel_that_is_wrong_or_crashes_is_a_problem(monkeypatch, capsys, broken, message):
    for name, value in broken.items():
        monkeypatch.setattr(doctor, name, value)
    text, passes = run_check("kernel", monkeypatch, capsys)
    assert not passes and message in text


POINT = "cooling --scale small --r 0.9 --beta 0.5"
COMMANDS_WITHOUT_EXTRAS = {
    "run": f"run {POINT} -o point.nc",
    "summary": f"run {POINT} --seed 2",
    "trajectory": f"trajectory {POINT} --times 0 1 -o gas.xyz",
    "show": "show point.nc",
    "reduce": "reduce point.nc -o cooling.nc",
    "theory": "theory --r 0.9 --beta 0.5",
    "completion": "completion bash",
}
COMMANDS_OF_EXTRAS = {
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


def run_without_extras(line, folder):
    """Return a finished process of `roughgas` without the packages of any extra."""
    packages = [package for brought in EXTRAS.values() for package in brought]
    return python("-c", BLOCKED.format(packages=packages), *line.split(), cwd=folder)


def test_simulations_need_no_extra(tmp_path):
    for name, line in COMMANDS_WITHOUT_EXTRAS.items():
        done = run_without_extras(line, tmp_path)
        assert done.returncode == 0, (name, done.stderr)
    assert (tmp_path / "gas.xyz").exists()


@pytest.mark.parametrize("extra", COMMANDS_OF_EXTRAS)
def test_a_missing_extra_is_named_in_one_line(extra, tmp_path):
    (tmp_path / "text.md").write_text("# A text\n")
    done = run_without_extras(COMMANDS_OF_EXTRAS[extra], tmp_path)
    package = EXTRAS[extra][0]
    message = f"{package} is not installed: pip install 'roughgas[{extra}]'"
    assert (done.returncode, done.stdout) == (1, "")
    assert done.stderr == f"roughgas: error: {message}\n"
    assert [path.name for path in tmp_path.iterdir()] == ["text.md"]
