"""Coulomb friction: energies, stationary states, relaxation; particles that run away."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from tests.theory.collisions import maxwellian_pairs, sigmas
from tests.theory.tracers import final_spins

from roughgas import theory

PAIRS = 100_000
SIGMAS = 5

gases = {
    "r": st.floats(0, 1),
    "beta": st.floats(-1, 1),
    "q": st.floats(0.05, 1),
    "dimension": st.sampled_from([2, 3]),
}
friction = st.one_of(st.floats(0, 5), st.floats(1e-6, 0.1))
share = st.one_of(st.none(), st.floats(0, 1))
temperature = st.floats(0, 5)


def sampled_changes(theta, r, beta, mu, dimension, q, seed):
    """Return energy changes of pairs of a gas with T_tr = 1 and T_rot = theta, translational and
    rotational, whether each pair slides, and its collision weight."""
    before = maxwellian_pairs(np.random.default_rng(seed), PAIRS, dimension, theta / q)
    after = before.after(r, beta, q, mu)
    impulse = after.v1 - before.v1
    normal = np.sum(impulse * before.n, axis=1, keepdims=True)
    along = np.linalg.norm(impulse - normal * before.n, axis=1)
    slides = along > (1 - 1e-9) * mu * np.abs(normal[:, 0])
    return *(after.energies(q) - before.energies(q)), slides, before.approach()


@pytest.mark.parametrize("dimension", [2, 3])
@pytest.mark.parametrize(
    ("r", "beta", "mu", "theta", "q"),
    [
        (0.9, 0.5, 0.3, 0.4, None),
        (0.6, 1.0, 0.1, 2.0, 0.3),
        (1.0, 0.0, 1.0, 0.0, 0.7),
        (0.8, -1.0, 0.2, 1.0, None),
    ],
)
def test_changes_are_those_of_sampled_collisions(dimension, r, beta, mu, theta, q):
    """Means over 1e5 pairs within 5 standard errors: of 70000 seeds one fails any by chance."""
    inertia = theory.moment_of_inertia(dimension) if q is None else q
    tr, rot, slides, often = sampled_changes(theta, r, beta, mu, dimension, inertia, seed=7)
    rates = theory.friction_changes(1, theta, r, beta, mu, dimension, inertia)
    assert sigmas(tr, often, dimension * rates[0]) < SIGMAS
    assert sigmas(rot, often, (2 * dimension - 3) * rates[1]) < SIGMAS
    expected = theory.sliding_fraction(1, theta, r, beta, mu, dimension, inertia)
    assert sigmas(slides, often, expected) < SIGMAS


@settings(derandomize=True, deadline=None)
@given(**gases, T_tr=temperature, T_rot=temperature)
def test_infinite_friction_is_the_gas_without_sliding(r, beta, q, dimension, T_tr, T_rot):
    gas = (r, beta, np.inf, dimension, q)
    expected = theory.temperature_changes(T_tr, T_rot, r, beta, dimension, q, 3.0)
    assert theory.friction_changes(T_tr, T_rot, *gas, 3.0) == pytest.approx(expected, rel=1e-14)
    assert theory.sliding_fraction(T_tr, T_rot, *gas) == 0


@settings(derandomize=True, deadline=None)
@given(**gases, T_tr=temperature, T_rot=temperature)
def test_no_friction_is_the_smooth_gas(r, beta, q, dimension, T_tr, T_rot):
    changes = theory.friction_changes(T_tr, T_rot, r, beta, 0, dimension, q)
    assert changes == pytest.approx((-(1 - r**2) * T_tr / dimension, 0), abs=1e-15)
    assert theory.sliding_fraction(T_tr, T_rot, r, beta, 0, dimension, q) == (beta > -1)


@settings(derandomize=True, deadline=None)
@given(**gases, mu=friction, T_tr=temperature, T_rot=temperature)
def test_energy_is_never_gained(r, beta, q, dimension, mu, T_tr, T_rot):
    changes = theory.friction_changes(T_tr, T_rot, r, beta, mu, dimension, q)
    assert dimension * changes[0] + (2 * dimension - 3) * changes[1] <= 1e-14 * (T_tr + T_rot / q)


@settings(derandomize=True, deadline=None)
@given(r=st.floats(0, 1), beta=st.floats(-0.999, 1), q=st.floats(0.05, 1), mu=st.floats(1e-3, 10))
def test_driven_disks_obey_a_closed_form(r, beta, q, mu):
    """Lun's formula with friction, at mu = inf with a root of 1 - e: dT_rot = 0 is a quadratic."""
    e, kappa = (1 + beta) / (2 * (1 + q)), mu * (1 + r) / 2
    theta = 2 * q * e / (1 - e + np.hypot(1 - e, q * e / kappa))
    R = theory.friction_ratio(r, beta, mu, 2, q, spin_share=0)
    assert pytest.approx(theta / (1 + theta), abs=1e-13) == R


@pytest.mark.slow
@settings(derandomize=True, deadline=None)
@given(**gases, mu=friction, spin_share=share)
def test_stationary_states_are_stationary(r, beta, q, dimension, mu, spin_share):
    """For 0 < R < 1 ln theta is constant, or the losses have the shares of the drive."""
    R = theory.friction_ratio(r, beta, mu, dimension, q, spin_share)
    assert 0 <= R <= 1
    tr, rot = theory.friction_changes(1 - R, R, r, beta, mu, dimension, q)
    if spin_share is None:
        assert R * tr == pytest.approx((1 - R) * rot, abs=1e-13)
    else:
        rotational_loss = (1 - spin_share) * (2 * dimension - 3) * rot
        assert spin_share * dimension * tr == pytest.approx(rotational_loss, abs=1e-13 / q**2)


@pytest.mark.parametrize("dimension", [2, 3])
def test_a_cooling_gas_has_at_most_two_stationary_states_and_R_is_the_first(dimension):
    """Found as sign changes of d ln theta/dn, or none, along theta in steps of 2%."""
    rng, size = np.random.default_rng(11), (200, 1)
    theta = np.exp(np.arange(-25, 25, 0.02))
    r, beta = 1 - 10 ** rng.uniform(-5, 0, size), rng.uniform(-1, 1, size)
    mu, q = 10 ** rng.uniform(-5, 1, size), 10 ** rng.uniform(-1.5, 0.3, size)
    tr, rot = theory.friction_changes(1, theta, r, beta, mu, dimension, q)
    changes = np.diff(rot / theta - tr > 0)
    with_states, first = changes.any(axis=1), changes.argmax(axis=1)
    R = theory.friction_ratio(r, beta, mu, dimension, q)[:, 0]
    stationary = R[with_states] / (1 - R[with_states])
    assert (theta[first[with_states]] <= stationary).all()
    assert (stationary <= theta[first[with_states] + 1]).all()
    assert (R[~with_states] > 1 - 1e-10).all()
    assert set(changes.sum(axis=1)) == {0, 1, 2}


@pytest.mark.parametrize("dimension", [2, 3])
def test_below_the_critical_friction_a_spinning_gas_keeps_its_spin(dimension):
    """Sliding heats translation by mu^2 (1+r)^2 T_tr, inelasticity cools it by (1-r^2) T_tr."""
    mu, fast = np.sqrt(0.1 / 1.9) * np.array([0.99, 1.01]), 1e12
    tr, rot = theory.friction_changes(1, fast, 0.9, 0.4, mu, dimension)
    assert (rot / fast - tr > 0).tolist() == [True, False]
    R = theory.friction_ratio(0.9, 0.4, mu, dimension, spin_share=1)
    assert R[0] == 1
    assert R[1] < 1


GASES = [(0.9, 0.0, 2), (0.9, -0.5, 2), (0.8, 1.0, 2), (0.9, 0.5, 3)]


@pytest.mark.parametrize(("r", "beta", "dimension"), GASES)
def test_the_relaxation_rate_without_sliding_is_that_of_the_rate_equations(r, beta, dimension):
    rate = theory.friction_relaxation_rate(r, beta, np.inf, dimension)
    assert rate == pytest.approx(theory.relaxation_rate(r, beta, dimension), rel=1e-6)


@pytest.mark.parametrize("mu", [0.02, 0.15, 0.5, 2.0])
@pytest.mark.parametrize(("r", "beta", "dimension"), GASES)
def test_a_small_deviation_fades_at_the_relaxation_rate(r, beta, dimension, mu):
    """Integrated in small steps: a deviation of theta, or 1/theta where R goes to 1."""
    rate = theory.friction_relaxation_rate(r, beta, mu, dimension)
    R = theory.friction_ratio(r, beta, mu, dimension)
    runaway = R == 1.0
    theta = 1e7 if runaway else 1.001 * R / (1 - R)
    steps, length = 500, 1.0 / rate
    for _ in range(steps):
        T_tr, T_rot = theory.friction_changes(1.0, theta, r, beta, mu, dimension)
        theta *= np.exp((T_rot / theta - T_tr) * length / steps)
    if runaway:
        assert np.log(theta / 1e7) == pytest.approx(1.0, abs=0.01)
    else:
        left = (theta * (1 - R) / R - 1.0) / 0.001
        assert left == pytest.approx(np.exp(-1.0), abs=0.01)


RUNAWAY_GASES = [(0.9, 0.0, 0.1, 2), (0.9, 0.0, 0.3, 3)]


def simulated_spinners(gas, start, folds, spinners=1500):
    """Return the result of `final_spins` after `folds` e-folds of the gas temperature."""
    r, beta, mu, dimension = gas
    R, rate = theory.friction_ratio(*gas), theory.cooling_rate(*gas)
    surroundings = r, beta, mu, R / (1 - R), dimension
    tau = theory.spinner_temperature(*gas)
    return final_spins(spinners, start, surroundings, rate, tau, folds / rate, 1)


@pytest.mark.slow
@pytest.mark.parametrize("gas", RUNAWAY_GASES)
def test_a_spinner_loses_the_threshold_and_keeps_the_rest(gas):
    """From three times the threshold, so that contacts slide at all times. Within 4 standard errors
    and, where contacts push most (mu = 0.3), 3 % for velocities that are not Maxwellian."""
    threshold = theory.runaway_spin(*gas)
    left, square = simulated_spinners(gas, 3 * threshold, 12)
    lost = 3 - left / threshold
    error = lost.std(ddof=1) / math.sqrt(len(lost))
    assert error < 0.01
    closure = 0.03 if gas[2] == 0.3 else 0.0
    assert lost.mean() == pytest.approx(1.0, abs=4 * error + closure)
    assert square == pytest.approx(theory.spinner_temperature(*gas), rel=0.04)


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


@pytest.mark.parametrize("gas", [(0.9, 0.0, 0.08, 2), (0.9, 0.0, 0.105, 3)])
def test_the_share_beyond_the_threshold_is_that_of_a_sampled_maxwellian(gas):
    """Of two million random spins; within 4 standard errors."""
    size = 2_000_000, 2 * gas[3] - 3
    spins = np.random.default_rng(2).standard_normal(size, np.float32)
    R, q = theory.friction_ratio(*gas), theory.moment_of_inertia(gas[3])
    spins = np.linalg.norm(spins, axis=1) * math.sqrt(R / (1 - R) / q)
    expected = theory.maxwellian_share(*gas)
    error = math.sqrt(expected / len(spins))
    assert error < 0.15 * expected
    assert np.mean(spins > theory.runaway_spin(*gas)) == pytest.approx(expected, abs=4 * error)


def minimal_exponent(gas):
    """Return the minimum of E over all initial spins: p by bisection, averages by quadrature."""
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
    for k, spin in enumerate(w):
        low, high = 1e-6, 1e3
        for _ in range(50):
            p[k] = math.sqrt(low * high)
            grows = rate * p[k] * spin / 2 > frequency * (
                1 - np.sum(density * np.exp(-p[k] * lost))
            )
            low, high = (low, p[k]) if grows else (p[k], high)
    path = np.cumsum(((p[1:] + p[:-1]) / 2 * np.diff(w))[::-1])[::-1]
    return np.min(w[:-1] ** 2 / (2 * variance) + path)


@pytest.mark.slow
@pytest.mark.parametrize("mu", [0.1, 0.2, 0.4])
def test_the_runaway_rate_is_that_of_the_most_probable_path(mu):
    gas = 0.9, 0.0, mu
    assert -math.log(theory.runaway_rate(*gas)) == pytest.approx(minimal_exponent(gas), rel=2e-3)


def test_the_time_of_escape_is_waiting_and_growth():
    gas, particles = (0.9, 0.0, 0.2), np.array([1e2, 1e4, 1e6])
    growth, time = (
        function(particles, *gas) for function in (theory.runaway_growth, theory.runaway_time)
    )
    waiting = 1 / (particles * theory.runaway_rate(*gas))
    assert time == pytest.approx(growth + waiting)
    # then the spinner has nine times the energy of all translation
    spin = theory.runaway_spin(*gas)
    grown = 0.5 * 0.5 * spin**2 * np.exp(theory.cooling_rate(*gas) * growth)
    assert grown == pytest.approx(9 * particles, rel=1e-9)
    assert np.all(np.isnan(theory.runaway_time(100, 0.9, 0.0, [0.05, 1.2])))
