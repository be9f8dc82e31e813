"""Relaxation of theta: the exact solution against numerical integration and its own rate."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from integration import integrate

from roughgas import theory

DRIVES = [None, 0, 0.4, 1]
PLACES = [(0.9, -0.8), (0.9, 0.5), (0.6, 0), (0.99, 1.0), (1.0, -0.5)]


def temperatures(theta0, r, beta, collisions, dimension, s):
    """T_tr and T_rot at `collisions`, the drive giving back what collisions dissipate."""

    def slope(now):
        T_tr, T_rot = np.maximum(now, 0)
        change = np.array(theory.temperature_changes(T_tr, T_rot, r, beta, dimension))
        if s is None:
            return change
        power = -(dimension * change[0] + (2 * dimension - 3) * change[1]) / 2
        return change + theory.drive_changes(np.maximum(power, 0), s, dimension)

    return integrate(slope, (np.ones_like(theta0), theta0), collisions)


@pytest.mark.parametrize("dimension", [2, 3])
@pytest.mark.parametrize("s", DRIVES)
def test_relax_solves_the_rate_equations(dimension, s):
    collisions = np.array([0, 0.5, 2, 8, 20])
    theta0, (r, beta) = np.array([0, 0.3, 5, 0, 1]), np.transpose(PLACES)
    T_tr, T_rot = temperatures(theta0, r, beta, collisions, dimension, s)
    places = (part[:, None] for part in (theta0, r, beta))
    gas = theory.relax(*places, collisions, dimension, spin_share=s)
    assert gas.T_tr == pytest.approx(T_tr, rel=1e-8)
    assert gas.T_rot == pytest.approx(T_rot, rel=1e-8, abs=1e-14)
    assert gas.theta == pytest.approx(T_rot / T_tr, rel=1e-8, abs=1e-14)


@pytest.mark.parametrize("dimension", [2, 3])
@pytest.mark.parametrize("s", DRIVES)
@pytest.mark.parametrize(("r", "beta"), PLACES)
def test_rate_is_the_slope_of_a_small_deviation(dimension, s, r, beta):
    theta = theory.stationary_theta(r, beta, dimension, spin_share=s)
    gamma = theory.relaxation_rate(r, beta, dimension, spin_share=s)
    start, step = theta * (1 + 1e-6), 1e-3 / gamma
    later = theory.relax(start, r, beta, step, dimension, spin_share=s).theta
    slope = -np.log((later - theta) / (start - theta)) / step
    assert slope == pytest.approx(gamma, rel=1e-4)


@settings(derandomize=True, deadline=None)
@given(
    r=st.floats(0, 1),
    beta=st.floats(-0.999, 1),
    dimension=st.sampled_from([2, 3]),
    s=st.sampled_from(DRIVES),
    theta0=st.floats(0, 100),
)
def test_theta_approaches_its_stationary_value_without_crossing_it(r, beta, dimension, s, theta0):
    theta = theory.stationary_theta(r, beta, dimension, spin_share=s)
    gamma = theory.relaxation_rate(r, beta, dimension, spin_share=s)
    assert gamma > 0
    collisions = np.linspace(0, 40, 50) / gamma
    gap = theory.relax(theta0, r, beta, collisions, dimension, spin_share=s).theta - theta
    margin = 1e-12 * (theta + theta0)
    assert gap[0] == pytest.approx(theta0 - theta, abs=margin)
    assert (np.diff(np.abs(gap)) <= margin).all()
    assert (gap * (theta0 - theta) >= -(margin**2) - margin * abs(theta0 - theta)).all()
    assert abs(gap[-1]) <= 1e-9 * (1 + theta) * (1 + theta0)


@pytest.mark.parametrize("s", DRIVES)
@pytest.mark.parametrize("theta0", [0, 0.2, 3])
@pytest.mark.parametrize(("r", "beta"), PLACES)
def test_collisions_to_relax_ends_at_the_tolerance(s, theta0, r, beta):
    R = theory.stationary_ratio(r, beta, spin_share=s)
    needed = theory.collisions_to_relax(r, beta, 0.02, spin_share=s, theta0=theta0)
    assert needed > 0
    theta = theory.relax(theta0, r, beta, needed, spin_share=s).theta
    assert abs(theta / (1 + theta) / R - 1) == pytest.approx(0.02, rel=1e-9)


def test_nothing_to_wait_for_within_the_tolerance():
    theta = theory.stationary_theta(0.9, 0.5)
    assert theory.collisions_to_relax(0.9, 0.5, 0.01, theta0=1.001 * theta) == 0


def test_decoupled_spin_keeps_its_energy():
    collisions = np.array([0, 1, 10, 1e6])
    still = theory.relax(0.5, 0.9, -1, collisions)
    assert still.T_rot == pytest.approx(0.5, rel=1e-15)
    assert still.T_tr[:3] == pytest.approx(np.exp(-(1 - 0.9**2) / 2 * collisions[:3]), rel=1e-13)
    assert np.isinf(still.theta[-1])
    assert (theory.relax(0, 0.9, -1, collisions).theta == 0).all()
    assert np.isinf(theory.collisions_to_relax(0.9, -1))
    assert np.isinf(theory.collisions_to_relax(1, -1, theta0=1))
    assert np.isinf(theory.collisions_to_relax(1, -1, spin_share=0.5))
    assert theory.relaxation_rate(1, -1) == 0
