"""Trusted confidence intervals of points hold the true R as often as they state.

`python -m benchmarks.coverage` tests more scenes, with more runs of each.
"""

import math

import numpy as np
import pytest
from raw import build, run_point

from roughgas.statistics.sample_sizes import UNKNOWN, YES
from roughgas.statistics.student import wallace_sigmas

SPIN = {"spin": {"inertia": 0.5}}
# Scene, r, beta, particles, side of the box; memory of R in T, and R from runs of 10^6 T in total,
# with a tenth of the smallest standard error here.
GASES = {
    "sheared": ({"shear": {"velocity": 2}}, 0.9, 0.0, 40, 25, 19.0, 0.22497),
    "heated": (
        {"thermostat": {"power": 1.0, "interval": 0.5, "spin_share": 0.5}},
        *(0.9, -0.9, 10, 15, 27.0, 0.7731),
    ),
}
SEEDS, LENGTHS = 60, (6, 9, 16, 30, 60)  # memories
MISS_SHARE = 0.07  # largest share of misses
LARGEST_DEVIATION = 5.0  # sigma


def points(name, memories, first_seed, **schedule_changes):
    """Variables of runs of a gas, each of this length in memories."""
    effects, r, beta, particles, side, memory, _ = GASES[name]
    timing = {"kind": "steady", "equilibrate": 300.0, "sample_every": 1.0, **schedule_changes}
    timing["measure"] = float(round(memories * memory))
    box = [side, side]
    settings = {"particles": particles, "box": box, "effects": SPIN | effects, "schedule": timing}
    scene = build(settings, r, beta)
    return [run_point(scene, settings, first_seed + seed).variables for seed in range(SEEDS)]


def missed(point, truth):
    """Whether the confidence interval misses the true R."""
    return abs(point["R"] - truth) > point["R_ci95"]


def sigmas(point, truth):
    """The deviation of R from the true value, in sigma of a Gaussian."""
    return abs(float(wallace_sigmas((point["R"] - truth) / point["R_stderr"], point["R_dof"])))


def allowed_misses(runs):
    """The allowed number of misses: three binomial errors above the largest share."""
    return MISS_SHARE * runs + 3.0 * math.sqrt(MISS_SHARE * (1.0 - MISS_SHARE) * runs)


@pytest.mark.slow
@pytest.mark.parametrize("name", GASES)
def test_trusted_intervals_hold_the_truth(name):
    """Runs of all lengths; by chance, the number of misses exceeds the limit once in 700 cases."""
    truth, trusted = GASES[name][-1], []
    for number, memories in enumerate(LENGTHS):
        runs = points(name, memories, 1000 * (number + 1))
        flags = np.array([run["R_ci95_trusted"] for run in runs])
        trusted += [run for run in runs if run["R_ci95_trusted"] == YES]
        if memories < 8:
            assert (flags == UNKNOWN).all()
        if memories >= 20:
            assert np.mean(flags == YES) >= 0.9
    assert len(trusted) > 2 * SEEDS
    assert sum(missed(run, truth) for run in trusted) <= allowed_misses(len(trusted))
    assert max(sigmas(run, truth) for run in trusted) < LARGEST_DEVIATION


@pytest.mark.slow
@pytest.mark.parametrize(("name", "target"), [("sheared", 0.01), ("heated", 0.02)])
def test_runs_that_met_their_target_hold_the_truth(name, target):
    """Although they end at a small estimated error."""
    truth = GASES[name][-1]
    runs = points(name, 4.0, 10_000, target_stderr=target)
    met = [run for run in runs if run["target_met"] == YES]
    assert len(met) > 0.9 * SEEDS
    assert sum(missed(run, truth) for run in met) <= allowed_misses(len(met))
    assert max(sigmas(run, truth) for run in met) < LARGEST_DEVIATION
