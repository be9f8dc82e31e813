"""The points of the small scale, as config.yaml has them, against the paper's theory.

How far theory may be off is the project's own yardstick (README): 0.06 in R where the gas is
driven, 8 % where it cools. To it come three standard errors over the seeds; with two seeds these
are those within the points, pooled. Chance alone then fails one point in about 700 that lies on the
limit, and far fewer inside. Seeds are fixed, so a run that passes passes always.
"""

import math
from pathlib import Path

import numpy as np
import pytest

from roughgas import config
from roughgas.simulate import run_point
from roughgas.theory import cooling_ratio, lun_ratio

CONFIG = Path(__file__).parent.parent / "config.yaml"
SIGMAS = 3
DRIVEN = [("vibrated", 0.99, 0.0), ("vibrated", 0.9, 0.5), ("vibrated", 0.9, 1.0)]
DRIVEN += [("sheared", 0.99, 0.0), ("sheared", 0.9, 0.5), ("sheared", 0.8, 1.0)]
DRIVEN += [("vibrated_smooth_walls", 0.9, 0.5), ("vibrated_particle_walls", 0.9, 0.5)]
COOLING = [(0.99, 0.0), (0.99, 1.0), (0.9, 0.0), (0.9, 0.5), (0.8, 0.5), (0.8, 1.0)]


def ratio_of_seeds(name, r, beta):
    """Mean of R over the seeds of the sweep, and its standard error."""
    experiment = config.experiment(config.load(CONFIG), name, "small")
    seeds = range(1, experiment["sweep"]["seeds"] + 1)
    found = [run_point(experiment, r, beta, seed).variables for seed in seeds]
    errors = np.array([one["R_stderr"] for one in found])
    return np.mean([one["R"] for one in found]), math.hypot(*errors) / len(errors)


@pytest.mark.parametrize(("name", "r", "beta"), DRIVEN)
def test_a_driven_gas_follows_lun(name, r, beta):
    R, stderr = ratio_of_seeds(name, r, beta)
    assert abs(R - lun_ratio(beta, 0.5)) < 0.06 + SIGMAS * stderr
    assert stderr < 0.02  # else the comparison says nothing


@pytest.mark.parametrize(("r", "beta"), COOLING)
def test_a_cooling_gas_follows_K(r, beta):
    R, stderr = ratio_of_seeds("cooling", r, beta)
    expected = cooling_ratio(r, beta)
    assert abs(R - expected) < 0.08 * expected + SIGMAS * stderr
    assert stderr < 0.02


def test_rough_walls_push_smooth_particles_past_equipartition():
    R, stderr = ratio_of_seeds("vibrated_rough_walls", 0.9, -1.0)
    assert R - SIGMAS * stderr > 0.5
