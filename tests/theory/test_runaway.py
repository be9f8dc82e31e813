"""Theory of single spinners that a gas with friction leaves behind."""

import math

import numpy as np
import pytest
from tests.theory.tracers import spin_in_the_end

from roughgas import theory
from roughgas.base import InputError

GASES = [(0.9, 0.0, 0.1, 2), (0.9, 0.0, 0.3, 2), (0.99, 0.5, 0.05, 2), (0.9, 0.0, 0.3, 3)]


def simulated(gas, start, folds, spinners=1500):
    """What `spin_in_the_end` returns after so many e-folds of the temperature of the gas."""
    r, beta, mu, dimension = gas
    R, rate = theory.friction_ratio(*gas), theory.cooling_rate(*gas)
    around = r, beta, mu, R / (1 - R), dimension
    tau = theory.spinner_temperature(*gas)
    return spin_in_the_end(spinners, start, around, rate, tau, folds / rate, 1)


@pytest.mark.parametrize("gas", GASES)
def test_a_spinner_loses_the_threshold_and_keeps_the_rest(gas):
    """From three times the threshold, so that contacts slide at all times. Within 4 standard errors
    and, where contacts push most (mu = 0.3), 3 % for velocities that are not Maxwellian."""
    threshold = theory.runaway_spin(*gas)
    left, square = simulated(gas, 3 * threshold, 12)
    lost = 3 - left / threshold
    error = lost.std(ddof=1) / math.sqrt(len(lost))
    assert error < 0.01
    closure = 0.03 if gas[2] == 0.3 else 0.0
    assert lost.mean() == pytest.approx(1.0, abs=4 * error + closure)
    assert square == pytest.approx(theory.spinner_temperature(*gas), rel=0.04)


@pytest.mark.parametrize("gas", GASES[:3])
def test_the_threshold_separates_who_stays_from_who_leaves(gas):
    """Losses scatter by a quarter of the threshold: beyond twice it nearly all get away (in units
    of the gas their spin then grows without end), below half of it hardly any."""
    threshold = theory.runaway_spin(*gas)
    for times, least, most in ((0.4, 0.0, 0.1), (1.0, 0.3, 0.7), (2.0, 0.95, 1.0)):
        left, _ = simulated(gas, times * threshold, 6, 400)
        away = np.mean(left * math.exp(3) > 2 * threshold)  # in units of the gas, six e-folds later
        assert least <= away <= most


@pytest.mark.parametrize("dimension", [2, 3])
def test_pushes_balance_the_cooling_of_a_spinner(dimension):
    """The energy that contacts put in and take from its translation, summed over a Maxwellian."""
    r, beta, mu = 0.9, 0.0, np.array([0.1, 0.2, 0.5, 0.9])
    tau = theory.spinner_temperature(r, beta, mu, dimension)[1 if dimension == 3 else 0 :]
    mu = mu[-len(tau) :]
    k, rate = (1 + r) / 2, theory.cooling_rate(r, beta, mu, dimension)
    speed = 2 * (1 + tau)  # <g_n^2> at contacts
    gained = k**2 * (1 + mu**2) * speed - 2 * k * tau / (1 + tau) * speed
    frequency = np.sqrt((1 + tau) / 2)
    assert frequency * gained / dimension + rate * tau == pytest.approx(np.zeros(len(mu)), abs=1e-9)


def test_the_threshold_of_slow_weak_friction_has_a_closed_form():
    """tau = 1, disks: a w* = sqrt(pi) mu (1+r)/(q gamma) sqrt(T_tr/m), if gamma << 1."""
    gas = 0.9999, 0.0, 2e-3
    expected = math.sqrt(math.pi) * gas[2] * (1 + gas[0]) / (0.5 * theory.cooling_rate(*gas))
    assert theory.runaway_spin(*gas) == pytest.approx(expected, rel=0.01)


def test_the_gas_cools_at_the_rate_of_the_rate_equations():
    """Both temperatures fall alike at the stationary R."""
    gas = 0.9, 0.3, np.array([0.15, 0.3, 1.0, np.inf])
    R = theory.friction_ratio(*gas)
    changes = theory.friction_changes(1 - R, R, *gas)
    assert -changes[0] / (1 - R) == pytest.approx(theory.cooling_rate(*gas), rel=1e-12)
    assert -changes[1] / R == pytest.approx(theory.cooling_rate(*gas), rel=1e-8)
    smooth = theory.temperature_changes(1 - R[-1], R[-1], 0.9, 0.3)[0] / (1 - R[-1])
    assert theory.cooling_rate(0.9, 0.3, np.inf) == pytest.approx(-smooth)


def test_limits_of_the_threshold():
    assert theory.runaway_spin(0.9, 0.0, [0.0, 0.05, 1.1]) == pytest.approx([0, 0, np.inf])
    assert theory.runaway_spin(0.9, -1.0, 0.3) == 0
    assert theory.runaway_spin(0.9, 0.0, np.inf) == theory.runaway_spin(1, 1, np.inf) == np.inf
    assert math.isnan(theory.cooling_rate(0.9, 0.0, 0.05))
    assert theory.maxwellian_share(0.9, 0.0, [0.05, 2.0]) == pytest.approx([1, 0])
    rising = theory.runaway_spin(0.9, 0.0, np.linspace(0.08, 1, 20))
    assert np.all(np.diff(rising) > 0)


@pytest.mark.parametrize("gas", [(0.9, 0.0, 0.08, 2), (0.9, 0.0, 0.105, 3)])
def test_the_share_of_a_maxwellian_beyond_the_threshold(gas):
    """Of two million drawn; within 4 standard errors."""
    spins = np.random.default_rng(2).standard_normal((2_000_000, 2 * gas[3] - 3))
    R, q = theory.friction_ratio(*gas), theory.moment_of_inertia(gas[3])
    spins = np.linalg.norm(spins, axis=1) * math.sqrt(R / (1 - R) / q)
    expected = theory.maxwellian_share(*gas)
    error = math.sqrt(expected / len(spins))
    assert error < 0.15 * expected
    assert np.mean(spins > theory.runaway_spin(*gas)) == pytest.approx(expected, abs=4 * error)


def cheapest_way(gas):
    """The least E of all beginnings: p by bisection of its equation, averages by quadrature."""
    R, rate, threshold = (
        theory.friction_ratio(*gas),
        theory.cooling_rate(*gas),
        theory.runaway_spin(*gas),
    )
    tau = theory.spinner_temperature(*gas)
    frequency, variance = math.sqrt((1 + tau) / 2), R / (1 - R) / 0.5
    lost = gas[2] * (1 + gas[0]) / (2 * 0.5) * math.sqrt(1 + tau) * np.linspace(0, 9, 4000)
    density = np.linspace(0, 9, 4000) * np.exp(-(np.linspace(0, 9, 4000) ** 2) / 2)
    density /= density.sum()
    w = np.linspace(0.1, 1, 500) * threshold
    p = np.empty(len(w))
    for k, one in enumerate(w):
        low, high = 1e-6, 1e3
        for _ in range(50):
            p[k] = math.sqrt(low * high)
            grows = rate * p[k] * one / 2 > frequency * (1 - np.sum(density * np.exp(-p[k] * lost)))
            low, high = (low, p[k]) if grows else (p[k], high)
    path = np.cumsum(((p[1:] + p[:-1]) / 2 * np.diff(w))[::-1])[::-1]
    return np.min(w[:-1] ** 2 / (2 * variance) + path)


@pytest.mark.parametrize("mu", [0.1, 0.2, 0.4])
def test_the_rate_is_that_of_the_cheapest_way(mu):
    gas = 0.9, 0.0, mu
    assert -math.log(theory.runaway_rate(*gas)) == pytest.approx(cheapest_way(gas), rel=2e-3)


def test_the_time_of_escape_is_waiting_and_growth():
    gas, particles = (0.9, 0.0, 0.2), np.array([1e2, 1e4, 1e6])
    growth, time = (one(particles, *gas) for one in (theory.runaway_growth, theory.runaway_time))
    waiting = 1 / (particles * theory.runaway_rate(*gas))
    assert time == pytest.approx(growth + waiting)
    # the spinner's energy is then nine times that of all translation
    spin = theory.runaway_spin(*gas)
    grown = 0.5 * 0.5 * spin**2 * np.exp(theory.cooling_rate(*gas) * growth)
    assert grown == pytest.approx(9 * particles, rel=1e-9)
    assert np.all(np.isnan(theory.runaway_time(100, 0.9, 0.0, [0.05, 1.2])))


def test_illegal_arguments_are_named():
    with pytest.raises(InputError, match="friction mu"):
        theory.runaway_spin(0.9, 0.0, -0.1)
    with pytest.raises(InputError, match="particles"):
        theory.runaway_time(-1, 0.9, 0.0, 0.1)
