"""Runs that go on to a target error, and their progress."""

import io
import re

import numpy as np
import pytest
from brute_force import begin, settings

from roughgas.base import InputError
from roughgas.scene import build
from roughgas.simulation import recorder, schedule
from roughgas.simulation.point import run_point
from roughgas.simulation.progress import Bar, Progress
from roughgas.statistics.errors import NO, UNKNOWN, YES

STEADY = {"kind": "steady", "equilibrate": 30.5, "measure": 50, "sample_every": 0.3}
COOLING = {"kind": "cooling", "replicas": 4, "thermalise": 20, "relaxation_times": 8}
COOLING |= {"plateau": 30, "sample_every": 1}
SHEARED = settings("sheared", 40, [25, 25]) | {"schedule": STEADY}
FREE = settings("gas", 40, [50, 50]) | {"schedule": COOLING}
OF_TARGET = {"target_met", "target_blocks"}


def found(experiment, beta=0.0, **changes):
    chosen = experiment | {"schedule": experiment["schedule"] | changes}
    return run_point(begin(chosen, 0.9, beta)[0], chosen, 1).variables


def assert_same(one, other):
    """Of all but the target, and CPU times, to the last bit."""
    assert one.keys() - OF_TARGET == other.keys() - OF_TARGET
    for name in one.keys() - OF_TARGET - {"kernel_seconds"}:
        assert np.array_equal(one[name], other[name], equal_nan=np.asarray(one[name]).dtype == "f8")


@pytest.mark.parametrize(
    ("experiment", "key", "error"), [(SHEARED, "measure", 0.012), (FREE, "replicas", 0.006)]
)
def test_a_run_to_a_target_has_the_bits_of_one_that_was_asked_to_be_as_long(experiment, key, error):
    watching = experiment | {"observables": {"cumulants": {"every": 7}}, "keep_state": True}
    aimed = found(watching, target_stderr=error)
    blocks = aimed["target_blocks"]
    assert blocks > 3 and aimed["target_met"] == YES and aimed["R_stderr"] <= error
    assert_same(aimed, found(watching, **{key: blocks * experiment["schedule"][key]}))


@pytest.mark.parametrize("experiment", [SHEARED, FREE])
def test_what_is_not_reached_is_said(experiment, monkeypatch):
    monkeypatch.setattr(recorder, "MOST_BLOCKS", 3)
    aimed = found(experiment, target_stderr=1e-5)
    assert aimed["target_met"] == NO and aimed["target_blocks"] == 3
    assert aimed["R_stderr"] > 1e-5


def test_a_run_keeps_no_more_samples_than_any_other(monkeypatch):
    monkeypatch.setattr(recorder, "MOST_SAMPLES", 700)  # one block has some 268
    assert found(SHEARED, target_stderr=1e-5)["target_blocks"] == 2


def test_of_an_r_that_never_changes_it_is_not_known(monkeypatch):
    """Smooth disks do not spin up: the error is 0, and rests on nothing."""
    aimed = found(SHEARED, beta=-1.0, measure=100, target_stderr=0.01)
    assert aimed["R"] == aimed["R_stderr"] == 0.0
    assert aimed["target_met"] == UNKNOWN and aimed["target_blocks"] == 1


def test_states_to_begin_in_are_no_target_of_replicas():
    scene, aimed = begin(FREE, 0.9, 0.0)[0], COOLING | {"target_stderr": 0.01}
    with pytest.raises(InputError, match=r"target_stderr = 0\.01: must not stand beside initial"):
        schedule.of(FREE).run(scene, FREE | {"schedule": aimed}, 1, None, [None] * 4)


@pytest.mark.slow
def test_intervals_of_runs_that_ended_at_a_target_still_hold_the_truth():
    """To stop where an estimated error is small costs some of the coverage."""
    scene = begin(SHEARED, 0.9, 0.0)[0]
    truth = run_point(scene, SHEARED | {"schedule": STEADY | {"measure": 100_000}}, 1000).variables[
        "R"
    ]
    aimed = SHEARED | {"schedule": STEADY | {"target_stderr": 0.008}}
    inside, count = 0, 300
    for seed in range(count):
        one = run_point(scene, aimed, seed).variables
        assert one["target_met"] == YES
        inside += abs(one["R"] - truth) <= one["R_ci95"]
    assert inside / count > 0.9


class Terminal(io.StringIO):
    """A stream that says it is a terminal; `shown` is what each bar in turn looked like."""

    def isatty(self):
        return True

    @property
    def shown(self):
        return [line for line in self.getvalue().split("\r") if line.strip()]


@pytest.fixture(autouse=True)
def every_step_is_shown(monkeypatch):
    monkeypatch.setattr("roughgas.simulation.progress.SECONDS_BETWEEN", 0.0)


def test_a_cooling_gas_is_followed_through_its_replicas():
    """So many collisions per particle: 20 to thermalise, the transient, 30 on the plateau."""
    stream = Terminal()
    with Progress("cooling", build(FREE, 1.0, 1.0), FREE, stream=stream) as progress:
        total = int(stream.shown[0].split(" of ")[1].split()[0])
        replica = total / 4
        for _ in range(4):
            for part in (0.5, 1.0):
                progress(123.0, round(part * replica * 20))
    shown = [int(one.split("| ")[1].split()[0]) for one in stream.shown[1:]]
    assert shown == pytest.approx([total * part / 8 for part in range(1, 9)], abs=1)
    assert stream.shown[-1].startswith("cooling: 100%|")


def test_progress_is_silent_elsewhere_of_what_is_soon_over():
    stream = io.StringIO()
    with Progress("cooling", build(FREE, 0.9, 0.0), FREE, stream=stream) as progress:
        progress(1.0, 1)
    assert stream.getvalue() == ""


def test_parts_that_take_unequal_times(monkeypatch):
    """Two of nine points are a tenth of the work, in a pipe and on a terminal."""
    pipe, terminal = io.StringIO(), Terminal()
    clock = iter([0, 11, 11])
    monkeypatch.setattr("roughgas.simulation.progress.time.monotonic", lambda: next(clock))
    with Bar("task", 9, "points", pipe) as bar:
        bar.reach(2, share=0.1)
    assert pipe.getvalue() == "task: 10 %, 2 of 9 points, 11 s so far, about 99 s left\n"
    with Bar("task", 9, "points", terminal) as bar:
        bar.reach(2, share=0.1)
    assert re.match(r"task:  10%\|[^|]*\| 2 of 9 points, ", terminal.shown[-1])


def test_a_pipe_hears_now_and_then_of_what_takes_long(monkeypatch):
    clock = iter([0, 5, 11, 60, 72])
    monkeypatch.setattr("roughgas.simulation.progress.time.monotonic", lambda: next(clock))
    stream = io.StringIO()
    with Bar("task", None, "points", stream) as bar:
        for done in range(1, 5):
            bar.reach(done, "r = 0.9", total=9)
    assert stream.getvalue().splitlines() == [
        "task: 22 %, 2 of 9 points (r = 0.9), 11 s so far, about 38 s left",
        "task: 44 %, 4 of 9 points (r = 0.9), 72 s so far, about 90 s left",
    ]


@pytest.mark.parametrize("trusted", [YES, NO, UNKNOWN])
@pytest.mark.parametrize("stderr", [0.005, 0.02])
def test_a_target_is_met_where_R_is_trusted(trusted, stderr):
    """Whatever else ends the run: enough replicas, or the most blocks."""
    point = {"R_stderr": stderr, "R_ci95_trusted": trusted, "measured_collisions": 100.0}
    timing = {"target_stderr": 0.01, "measure": 1e5, "sample_every": 0.01}
    found = recorder.until_met(timing, "measure", lambda longer: (point, True))
    small = YES if trusted == YES else UNKNOWN
    assert found["target_met"] == (small if stderr <= 0.01 else NO)
