"""An interrupted family of hard cases keeps its finished cases, and continues with the others."""

import json
import os
import signal
import subprocess
import sys

import pytest
from hard_cases.catalogue import errors_of_share
from hard_cases.checkpoint import FinishedCases
from hard_cases.test_remedies import limit_cpu
from hypothesis import HealthCheck, settings
from robustness.conftest import ROOT, environment

FAMILIES = ROOT / "tests/hard_cases"
SCENES = f"{FAMILIES}/test_random_scenes.py::test_invariants_of_random_scenes"
MARK = 10**9  # contacts added to a block that is kept: it shows in the result that uses it
CUT = """
import os, signal

def pytest_runtest_logfinish(nodeid, done=[]):
    done.append(nodeid)
    if len(done) == 2:
        os.kill(os.getpid(), signal.SIGTERM)
"""

CUT_SCENES = """
import os

def pytest_collection_finish():
    from hard_cases.checkpoint import FinishedCases
    keep = FinishedCases.__setitem__

    def keep_and_stop(cases, name, value, kept=[]):
        keep(cases, name, value)
        kept.append(name)
        if len(kept) == 2:
            os.kill(os.getpid(), {signal})

    FinishedCases.__setitem__ = keep_and_stop
"""


def family(folder, *arguments):
    """A process that runs cases; its files are in `folder`, where it finds plugins."""
    folder.mkdir(exist_ok=True)
    command = [sys.executable, "-m", "pytest", "-n0", "-v", "-s", "-p", "no:cacheprovider"]
    command += ["--margins", str(folder / "margins.json"), *arguments]
    command += ["--checkpoint", str(folder / "checkpoint.json")]
    return subprocess.Popen(
        command,
        cwd=ROOT,
        env=environment(PYTHONPATH=f"{ROOT / 'src'}:{folder}"),
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
    )


def run_to_the_end(folder, *arguments):
    """Return the output and the measured margins of a family that succeeds."""
    running = family(folder, *arguments)
    output, _ = running.communicate(timeout=300)
    assert running.returncode == 0, output
    assert not (folder / "checkpoint.json").exists()
    return output, json.loads((folder / "margins.json").read_text())


def finished(folder):
    """Return the finished cases of the checkpoint in a folder, by name."""
    path = folder / "checkpoint.json"
    return json.loads(path.read_text())["finished"] if path.exists() else {}


def contacts(measured):
    """Contacts in all scenes, which rows name in their units; they are taken out of them."""
    counts = set()
    for row in measured["margins"]:
        row["unit"], count, _ = row["unit"].split()
        counts.add(int(count))
    (number,) = counts
    return number


@pytest.mark.slow  # loads six kernels, three times each
@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGKILL], ids=["SIGTERM", "SIGKILL"])
def test_scenes_that_are_finished_are_not_simulated_again(tmp_path, number):
    short, once = tmp_path / "short", tmp_path / "once"
    short.mkdir()
    (short / "cut_scenes.py").write_text(CUT_SCENES.format(signal=int(number)))
    output, _ = family(short, SCENES, "-p", "cut_scenes").communicate(timeout=120)
    finished_scenes = finished(short)
    assert len(finished_scenes) == 2 and not (short / "margins.json").exists()
    if number == signal.SIGTERM:
        assert "\nroughgas: stopped: 0 of 1 cases, and of the next one " in output
        assert f" of 90 scenes, are kept in {short}" in output
        assert "measured nothing" not in output
    content = json.loads((short / "checkpoint.json").read_text())
    content["finished"][min(finished_scenes)]["collisions"] += MARK
    (short / "checkpoint.json").write_text(json.dumps(content))
    output, resumed = run_to_the_end(short, SCENES)
    assert f"going on from {short}" in output
    _, uninterrupted = run_to_the_end(once, SCENES)
    assert contacts(resumed) == contacts(uninterrupted) + MARK
    assert resumed == uninterrupted


@pytest.mark.slow
def test_cases_that_are_finished_are_not_run_again(tmp_path):
    short, once = tmp_path / "short", tmp_path / "once"
    short.mkdir()
    (short / "cut.py").write_text(CUT)
    cases = f"{FAMILIES}/test_wave_forms.py", "-k", "falls_onto"
    running = family(short, *cases, "-p", "cut", "--progress", "1")
    output, _ = running.communicate(timeout=120)
    assert running.returncode == pytest.ExitCode.INTERRUPTED
    for head in ("roughgas", "hard cases: wave_forms"):
        assert f"\n{head}: stopped: 2 of 3 cases are kept in {short}" in output
    assert len(finished(short)) == 2 and not (short / "margins.json").exists()
    number = output.count(" falls\n")
    output, resumed = run_to_the_end(short, *cases)
    assert number == 4 and output.count(" falls\n") == 2
    assert resumed == run_to_the_end(once, *cases)[1]


def test_a_checkpoint_of_another_run_or_a_damaged_one_is_not_used(tmp_path, capsys):
    path = tmp_path / "checkpoint.json"
    FinishedCases(path, "this")["case"] = {"tried": 3}
    assert FinishedCases(path, "this")["case"] == {"tried": 3}
    assert "case" not in FinishedCases(path, "other")
    assert "belongs to other code or settings" in capsys.readouterr().out
    path.write_text("{")
    assert "case" not in FinishedCases(path, "this")
    assert "is damaged: beginning anew" in capsys.readouterr().out


def test_progress_is_shown_while_a_family_runs(tmp_path):
    read, write = os.pipe()
    program = (
        "from hard_cases.checkpoint import Lines\nfrom roughgas.simulation import progress\n"
        "from hard_cases.catalogue import Progress\nprogress.FIRST_LINE_AFTER = -1\n"
        f"bar = progress.ProgressBar('hard cases: waves', 2, 'cases', Lines({write}))\n"
        "shown = Progress()\nshown.cases, shown.bar = 2, bar\nshown.reach(90, 180, 'scenes')\n"
    )
    paths = f"{ROOT / 'src'}:{ROOT / 'tests'}"
    command = [sys.executable, "-c", program]
    subprocess.run(command, env=environment(PYTHONPATH=paths), pass_fds=[write], check=True)
    os.close(write)
    with open(read) as file:
        output = file.read()
    assert output.startswith("hard cases: waves: 25 %, 0 of 2 cases (90 of 180 scenes), 0 s so far")


def test_limits_on_shares_carry_the_error_of_the_tries():
    assert errors_of_share(0.05, 475) == pytest.approx(0.03)
    assert errors_of_share(0.05, 4 * 475) == pytest.approx(0.015)


def test_a_limit_of_time_is_one_of_cpu():
    """A busy machine makes a process wait, which must not end it."""

    def status(program):
        command = [sys.executable, "-c", program]
        return subprocess.run(command, preexec_fn=lambda: limit_cpu(1), timeout=60).returncode

    assert status("import time; time.sleep(1.5)") == 0
    assert status("while True: pass") in (-signal.SIGXCPU, -signal.SIGKILL)


def test_how_long_an_example_takes_fails_no_test():
    assert settings().deadline is None
    assert HealthCheck.too_slow in settings().suppress_health_check
