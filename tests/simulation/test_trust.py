"""Of the intervals that points call trusted, as many hold the truth as say so.

`python -m benchmarks.coverage` asks the same of more scenes, and of more runs of each.
"""

import math

import numpy as np
import pytest

from roughgas.scene import build
from roughgas.simulation.point import run_point
from roughgas.statistics.errors import UNKNOWN, YES, gaussian_sigmas

SPIN = {"spin": {"inertia": 0.5}}
# Scene, r, beta, particles, side of the box; memory of R in T, and R of runs of 10^6 T together,
# known to a tenth of the least standard error here.
GASES = {
    "sheared": ({"shear": {"velocity": 2}}, 0.9, 0.0, 40, 25, 19.0, 0.22497),
    "heated": (
        {"thermostat": {"power": 1.0, "interval": 0.5, "spin_share": 0.5}},
        *(0.9, -0.9, 10, 15, 27.0, 0.7731),
    ),
}
SEEDS, LENGTHS = 60, (6, 9, 16, 30, 60)  # memories
LARGEST = 0.07  # share of misses
FAR = 5.0  # sigma


def points(name, memories, first, **more):
    """The variables of runs of a gas, of so many memories each."""
    effects, r, beta, particles, side, memory, _ = GASES[name]
    timing = {"kind": "steady", "equilibrate": 300.0, "sample_every": 1.0, **more}
    timing["measure"] = float(round(memories * memory))
    box = [side, side]
    settings = {"particles": particles, "box": box, "effects": SPIN | effects, "schedule": timing}
    scene = build(settings, r, beta)
    return [run_point(scene, settings, first + seed).variables for seed in range(SEEDS)]


def missed(point, truth):
    return abs(point["R"] - truth) > point["R_ci95"]


def sigmas(point, truth):
    return abs(float(gaussian_sigmas((point["R"] - truth) / point["R_stderr"], point["R_dof"])))


def most(runs):
    """Misses that are allowed in so many runs: three binomial errors above the largest share."""
    return LARGEST * runs + 3.0 * math.sqrt(LARGEST * (1.0 - LARGEST) * runs)


@pytest.mark.slow
@pytest.mark.parametrize("name", GASES)
def test_trusted_intervals_hold_the_truth(name):
    """Runs of all lengths: more misses than are allowed by chance once in 700 cases."""
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
    assert sum(missed(run, truth) for run in trusted) <= most(len(trusted))
    assert max(sigmas(run, truth) for run in trusted) < FAR


@pytest.mark.slow
@pytest.mark.parametrize(("name", "target"), [("sheared", 0.01), ("heated", 0.02)])
def test_runs_that_met_their_target_hold_the_truth(name, target):
    """Though they end where the error seems small enough."""
    truth = GASES[name][-1]
    runs = points(name, 4.0, 10_000, target_stderr=target)
    met = [run for run in runs if run["target_met"] == YES]
    assert len(met) > 0.9 * SEEDS
    assert sum(missed(run, truth) for run in met) <= most(len(met))
    assert max(sigmas(run, truth) for run in met) < FAR
