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
from brute_force.scenes import NEVER

from roughgas import config
from roughgas.scene import build
from roughgas.simulation.point import run_point
from roughgas.theory import cooling_ratio, lun_ratio
from roughgas.theory.prediction import predicted_ratio

CONFIG = Path(__file__).parent.parent / "config.yaml"
SIGMAS = 3
DRIVEN = [("vibrated", 0.99, 0.0), ("vibrated", 0.9, 0.5), ("vibrated", 0.9, 1.0)]
DRIVEN += [("sheared", 0.99, 0.0), ("sheared", 0.9, 0.5), ("sheared", 0.8, 1.0)]
DRIVEN += [("vibrated_smooth_walls", 0.9, 0.5), ("vibrated_particle_walls", 0.9, 0.5)]
BEYOND = [  # all at r = 0.9: an experiment or a variant of one, and beta
    ("cooling_spheres", 0.5),
    ("sheared_spheres", 0.5),
    ("vibrated_spheres", 0.5),
    ("vibrated_friction/mu0.3", 1.0),
    ("cooling_friction/mu1", 0.0),
    ("heated/spin_share0.4", 0.0),
    ("heated/spin_share1", 1.0),
    ("floor_materials/roughness1", 0.0),
    ("wall_materials/roughness0", 1.0),
    ("shaken_walls/roughness1", 1.0),
    ("waves/wavesine", 0.0),
    ("waves/wavereversed_sawtooth", 1.0),
    ("vibrated_inertia/inertia0.3", 0.0),
    ("cooling_inertia/inertia0.05", 1.0),
    ("vibrated_masses/mass4", 1.0),
    ("vibrated_sizes/radius2", 1.0),
    ("cooling_masses/mass4", 1.0),
    ("cooling_polydisperse/deviation0.2", 0.0),
]
COOLING = [(0.99, 0.0), (0.99, 1.0), (0.9, 0.0), (0.9, 0.5), (0.8, 0.5), (0.8, 1.0)]


def points_of_seeds(name, r, beta):
    """The point of each seed of the sweep."""
    experiment = config.experiment(config.load(CONFIG), name, "small")
    if "walls" in experiment["effects"]:  # the kernel of other tests, and the same R
        experiment["effects"]["contact_time"] = {"duration": NEVER}
        del experiment["effects"]["contact_averages"]
    seeds = range(1, experiment["sweep"]["seeds"] + 1)
    return [run_point(build(experiment, r, beta), experiment, seed) for seed in seeds]


def mean_ratio(points):
    """Mean of R over seeds, and its standard error."""
    errors = np.array([point.variables["R_stderr"] for point in points])
    return np.mean([point.variables["R"] for point in points]), math.hypot(*errors) / len(errors)


def ratio_of_seeds(name, r, beta):
    """Mean of R over the seeds of the sweep, and its standard error."""
    return mean_ratio(points_of_seeds(name, r, beta))


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


@pytest.mark.slow  # a kernel each
@pytest.mark.parametrize(("name", "beta"), BEYOND)
def test_what_lies_beyond_the_paper_follows_the_rate_equations(name, beta):
    """Drives at the share of rotation that their energy books say."""
    points = points_of_seeds(name, 0.9, beta)
    R, stderr = mean_ratio(points)
    about, variables = points[0].attributes, points[0].variables
    about["theory"] = "K" if "plateau_end" in variables else "lun"
    if "input_spin_share" in variables:
        shares = [point.variables["input_spin_share"] for point in points]
        about["spin_share"] = np.mean(shares)
    assert abs(R - predicted_ratio(about, 0.9, beta)) < 0.06 + SIGMAS * stderr
    assert stderr < 0.02


def test_rough_walls_push_smooth_particles_past_equipartition():
    R, stderr = ratio_of_seeds("vibrated_rough_walls", 0.9, -1.0)
    assert R - SIGMAS * stderr > 0.5
