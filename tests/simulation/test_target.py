"""Runs to a target error, and the progress of runs."""

import io
import re
import sys
from types import SimpleNamespace

import numpy as np
import pytest
from brute_force import begin, settings
from raw import build, cooling, run_point, steady, typed

from roughgas.base import InputError
from roughgas.simulation import error_target, progress
from roughgas.simulation.progress import ProgressBar, RunProgress
from roughgas.statistics.sample_sizes import NO, UNKNOWN, YES

STEADY = {"kind": "steady", "equilibrate": 30.5, "measure": 50, "sample_every": 0.3}
COOLING = {"kind": "cooling", "replicas": 4, "thermalise": 20, "relaxation_times": 8}
COOLING |= {"plateau": 30, "sample_every": 1}
SHEARED = settings("sheared", 40, [25, 25]) | {"schedule": STEADY}
COOLING_GAS = settings("gas", 40, [50, 50]) | {"schedule": COOLING}
TARGET_VARIABLES = {"target_met", "target_blocks"}


def variables_of(experiment, beta=0.0, **changes):
    """The variables of a point with changes of its schedule."""
    changed = experiment | {"schedule": experiment["schedule"] | changes}
    return run_point(begin(changed, 0.9, beta)[0], changed, 1).variables


def assert_same_variables(first, second):
    """Assert the same bits, except in variables of the target and CPU times."""
    assert first.keys() - TARGET_VARIABLES == second.keys() - TARGET_VARIABLES
    for name in first.keys() - TARGET_VARIABLES - {"kernel_seconds"}:
        assert np.array_equal(
            first[name], second[name], equal_nan=np.asarray(first[name]).dtype == "f8"
        )


@pytest.mark.parametrize(
    ("experiment", "key", "error"), [(SHEARED, "measure", 0.012), (COOLING_GAS, "replicas", 0.006)]
)
def test_a_run_to_a_target_has_the_bits_of_a_run_of_the_same_length(experiment, key, error):
    watching = experiment | {"observables": {"cumulants": {"every": 7}}, "keep_state": True}
    aimed = variables_of(watching, target_stderr=error)
    blocks = aimed["target_blocks"]
    assert blocks > 3 and aimed["target_met"] == YES and aimed["R_stderr"] <= error
    assert_same_variables(
        aimed, variables_of(watching, **{key: blocks * experiment["schedule"][key]})
    )


@pytest.mark.parametrize("experiment", [SHEARED, COOLING_GAS])
def test_a_missed_target_is_reported(experiment, monkeypatch):
    monkeypatch.setattr(error_target, "BLOCK_LIMIT", 3)
    aimed = variables_of(experiment, target_stderr=1e-5)
    assert aimed["target_met"] == NO and aimed["target_blocks"] == 3
    assert aimed["R_stderr"] > 1e-5


def test_a_run_keeps_no_more_samples_than_any_other(monkeypatch):
    monkeypatch.setattr(error_target, "SAMPLE_LIMIT", 700)  # a block has some 268
    assert variables_of(SHEARED, target_stderr=1e-5)["target_blocks"] == 2


def test_a_target_is_unknown_if_R_never_changes(monkeypatch):
    """Smooth disks never spin: the error of R is 0 without any evidence."""
    aimed = variables_of(SHEARED, beta=-1.0, measure=100, target_stderr=0.01)
    assert aimed["R"] == aimed["R_stderr"] == 0.0
    assert aimed["target_met"] == UNKNOWN and aimed["target_blocks"] == 1


def test_initial_states_exclude_a_target_of_replicas():
    scene, aimed = begin(COOLING_GAS, 0.9, 0.0)[0], COOLING | {"target_stderr": 0.01}
    with pytest.raises(InputError, match=r"target_stderr = 0\.01: must not stand beside initial"):
        cooling.run(scene, COOLING_GAS | {"schedule": aimed}, 1, None, [None] * 4)


class Terminal(io.StringIO):
    """A stream that claims to be a terminal; `shown` has the successive bars."""

    def isatty(self):
        return True

    @property
    def shown(self):
        return [line for line in self.getvalue().split("\r") if line.strip()]


@pytest.fixture(autouse=True)
def every_step_is_shown(monkeypatch):
    monkeypatch.setattr(progress, "BAR_INTERVAL", 0.0)


def replica_of(number):
    """A stand-in for a replica at its start."""
    return SimpleNamespace(number=number, time=0.0, collisions_before_cooling=0, collisions=0)


def batch_after(collisions):
    """A stand-in for a batch whose last sample is after a number of collisions."""
    return SimpleNamespace(rows={"time": [123.0], "collisions": [collisions]})


def test_a_cooling_gas_is_followed_through_its_replicas():
    """In collisions per particle: 20 to thermalise, the transient, 30 on the plateau, averaged over
    all replicas."""
    stream = Terminal()
    with RunProgress(
        "cooling", build(COOLING_GAS, 1.0, 1.0), typed(COOLING_GAS), stream=stream
    ) as run_progress:
        total = int(stream.shown[0].split(" of ")[1].split()[0])
        for number in range(4):
            gas = replica_of(number)
            run_progress.begin(gas, None, {})
            for share in (0.5, 1.0):
                run_progress.take(gas, None, batch_after(round(share * total * 20)))
        assert 20 + 30 < total < 120
        run_progress.expect(8 * run_progress._length_of_gas)  # as with twice the replicas
    shown = [int(bar.split("| ")[1].split()[0]) for bar in stream.shown[2:]]
    expected = [*(total * eighth / 8 for eighth in range(1, 9)), total / 2]
    assert shown == pytest.approx(expected, abs=1)
    assert stream.shown[-2].startswith("cooling: 100%|")


class Output:
    """A stand-in for an output of a notebook's cell; `texts` are its successive contents."""

    def __init__(self):
        self.texts = []

    def update(self, content, raw):
        self.texts.append(content["text/plain"])


def test_in_a_notebook_a_line_of_the_output_changes_and_ends_empty(monkeypatch, capsys):
    output = Output()
    display = SimpleNamespace(display=lambda *_, **__: output)
    monkeypatch.setitem(sys.modules, "IPython", SimpleNamespace(display=display))
    monkeypatch.setitem(sys.modules, "IPython.display", display)
    monkeypatch.delitem(sys.modules, "roughgas.simulation.notebook_bar", raising=False)
    monkeypatch.setattr(progress, "NOTEBOOK", "pytest")
    with ProgressBar("task", 9, "points") as bar:
        for done in (2, 9):
            bar.reach(done)
    shown, last = output.texts[:-1], output.texts[-1]
    assert last == "" and any(re.match(r"task:  22%\|.*\| 2 of 9 points, ", text) for text in shown)
    assert all(text.startswith("task: ") and "\n" not in text for text in shown)
    assert capsys.readouterr() == ("", "")


def test_short_work_shows_no_progress_without_a_terminal():
    stream = io.StringIO()
    with RunProgress(
        "cooling", build(COOLING_GAS, 0.9, 0.0), typed(COOLING_GAS), stream=stream
    ) as run_progress:
        run_progress.begin(replica_of(0), None, {})
        run_progress.take(replica_of(0), None, batch_after(1))
    assert stream.getvalue() == ""


def test_the_time_left_follows_the_share_of_the_work(monkeypatch):
    """Two of nine points are a tenth of the work here; in a pipe and on a terminal."""
    pipe, terminal = io.StringIO(), Terminal()
    clock = iter([0, 11, 11])
    monkeypatch.setattr(progress.time, "monotonic", lambda: next(clock))
    monkeypatch.setattr(progress, "FIRST_LINE_AFTER", 10.0)
    with ProgressBar("task", 9, "points", pipe) as bar:
        bar.reach(2, share=0.1)
    assert pipe.getvalue() == "task: 10 %, 2 of 9 points, 11 s so far, about 99 s left\n"
    with ProgressBar("task", 9, "points", terminal) as bar:
        bar.reach(2, share=0.1)
    assert re.match(r"task:  10%\|[^|]*\| 2 of 9 points, ", terminal.shown[-1])


def test_no_time_left_is_told_while_compiling_took_most_of_it(monkeypatch):
    clock = iter([0, 19, 80])
    monkeypatch.setattr(progress.time, "monotonic", lambda: next(clock))
    monkeypatch.setattr(progress, "FIRST_LINE_AFTER", 10.0)
    stream = io.StringIO()
    with ProgressBar("gas", 125, "frames", stream) as bar:
        for done in (1, 25):
            bar.reach(done)
    assert stream.getvalue().splitlines() == [
        "gas: 1 %, 1 of 125 frames, 19 s so far",
        "gas: 20 %, 25 of 125 frames, 80 s so far, about 320 s left",
    ]


def test_a_pipe_gets_lines_about_long_work(monkeypatch):
    clock = iter([0, 5, 11, 60, 72])
    monkeypatch.setattr(progress.time, "monotonic", lambda: next(clock))
    monkeypatch.setattr(progress, "FIRST_LINE_AFTER", 10.0)
    stream = io.StringIO()
    with ProgressBar("task", None, "points", stream) as bar:
        for done in range(1, 5):
            bar.reach(done, "r = 0.9", total=9)
    assert stream.getvalue().splitlines() == [
        "task: 22 %, 2 of 9 points (r = 0.9), 11 s so far, about 38 s left",
        "task: 44 %, 4 of 9 points (r = 0.9), 72 s so far, about 90 s left",
    ]


@pytest.mark.parametrize("trusted", [YES, NO, UNKNOWN])
@pytest.mark.parametrize("stderr", [0.005, 0.02])
def test_a_target_is_met_where_R_is_trusted(trusted, stderr):
    """An untrusted R with a small error leaves it unknown whether the target is met."""
    point = {"R_stderr": stderr, "R_ci95_trusted": trusted, "measured_collisions": 100.0}
    timing = steady.SteadySettings(
        target_stderr=0.01, equilibrate=0.0, measure=1e5, sample_every=0.01
    )
    variables = error_target.prolonged_until_met(timing, "measure", lambda longer: (point, True))
    met = YES if trusted == YES else UNKNOWN
    assert variables["target_met"] == (met if stderr <= 0.01 else NO)
