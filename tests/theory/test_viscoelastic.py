"""Viscoelastic particles: their restitution, and the temperature of a gas of them."""

import numpy as np
import pytest
from integration import integrate

from roughgas import theory
from roughgas.base import InputError
from roughgas.effects.viscoelastic import pade, x_of

SPEEDS = np.geomspace(1e-4, 1e4, 9)


@pytest.mark.parametrize("r", [0.05, 0.5, 0.9, 0.9999])
def test_restitution_is_that_of_the_kernel(r):
    found = theory.viscoelastic_restitution(SPEEDS, r, 3.0)
    expected = [pade(x_of(r) * (g / 3.0) ** 0.2) for g in SPEEDS]
    assert found == pytest.approx(expected, rel=1e-12)
    assert theory.viscoelastic_restitution(3.0, r, 3.0) == pytest.approx(r, rel=1e-13)


def test_elastic_particles_stay_elastic():
    assert np.all(theory.viscoelastic_restitution(SPEEDS, 1.0) == 1.0)
    assert theory.maxwellian_restitution(2.0, 1.0) == 1.0
    assert np.isinf(theory.viscoelastic_time(1.0, 1.0, 0.3))
    assert np.all(theory.viscoelastic_temperature(SPEEDS, 1.5, 1.0, 0.3) == 1.5)


def test_maxwellian_restitution_is_an_average_over_contacts():
    """Of a million normal speeds, whose squares over 4 T_tr are exponential."""
    T, r, speed = 2.3, 0.7, 0.5
    g = np.sqrt(4.0 * T * np.random.default_rng(1).exponential(size=10**6))
    lost = (1.0 - theory.viscoelastic_restitution(g, r, speed) ** 2) * g**2 / (4.0 * T)
    error = lost.std() / 1e3
    found = 1.0 - theory.maxwellian_restitution(T, r, speed) ** 2
    assert abs(found - lost.mean()) < 4.0 * error < 0.01 * found


def test_nearly_elastic_particles_lose_what_the_closed_form_says():
    """To first order in x: 1 - r_T^2 = 2 x_0 (4 T)^(1/10) Gamma(21/10)."""
    for T in (0.1, 1.0, 7.0):
        tau = theory.viscoelastic_time(T, 1.0 - 1e-6, 0.3, dimension=2)
        lost = 1.0 - theory.maxwellian_restitution(T, 1.0 - 1e-6) ** 2
        assert 1.0 / tau == pytest.approx(3 / 5 * 0.3 * lost / 2, rel=1e-5)


@pytest.mark.parametrize("dimension", [2, 3])
def test_the_closed_form_solves_the_rate_equations_of_a_smooth_gas(dimension):
    T0, r, nu = 1.7, 1.0 - 1e-5, 0.4
    tau = theory.viscoelastic_time(T0, r, nu, dimension=dimension)
    gas = theory.viscoelastic_cooling(8e5, T0, r, -1.0, nu, dimension=dimension)[1:3]
    time, T_tr = (column[:: len(gas[0]) // 20] for column in gas)
    assert time[-1] > 10.0 * tau
    expected = theory.viscoelastic_temperature(time, T0, r, nu, dimension=dimension)
    assert T_tr == pytest.approx(expected, rel=2e-5)


@pytest.mark.parametrize("beta", [0.0, 1.0])
def test_cooling_is_integrated_to_many_digits(beta):
    gas = theory.viscoelastic_cooling(20.0, 1.0, 0.6, beta, 0.3, 2.0)

    def slope(state):
        r = theory.maxwellian_restitution(state[1], 0.6, 2.0)
        changes = theory.temperature_changes(*state[1:], r, beta)
        return np.array([1.0 / (0.3 * np.sqrt(state[1])), *changes])

    expected = integrate(slope, np.array([0.0, 1.0, 0.0]), [20.0], pieces=100)
    assert [column[-1] for column in gas[1:]] == pytest.approx(expected[:, 0], rel=1e-8)


def test_perfectly_rough_particles_cool_as_smooth_ones_but_more_slowly():
    """T ~ t^(-5/3), tau longer by the degrees of freedom: (D + n_r)/D = 3/2."""
    nu, r, speed = 0.3, 0.9, 100.0
    tau = 1.5 * theory.viscoelastic_time(1.0, r, nu, speed)
    gas = theory.viscoelastic_cooling(300.0, 1.0, r, 1.0, nu, speed)
    assert gas.T_rot[-1] / gas.T_tr[-1] == pytest.approx(1.0, rel=0.05)
    late = gas.time > 2.0 * tau
    slope = np.polyfit(np.log(gas.time[late] + tau), np.log(gas.T_tr[late]), 1)[0]
    assert slope == pytest.approx(-5.0 / 3.0, abs=0.05)


def test_mistakes():
    for r in (0.0, 1.1, -0.2):
        with pytest.raises(InputError, match=r"restitution r = .*: must lie in"):
            theory.viscoelastic_restitution(1.0, r)
    with pytest.raises(InputError, match=r"speed = 0\.0: must be a positive number"):
        theory.maxwellian_restitution(1.0, 0.9, 0.0)
