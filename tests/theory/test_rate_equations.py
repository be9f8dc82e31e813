"""The rate equations, against sampled collisions, the literature and numerical solutions."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from integration import integrate
from slow_cases import slow_but
from tests.theory.collisions import maxwellian_pairs, sigmas

from roughgas import theory

gases = {
    "r": st.floats(0, 1),
    "beta": st.floats(-0.999, 1),
    "q": st.floats(0.05, 1),
    "dimension": st.sampled_from([2, 3]),
}
share = st.floats(0, 1)


@settings(derandomize=True, deadline=None)
@given(**gases)
def test_free_cooling_is_stationary_at_equation_K(r, beta, q, dimension):
    R = theory.stationary_ratio(r, beta, dimension, q)
    assert pytest.approx(theory.cooling_ratio(r, beta, dimension, q), rel=1e-10) == R
    rate_tr, rate_rot = theory.temperature_changes(1 - R, R, r, beta, dimension, q)
    assert R * rate_tr == pytest.approx((1 - R) * rate_rot, abs=1e-14)


@settings(derandomize=True, deadline=None)
@given(**gases)
def test_translational_drive_is_equation_lun(r, beta, q, dimension):
    R = theory.stationary_ratio(r, beta, dimension, q, spin_share=0)
    assert pytest.approx(theory.lun_ratio(beta, q), rel=1e-13) == R


@settings(derandomize=True, deadline=None)
@given(**gases, s=share)
def test_a_drive_balances_collisions_in_the_stationary_state(r, beta, q, dimension, s):
    """With the power that the collisions dissipate, both temperatures stand still."""
    R = theory.stationary_ratio(r, beta, dimension, q, spin_share=s)
    by_collisions = theory.temperature_changes(1 - R, R, r, beta, dimension, q)
    power = -(dimension * by_collisions[0] + (2 * dimension - 3) * by_collisions[1]) / 2
    by_drive = theory.drive_changes(max(power, 0), s, dimension)
    assert np.add(by_collisions, by_drive) == pytest.approx(0, abs=1e-14)


@pytest.mark.parametrize("dimension", [2, 3])
@pytest.mark.parametrize("s", [None, 0, 0.3, 1])
@pytest.mark.parametrize("r", [0.5, 1])
def test_smooth_limit_is_approached_from_above(dimension, s, r):
    at, near = theory.stationary_ratio(r, np.array([-1, -1 + 1e-10]), dimension, spin_share=s)
    assert at == pytest.approx(near, abs=1e-8)


@pytest.mark.parametrize("dimension", [2, 3])
def test_a_drive_may_take_energy_from_rotation(dimension):
    """Then collisions must feed rotation: their changes of the energies are as -(1 - s) : -s."""
    R = theory.stationary_ratio(0.9, 0.5, dimension, spin_share=-0.05)
    assert 0.0 < R < theory.stationary_ratio(0.9, 0.5, dimension, spin_share=0.0)
    translational, rotational = theory.temperature_changes(1 - R, R, 0.9, 0.5, dimension)
    lost = dimension * translational, (2 * dimension - 3) * rotational
    assert lost[1] / sum(lost) == pytest.approx(-0.05, rel=1e-12)
    assert theory.stationary_ratio(0.9, 0.5, 2, spin_share=-1.0) == 0.0


def test_theta_is_infinite_where_all_energy_is_spin():
    assert np.isinf(theory.stationary_theta(0.9, -1))
    assert theory.stationary_theta(0.9, -1, spin_share=0) == 0


rough_gases = {"r": st.floats(0, 1), "beta": st.floats(-0.99, 1), "q": st.floats(0.05, 1)}


def huthmann_zippelius(r, beta, q, dimension):
    """Return A, B and C of Huthmann & Zippelius (1997); Luding et al. (1998) have them for disks.

    With a constant G they write dT_tr/dt = -G A T_tr^(3/2) + G B T_tr^(1/2) T_rot, and
    dT_rot/dt = k (G B T_tr^(3/2) - G C T_tr^(1/2) T_rot), k being 2 for disks and 1 for spheres.
    """
    eta = q * (1 + beta) / (2 + 2 * q)
    tangential = 0.5 if dimension == 2 else 1.0
    A = (1 - r**2) / 4 + tangential * eta * (1 - eta)
    return A, tangential * eta**2 / q, tangential * eta / q * (1 - eta / q)


@settings(derandomize=True, deadline=None)
@given(**rough_gases, dimension=st.sampled_from([2, 3]))
def test_the_rate_equations_are_those_of_huthmann_and_zippelius(r, beta, q, dimension):
    A, B, C = huthmann_zippelius(r, beta, q, dimension)
    ours = theory.collision_rates(r, beta, dimension, q)
    scale, spins = (2, 2) if dimension == 2 else (4 / 3, 1)
    theirs = scale * np.array([A, B, spins * B, spins * C])
    assert np.array(ours) == pytest.approx(theirs, rel=1e-12, abs=1e-15)


@settings(derandomize=True, deadline=None)
@given(**rough_gases)
def test_cooling_spheres_are_those_of_santos_kremer_and_dos_santos(r, beta, q):
    """The Maxwellian limit of Santos, Kremer & dos Santos (2011): theta = h + sqrt(1 + h^2)."""
    lost = 1 - r**2 - (1 - q) / (1 + q) * (1 - beta**2)
    h = (1 + q) ** 2 / (2 * q * (1 + beta) ** 2) * lost
    theta = h + np.hypot(1, h) if h > 0 else 1 / (np.hypot(1, h) - h)
    expected = pytest.approx(theta / (1 + theta), rel=1e-9)
    assert theory.cooling_ratio(r, beta, 3, q) == expected
    assert theory.goldshtein_ratio(r, beta, q) == expected


@settings(derandomize=True, deadline=None)
@given(**rough_gases)
def test_a_gas_driven_by_rotation_is_that_of_cafiero_luding_and_herrmann(r, beta, q):
    """Translation, which nothing drives, balances in itself: theta = A/B (2002)."""
    A, B, _ = huthmann_zippelius(r, beta, q, 2)
    assert theory.stationary_ratio(r, beta, 2, q, 1) == pytest.approx(A / (A + B), rel=1e-12)


PAIRS = 100_000
SIGMAS = 5
MATERIALS = [(2, 0.9, 0.3, 0.5), (2, 0.6, -0.7, 1.0), (3, 0.8, -0.2, 0.4), (3, 1.0, 1.0, 0.4)]
THETA = 0.6


def energy_changes(state, r, beta, q):
    """Return the exact changes of the translational and rotational energy of each pair."""
    return state.after(r, beta, q).energies(q) - state.energies(q)


def invariants(state):
    """Return v_n^2, v_t^2, v_t.v_r and v_r^2 of each pair."""
    v1, v2, w1, w2, n = state
    v = v1 - v2
    v_n = (v * n).sum(-1, keepdims=True) * n
    v_t, v_r = v - v_n, -np.cross(w1 + w2, n)
    products = ((v_n, v_n), (v_t, v_t), (v_t, v_r), (v_r, v_r))
    return [(x * y).sum(-1) for x, y in products]


def pairs(dimension, q, seed, number=PAIRS):
    """Return pairs of a gas with T_tr = 1, T_rot = THETA."""
    return maxwellian_pairs(np.random.default_rng(seed), number, dimension, THETA / q)


@settings(derandomize=True, deadline=None)
@given(
    r=st.floats(0, 1),
    beta=st.floats(-1, 1),
    q=st.floats(0.01, 2),
    dimension=st.sampled_from([2, 3]),
    seed=st.integers(0, 10**6),
)
def test_energy_changes_are_those_of_the_collision_rule(r, beta, q, dimension, seed):
    state = pairs(dimension, q, seed, 20)
    exact_tr, exact_rot = energy_changes(state, r, beta, q)
    v_n2, v_t2, v_tr, v_r2 = invariants(state)
    size = v_n2 + v_t2 + v_r2 + sum((v**2).sum(-1) for v in state[:2])
    size += q * sum((w**2).sum(-1) for w in state[2:4])
    ours = theory.translational_energy_change(v_n2, v_t2, v_tr, v_r2, r, beta, q)
    assert (np.abs(ours - exact_tr) < 1e-12 * size).all()
    ours = theory.rotational_energy_change(v_t2, v_tr, v_r2, beta, q)
    assert (np.abs(ours - exact_rot) < 1e-12 * size).all()


@pytest.mark.parametrize(("dimension", "r", "beta", "q"), MATERIALS)
def test_averages_and_rates_are_those_of_sampled_collisions(dimension, r, beta, q):
    """Means over 1e5 Maxwellian pairs, weighted as they collide, within 5 standard errors.

    A collision counts for both its particles: dT_tr/dn = <change of the pair's energy>/D.
    """
    state = pairs(dimension, q, 20 + dimension)
    weights = state.approach()
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
    weights = pairs(dimension, 0.5, 3).approach()
    surface = {2: 2 * np.pi * 2, 3: 4 * np.pi * 4}[dimension]
    crowding = theory.number_density(0.2, dimension) * theory.contact_value(0.2, dimension)
    flux = surface * crowding * weights
    nu = theory.collision_frequency(1, 0.2, dimension)
    assert sigmas(flux, np.ones(PAIRS), nu) < SIGMAS


DRIVES = [None, 0, 0.4, 1]
R_AND_BETA = [(0.9, -0.8), (0.9, 0.5), (0.6, 0), (0.99, 1.0), (1.0, -0.5)]


def temperatures(theta0, r, beta, collisions, dimension, s):
    """Return T_tr and T_rot at `collisions`, the drive giving back what collisions dissipate."""

    def slope(now):
        T_tr, T_rot = np.maximum(now, 0)
        change = np.array(theory.temperature_changes(T_tr, T_rot, r, beta, dimension))
        if s is None:
            return change
        power = -(dimension * change[0] + (2 * dimension - 3) * change[1]) / 2
        return change + theory.drive_changes(np.maximum(power, 0), s, dimension)

    return integrate(slope, (np.ones_like(theta0), theta0), collisions)


@pytest.mark.parametrize("dimension", [2, 3])
@pytest.mark.parametrize("s", slow_but(DRIVES[1:2], DRIVES))
def test_relax_solves_the_rate_equations(dimension, s):
    collisions = np.array([0, 0.5, 2, 8, 20])
    theta0, (r, beta) = np.array([0, 0.3, 5, 0, 1]), np.transpose(R_AND_BETA)
    T_tr, T_rot = temperatures(theta0, r, beta, collisions, dimension, s)
    columns = (column[:, None] for column in (theta0, r, beta))
    gas = theory.relax(*columns, collisions, dimension, spin_share=s)
    assert gas.T_tr == pytest.approx(T_tr, rel=1e-8)
    assert gas.T_rot == pytest.approx(T_rot, rel=1e-8, abs=1e-14)
    assert gas.theta == pytest.approx(T_rot / T_tr, rel=1e-8, abs=1e-14)


@pytest.mark.parametrize("dimension", [2, 3])
@pytest.mark.parametrize("s", DRIVES)
@pytest.mark.parametrize(("r", "beta"), R_AND_BETA)
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
@pytest.mark.parametrize(("r", "beta"), R_AND_BETA)
def test_collisions_to_relax_ends_at_the_tolerance(s, theta0, r, beta):
    R = theory.stationary_ratio(r, beta, spin_share=s)
    collisions = theory.collisions_to_relax(r, beta, 0.02, spin_share=s, theta0=theta0)
    assert collisions > 0
    theta = theory.relax(theta0, r, beta, collisions, spin_share=s).theta
    assert abs(theta / (1 + theta) / R - 1) == pytest.approx(0.02, rel=1e-9)


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


@pytest.mark.parametrize("dimension", [2, 3])
@pytest.mark.parametrize("s", [0.0, 0.4, 1.0])
def test_a_drive_of_constant_power_leads_to_the_stationary_state(dimension, s):
    """Losses then balance the drive, and theta equals `stationary_theta`."""
    r, beta, packing, power = 0.8, 0.2, 0.05, 0.01
    T_tr, T_rot = theory.driven_temperatures(
        [0.0, 5000.0], 2.0, 0.3, r, beta, packing, power, s, dimension
    )
    assert (T_tr[0], T_rot[0]) == (2.0, 0.3)
    assert T_rot[1] / T_tr[1] == pytest.approx(theory.stationary_theta(r, beta, dimension, None, s))
    nu = theory.collision_frequency(T_tr[1], packing, dimension)
    lost = theory.temperature_changes(T_tr[1], T_rot[1], r, beta, dimension, None, nu)
    gained = theory.drive_changes(power, s, dimension)
    assert np.add(lost, gained) == pytest.approx([0.0, 0.0], abs=1e-9)


def test_a_gas_without_a_drive_cools_as_the_exact_solution():
    """At the times of n collisions per particle: the integral of 1/nu over n."""
    n = np.linspace(0.0, 20.0, 20001)
    gas = theory.relax(3.0, 0.8, 0.2, n)
    slow = 1.0 / theory.collision_frequency(gas.T_tr, 0.05)
    time = np.concatenate([[0.0], np.cumsum(0.5 * (slow[1:] + slow[:-1]) * np.diff(n))])
    sparse = slice(None, None, 4000)
    T_tr, T_rot = theory.driven_temperatures(time[sparse], 1.0, 3.0, 0.8, 0.2, 0.05)
    assert T_tr == pytest.approx(gas.T_tr[sparse], rel=1e-5)
    assert T_rot == pytest.approx(gas.T_rot[sparse], rel=1e-5)
