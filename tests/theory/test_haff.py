"""Haff's law against numerical integration of the rate equations in time."""

import numpy as np
import pytest
from integration import integrate

from roughgas import theory


@pytest.mark.parametrize("dimension", [2, 3])
def test_haff_temperature_solves_the_rate_equations_in_time(dimension):
    r, beta, T0, packing = np.array([0.9, 0.8, 0.99]), np.array([-0.5, 0.3, 1.0]), 1.7, 0.05
    start = (np.full(3, T0), T0 * theory.stationary_theta(r, beta, dimension))
    nu = theory.collision_frequency(T0, packing, dimension)
    units = theory.haff_time(r, beta, nu, dimension)
    times = np.arange(6.0)

    def slope(temperatures):
        T_tr, T_rot = temperatures
        now = theory.collision_frequency(T_tr, packing, dimension)
        changes = theory.temperature_changes(T_tr, T_rot, r, beta, dimension, frequency=now)
        return units * np.array(changes)

    T_tr, _ = integrate(slope, start, times, pieces=50)
    haff = theory.haff_temperature(
        units[:, None] * times, T0, r[:, None], beta[:, None], nu, dimension
    )
    assert haff == pytest.approx(T_tr, rel=1e-7)
    assert haff[:, 1] == pytest.approx(T0 / 4, rel=1e-12)


@pytest.mark.parametrize("dimension", [2, 3])
def test_decay_rate_is_the_loss_at_the_stationary_state(dimension):
    r, beta = np.array([[0], [0.5], [0.9], [1]]), np.linspace(-0.9, 1, 8)
    theta = theory.stationary_theta(r, beta, dimension)
    rate_tr, rate_rot = theory.temperature_changes(1, theta, r, beta, dimension)
    decay = theory.decay_rate(r, beta, dimension)
    assert decay == pytest.approx(-rate_tr, abs=1e-14)
    assert decay == pytest.approx(-rate_rot / theta, abs=1e-14)


def test_relaxed_gas_decays_at_the_decay_rate():
    gas = theory.relax(0, 0.9, 0.5, np.array([60, 61]))
    assert np.log(gas.T_tr[0] / gas.T_tr[1]) == pytest.approx(theory.decay_rate(0.9, 0.5))


@pytest.mark.parametrize("dimension", [2, 3])
def test_smooth_gas(dimension):
    """Haff (1983) for smooth particles: t_h = 2 D/[nu (1 - r^2)]."""
    expected = 2 * dimension / (0.3 * (1 - 0.8**2))
    assert theory.haff_time(0.8, -1, 0.3, dimension) == pytest.approx(expected, rel=1e-14)
    assert theory.decay_rate(0.8, -1 + 1e-9, dimension) < 1e-8


@pytest.mark.parametrize("beta", [-1, 1])
def test_elastic_gas_does_not_cool(beta):
    assert np.isinf(theory.haff_time(1, beta, 0.5))
    assert (theory.haff_temperature([0, 1e6], 2, 1, beta, 0.5) == 2).all()
