"""How fast temperatures of a driven gas relax: closed forms, conservation, and slow integration."""

import math

import numpy as np
import pytest

from roughgas import theory
from roughgas.theory.relaxation import (
    floor_hit_frequency,
    ratio_relaxation,
    slopes,
    slowest_relaxation,
    thermal_wall_slopes,
    viscous_decay,
    wall_hit_frequency,
    wall_slopes,
)

GASES = [(0.9, 0.0, 0.0, 2, 0.5), (0.6, -0.5, 0.3, 3, 0.4), (0.8, 0.9, 1.0, 2, 0.5)]


@pytest.mark.parametrize(("r", "beta", "share", "dimension", "q"), GASES)
def test_the_ratio_relaxes_as_in_the_closed_form(r, beta, share, dimension, q):
    """The slopes at constant energy have the eigenvalue that `relaxation_rate` writes down."""
    spins = 2 * dimension - 3
    matrix = slopes(
        lambda T: theory.temperature_changes(*T, r, beta, dimension, q), np.array([1.0, 0.3])
    )
    heating = np.array([(1.0 - share) / dimension, share / spins])
    rate = ratio_relaxation(matrix, heating, np.array([dimension, spins], float))
    expected = theory.relaxation_rate(r, beta, dimension, q, share)
    assert rate == pytest.approx(expected, rel=1e-8)


def test_one_temperature_has_no_ratio_that_relaxes():
    assert ratio_relaxation(np.array([[-1.0]]), np.ones(1), np.ones(1)) == math.inf


def test_growing_temperatures_have_no_relaxation_time():
    assert slowest_relaxation(np.array([[0.1, 0.0], [0.0, -1.0]])) == 0.0


@pytest.mark.parametrize(("mu", "share"), [(0.1, 0.0), (0.3, 0.0), (0.3, 0.4)])
def test_friction_relaxes_as_a_slow_integration_says(mu, share):
    """A disturbance of R at constant energy decays at the rate of the slopes: to 2 %."""
    material = 0.9, 0.5, mu, 2, 0.5
    R = float(theory.friction_ratio(*material[:3], 2, 0.5, share))
    state = np.array([1.0 - R, R])
    capacity, heating = np.array([2.0, 1.0]), np.array([(1.0 - share) / 2.0, share])
    matrix = slopes(lambda T: theory.friction_changes(*T, *material), state)
    rate = ratio_relaxation(matrix, heating, capacity)
    disturbed = state + 1e-4 * np.array([-0.5, 1.0])
    step = 1e-3 / rate
    for _ in range(2000):
        change = np.array(theory.friction_changes(*disturbed, *material))
        disturbed = disturbed + step * (change - heating * (capacity @ change))
    assert disturbed[1] - R == pytest.approx(1e-4 * math.exp(-2.0), rel=0.02)


@pytest.mark.parametrize("dimension", [2, 3])
def test_a_perfectly_rough_elastic_wall_conserves_energy(dimension):
    q = float(theory.moment_of_inertia(dimension))
    matrix = wall_slopes(1.0, 1.0, dimension, q)
    capacity = np.array([dimension, 2 * dimension - 3])
    assert capacity @ matrix == pytest.approx(np.zeros(2), abs=1e-14)
    assert wall_slopes(1.0, -1.0, dimension, q) == pytest.approx(np.zeros((2, 2)))


@pytest.mark.parametrize("dimension", [2, 3])
def test_slopes_of_a_rough_wall_are_those_of_sampled_hits(dimension):
    """A million hits in a Maxwellian gas: 4 standard errors, by chance once in 3000 tests."""
    rng, q, T_tr, T_rot, r, beta = np.random.default_rng(5), 0.4, 1.3, 0.6, 0.8, 0.3
    hits, axes, spin_axes = 1_000_000, dimension - 1, 2 * dimension - 3
    normal = np.sqrt(-2.0 * T_tr * np.log(rng.random(hits)))  # of particles that hit
    v = math.sqrt(T_tr) * rng.standard_normal((axes, hits))
    w = math.sqrt(T_rot / q) * rng.standard_normal((spin_axes, hits))
    slip = v + w[:axes]  # a sign of the cross product changes no average
    kappa = (1.0 + beta) / (1.0 + q)
    lost = (1.0 - r**2) * normal**2 + (v**2 - (v - q * kappa * slip) ** 2).sum(axis=0)
    gained = q * ((w[:axes] - kappa * slip) ** 2 - w[:axes] ** 2).sum(axis=0)
    change = np.array([-lost / dimension, gained / spin_axes])
    expected = wall_slopes(r, beta, dimension, q) @ [T_tr, T_rot]
    stderr = change.std(axis=1) / math.sqrt(hits)
    assert (np.abs(change.mean(axis=1) - expected) < 4.0 * stderr).all()


def test_a_thermal_wall_keeps_nothing_of_what_hits_it():
    """Particles that hit it have a mean translational energy of (D + 1) T_tr/2, not of D T_tr/2."""
    assert thermal_wall_slopes(2) == pytest.approx(np.diag([-1.5, -1.0]))
    assert thermal_wall_slopes(3) == pytest.approx(np.diag([-4.0 / 3.0, -1.0]))


def test_hit_frequencies_and_viscous_decay_are_those_of_kinetic_theory():
    """A gas of temperature 1 in a box of length 10; a floor under gravity 1; disks with nu = 2."""
    assert wall_hit_frequency(1.0, 10.0) == pytest.approx(0.039894, rel=1e-4)
    pressure = floor_hit_frequency(1.0, 1.0) * 2.0 * math.sqrt(math.pi / 2.0)
    assert pressure == pytest.approx(1.0)  # it bears the weight
    nu = float(theory.collision_frequency(1.0, 0.01, 2))
    kinematic = viscous_decay(1.0, nu, 2.0 * math.pi)
    density = float(theory.number_density(0.01, 2))
    expected = float(theory.shear_viscosity(1.0, 0.0, 0.01)) / density
    assert kinematic == pytest.approx(expected, rel=0.05)
