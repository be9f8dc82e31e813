"""Energy changes, averages and rates against the collision rule itself, the collision rule."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from roughgas import theory

PAIRS = 400_000
SIGMAS = 5
MATERIALS = [(2, 0.9, 0.3, 0.5), (2, 0.6, -0.7, 1.0), (3, 0.8, -0.2, 0.4), (3, 1.0, 1.0, 0.4)]
THETA = 0.6


def collide(v1, v2, w1, w2, n, r, beta, q):
    """Velocities and spins after a collision, arrays (pairs, 3); n points from 2 to 1, a = 1."""
    v = v1 - v2
    v_n = (v * n).sum(-1, keepdims=True) * n
    slip = v - v_n - np.cross(w1 + w2, n)
    kick = (1 + r) / 2 * v_n + q * (1 + beta) / (2 * q + 2) * slip
    spin = (1 + beta) / (2 * q + 2) * np.cross(n, slip)
    return v1 - kick, v2 + kick, w1 + spin, w2 + spin


def kinetic(first, second):
    return ((first**2).sum(-1) + (second**2).sum(-1)) / 2


def energy_changes(state, r, beta, q):
    """Exact changes of the pair's translational and rotational energies."""
    v1, v2, w1, w2, _ = state
    after = collide(*state, r, beta, q)
    return kinetic(*after[:2]) - kinetic(v1, v2), q * (kinetic(*after[2:]) - kinetic(w1, w2))


def invariants(state):
    """v_n^2, v_t^2, v_t.v_r and v_r^2 of each pair."""
    v1, v2, w1, w2, n = state
    v = v1 - v2
    v_n = (v * n).sum(-1, keepdims=True) * n
    v_t, v_r = v - v_n, -np.cross(w1 + w2, n)
    products = ((v_n, v_n), (v_t, v_t), (v_t, v_r), (v_r, v_r))
    return [(x * y).sum(-1) for x, y in products]


def maxwellian_pairs(dimension, q, seed, pairs=PAIRS):
    """Pairs of a gas with T_tr = 1, T_rot = THETA and n in any direction; planar in 2D."""
    rng = np.random.default_rng(seed)
    v1, v2, w1, w2, n = rng.standard_normal((5, pairs, 3))
    if dimension == 2:
        for vector in (v1, v2, n):
            vector[:, 2] = 0
        for spin in (w1, w2):
            spin[:, :2] = 0
    spread = np.sqrt(THETA / q)
    return v1, v2, w1 * spread, w2 * spread, n / np.linalg.norm(n, axis=-1, keepdims=True)


def collision_weights(state):
    """Pairs collide as often as they approach fast: weights proportional to -(v1 - v2).n."""
    v1, v2, _, _, n = state
    return np.maximum(-((v1 - v2) * n).sum(-1), 0)


def sigmas(samples, weights, expected):
    """Distance of the weighted mean from what is expected, in its standard errors."""
    mean = np.average(samples, weights=weights)
    error = np.sqrt((weights**2 * (samples - mean) ** 2).sum()) / weights.sum()
    return abs(mean - expected) / error


@settings(derandomize=True, deadline=None)
@given(
    r=st.floats(0, 1),
    beta=st.floats(-1, 1),
    q=st.floats(0.01, 2),
    dimension=st.sampled_from([2, 3]),
    seed=st.integers(0, 10**6),
)
def test_energy_changes_are_those_of_the_collision_rule(r, beta, q, dimension, seed):
    state = maxwellian_pairs(dimension, q, seed, pairs=20)
    exact_tr, exact_rot = energy_changes(state, r, beta, q)
    v_n2, v_t2, v_tr, v_r2 = invariants(state)
    size = v_n2 + v_t2 + v_r2 + kinetic(*state[:2]) + q * kinetic(*state[2:4])
    ours = theory.translational_energy_change(v_n2, v_t2, v_tr, v_r2, r, beta, q)
    assert (np.abs(ours - exact_tr) < 1e-12 * size).all()
    ours = theory.rotational_energy_change(v_t2, v_tr, v_r2, beta, q)
    assert (np.abs(ours - exact_rot) < 1e-12 * size).all()


@settings(derandomize=True, deadline=None)
@given(r=st.floats(0, 1), beta=st.floats(-1, 1), q=st.floats(0.01, 2), seed=st.integers(0, 10**6))
def test_no_collision_gains_energy(r, beta, q, seed):
    v_n2, v_t2, v_tr, v_r2 = invariants(maxwellian_pairs(3, q, seed, pairs=20))
    change = theory.translational_energy_change(v_n2, v_t2, v_tr, v_r2, r, beta, q)
    change += theory.rotational_energy_change(v_t2, v_tr, v_r2, beta, q)
    assert (change <= 1e-13 * (v_n2 + v_t2 + v_r2)).all()


def test_elastic_collisions_keep_the_energy():
    v_n2, v_t2, v_tr, v_r2 = invariants(maxwellian_pairs(3, 0.4, seed=1, pairs=100))
    for beta in (-1, 1):
        change = theory.translational_energy_change(v_n2, v_t2, v_tr, v_r2, 1, beta, 0.4)
        change += theory.rotational_energy_change(v_t2, v_tr, v_r2, beta, 0.4)
        assert change == pytest.approx(0, abs=1e-13)


@pytest.mark.parametrize(("dimension", "r", "beta", "q"), MATERIALS)
def test_averages_and_rates_over_sampled_collisions(dimension, r, beta, q):
    """Means over 4e5 Maxwellian pairs, weighted as they collide, within 5 standard errors.

    A collision counts for both its particles: dT_tr/dn = <change of the pair's energy>/D.
    """
    state = maxwellian_pairs(dimension, q, seed=20 + dimension)
    weights = collision_weights(state)
    expected = [
        theory.mean_normal_squared(1 / 2),
        theory.mean_tangential_squared(1 / 2, dimension),
        0,
        theory.mean_spin_squared(THETA / 2, dimension, q),
    ]
    for samples, value in zip(invariants(state), expected, strict=True):
        assert sigmas(samples, weights, value) < SIGMAS
    rate_tr, rate_rot = theory.temperature_changes(1, THETA, r, beta, dimension, q)
    change_tr, change_rot = energy_changes(state, r, beta, q)
    assert sigmas(change_tr, weights, dimension * rate_tr) < SIGMAS
    assert sigmas(change_rot, weights, (2 * dimension - 3) * rate_rot) < SIGMAS


@pytest.mark.parametrize("dimension", [2, 3])
def test_collision_frequency_is_the_sampled_flux(dimension):
    """nu = n chi (2a)^(D-1) times the integral of <max(-v.n, 0)> over all directions n."""
    weights = collision_weights(maxwellian_pairs(dimension, 0.5, seed=3))
    surface = {2: 2 * np.pi * 2, 3: 4 * np.pi * 4}[dimension]
    crowding = theory.number_density(0.2, dimension) * theory.contact_value(0.2, dimension)
    flux = surface * crowding * weights
    nu = theory.collision_frequency(1, 0.2, dimension)
    assert sigmas(flux, np.ones(PAIRS), nu) < SIGMAS
