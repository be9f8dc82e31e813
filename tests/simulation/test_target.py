"""A target for the standard error of R: what a run does to reach it, and what it says of it."""

import numpy as np
import pytest
from brute_force import begin, settings

from roughgas.base import InputError
from roughgas.simulation import schedule, target
from roughgas.simulation.point import run_point
from roughgas.statistics.errors import NO, UNKNOWN, YES

STEADY = {"kind": "steady", "equilibrate": 30.5, "measure": 50, "sample_every": 0.3}
COOLING = {"kind": "cooling", "replicas": 4, "thermalise": 20, "relaxation_times": 8}
COOLING |= {"plateau": 30, "sample_every": 1}
SHEARED = settings("sheared", 40, [25, 25]) | {"schedule": STEADY}
FREE = settings("gas", 40, [50, 50]) | {"schedule": COOLING}
OF_TARGET = {"target_met", "target_blocks"}


def found(experiment, beta=0.0, **changes):
    """The variables of a point whose schedule has these changes."""
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
def test_a_target_that_is_met_at_once_changes_nothing(experiment):
    long = {"measure": 1000} if "measure" in experiment["schedule"] else {"replicas": 12}
    aimed = found(experiment, **long, target_stderr=0.1)
    assert aimed["target_blocks"] == 1 and aimed["target_met"] == YES
    assert_same(aimed, found(experiment, **long))


@pytest.mark.parametrize("experiment", [SHEARED, FREE])
def test_what_is_not_reached_is_said(experiment, monkeypatch):
    monkeypatch.setattr(target, "MOST_BLOCKS", 3)
    aimed = found(experiment, target_stderr=1e-5)
    assert aimed["target_met"] == NO and aimed["target_blocks"] == 3
    assert aimed["R_stderr"] > 1e-5


def test_a_run_keeps_no_more_samples_than_any_other(monkeypatch):
    monkeypatch.setattr(target, "MOST_SAMPLES", 700)  # one block has some 268
    assert found(SHEARED, target_stderr=1e-5)["target_blocks"] == 2


def test_of_an_r_that_never_changes_it_is_not_known(monkeypatch):
    """Smooth disks do not spin up: the error is 0, and rests on nothing."""
    aimed = found(SHEARED, beta=-1.0, measure=100, target_stderr=0.01)
    assert aimed["R"] == aimed["R_stderr"] == 0.0
    assert aimed["target_met"] == UNKNOWN and aimed["target_blocks"] == 1


def test_two_replicas_are_too_few_to_know_their_error():
    aimed = found(FREE, replicas=2, target_stderr=0.1)
    assert aimed["target_blocks"] == 4  # 2, 4, 8 replicas: 5 are the fewest
    assert aimed["target_met"] == YES


@pytest.mark.parametrize(
    ("blocks", "excess", "wanted"),
    [(1, 1.01, 2), (1, 5.0, 2), (4, 1.2, 6), (4, 3.0, 8), (4, np.nan, 8), (4, np.inf, 8)],
)
def test_how_far_it_goes_on(blocks, excess, wanted):
    """As far as the error says, by one block at least, to twice the length at most."""
    assert target._wanted(blocks, excess) == wanted


def test_a_drive_must_be_seen_in_enough_phases():
    bed = settings("bed", 40, [12.5, "open"])
    aimed = {"kind": "steady", "equilibrate": 10, "measure": 20, "sample_every": 0.25, "period": 1}
    schedule.check(bed | {"schedule": aimed})
    with pytest.raises(InputError) as caught:
        schedule.check(bed | {"schedule": aimed | {"target_stderr": 0.01}})
    assert str(caught.value) == (
        "schedule.sample_every = 0.25: must divide a period of the drive into 16 samples beside "
        "schedule.target_stderr"
    )


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
