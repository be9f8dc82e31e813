"""Closed forms of gases in a bath whose medium rotates or flows."""

import numpy as np
import pytest
from tests.theory.collisions import maxwellian_pairs, sigmas

from roughgas import theory


@pytest.mark.parametrize("dimension", [2, 3])
@pytest.mark.parametrize(("beta", "q"), [(0.3, 0.5), (1.0, 0.2), (-0.6, 1.0)])
def test_contacts_slow_the_mean_spin_by_the_collision_rule(dimension, beta, q):
    """100,000 random contacts, within 4 standard errors."""
    rng = np.random.default_rng(3)
    pairs = maxwellian_pairs(rng, 100_000, dimension, 0.7)
    mean = np.array([0.0, 0.0, 2.0])
    pairs = pairs._replace(w1=pairs.w1 + mean, w2=pairs.w2 + mean)
    after, weights = pairs.after(0.9, beta, q), pairs.approach()
    change = ((after.w1 - pairs.w1) + (after.w2 - pairs.w2))[:, 2] / 2.0
    expected = -2.0 * theory.mean_spin_decay(beta, dimension, q)
    assert sigmas(change, weights, expected) < 4.0


def test_smooth_spinners_turn_with_the_medium():
    assert theory.mean_spin_of_spinners(-1.0, 3.0, 0.1) == 1.0
    assert theory.mean_spin_of_spinners(0.3, 3.0, 0.0) == 0.0


def test_published_form_of_the_mean_spin():
    """1/[1 + nu (1 + beta)/((1 + q) g)] of disks, 2 nu/3 in place of nu of spheres."""
    disks = theory.mean_spin_of_spinners(0.2, 0.7, 0.3, 2, 0.4)
    spheres = theory.mean_spin_of_spinners(0.2, 1.05, 0.3, 3, 0.4)
    assert disks == pytest.approx(1.0 / (1.0 + 0.7 * 1.2 / (1.4 * 0.3)))
    assert spheres == pytest.approx(disks)


@pytest.mark.parametrize("interval", [0.0, 1e-9, 0.5, 3.0])
def test_the_pressure_in_a_flowing_bath_is_that_of_the_steps_and_flights(interval):
    """The stationary moments of c -> e^(-g h) (c - G h c_y x) + noise, averaged over flights."""
    G, g, T = 0.7, 0.4, 1.3
    h = interval or 1e-6
    f = np.exp(-g * h)
    shear, noise = np.array([[1.0, -G * h], [0.0, 1.0]]), (1.0 - f**2) * T * np.eye(2)
    step = f * shear
    solution = np.linalg.solve(np.eye(4) - np.kron(step, step), noise.ravel()).reshape(2, 2)
    instants = (np.arange(2000) + 0.5) / 2000 * h
    flights = [np.array([[1.0, -G * s], [0.0, 1.0]]) for s in instants]
    mean = np.mean([flight @ solution @ flight.T for flight in flights], axis=0)
    pressure = theory.pressure_in_sheared_bath(G, g, T, interval)
    assert pressure.xx == pytest.approx(mean[0, 0], rel=3e-6)
    assert pressure.xy == pytest.approx(mean[0, 1], rel=3e-6)
    assert pressure.yy == pytest.approx(mean[1, 1], rel=3e-6)


def test_the_pressure_in_a_flowing_bath_differs_by_the_square_of_the_interval():
    """By a share (gamma h)^2/3 of each term of the shear."""
    limit, near = (theory.pressure_in_sheared_bath(0.5, 0.1, 2.0, h) for h in (0.0, 0.1))
    assert limit == pytest.approx((2.0 * (1.0 + 0.5 * 25.0), -0.5 / 0.2 * 2.0, 2.0))
    share = (0.1 * 0.1) ** 2 / 3.0
    assert near.xy / limit.xy - 1.0 == pytest.approx(share, rel=1e-3)
    assert (near.xx - 2.0) / (limit.xx - 2.0) - 1.0 == pytest.approx(share, rel=1e-3)
