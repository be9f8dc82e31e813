"""Closed forms of R, cooling and frequencies, against high precision and limits."""

import itertools
import math

import mpmath
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from integration import integrate

from roughgas import theory
from roughgas.base import InputError

DIGITS = 110  # the textbook root loses up to 50 of them
BETAS = [-1 + 1e-12, -1 + 1e-9, -1 + 1e-6, -0.9999, -0.99, -0.95, -0.8, -0.5, 0, 0.5, 0.9]
BETAS += [1 - 1e-6, 1 - 1e-12, 1]
RS = [0, 0.1, 0.4, 0.8, 0.9, 0.99, 1 - 1e-6, 1 - 1e-9, 1 - 1e-12, 1]
unit = st.floats(0, 1)
roughness = st.floats(-1, 1)
inertia = st.floats(0.01, 1)


def exact_K(r, beta, dimension, q):
    """Return K by the textbook root of the theory of free cooling, in mpmath."""
    with mpmath.workdps(DIGITS):
        r, beta, q = (mpmath.mpf(float(x)) for x in (r, beta, q))
        alpha = mpmath.mpf(2) / (dimension - 1)
        a = (1 - beta**2) * (1 - q) / (1 + q) - 1 + r**2
        b = 2 * q * (1 + beta) ** 2 / (1 + q) ** 2
        c = (1 + beta) * (2 * q + q**2 - beta * q**2) / (1 + q) ** 2
        linear = alpha * a + (alpha - 1) * c
        return (linear + mpmath.sqrt(linear**2 + alpha * b**2)) / (alpha * b)


def relative_error(value, exact):
    with mpmath.workdps(50):
        return float(abs(mpmath.mpf(float(value)) / exact - 1))


@pytest.mark.parametrize("dimension", [2, 3])
def test_the_cooling_ratio_agrees_with_high_precision(dimension):
    q = theory.moment_of_inertia(dimension)
    for r, beta in itertools.product(RS, BETAS):
        exact = exact_K(r, beta, dimension, q)
        K = theory.cooling_K(r, beta, dimension)
        R = theory.cooling_ratio(r, beta, dimension)
        with mpmath.workdps(DIGITS):
            ratio = 1 / (1 + exact)
        assert relative_error(K, exact) < 1e-14, (r, beta)
        assert relative_error(R, ratio) < 1e-14, (r, beta)


def test_the_lun_ratio_agrees_with_high_precision():
    for beta, q in itertools.product(BETAS, [0.5, 0.4, 1.0, 1e-3]):
        with mpmath.workdps(50):
            exact_beta, exact_q = mpmath.mpf(float(beta)), mpmath.mpf(q)
            gain = exact_q * (1 + exact_beta)
            exact = gain / (gain + (1 + 2 * exact_q - exact_beta))
        assert relative_error(theory.lun_ratio(beta, q), exact) < 1e-15, (beta, q)


@pytest.mark.parametrize("dimension", [2, 3])
def test_smooth_elastic_limits_are_exact(dimension):
    assert theory.cooling_ratio(1, -1, dimension) == 0
    assert np.isinf(theory.cooling_K(1, -1, dimension))
    assert 0 < theory.cooling_ratio(1, -1 + 1e-12, dimension) < 1e-12
    assert theory.goldshtein_ratio(1, -1) == 0
    assert theory.goldshtein_ratio(0.9, -1) == 1
    assert theory.lun_ratio(-1, 0.5) == 0


def test_arguments_broadcast_and_plain_numbers_stay_plain():
    r, beta = np.array([0.8, 0.9, 1.0])[:, None], np.linspace(-1, 1, 5)
    table = theory.cooling_ratio(r, beta)
    assert table.shape == (3, 5)
    assert table[1, 2] == theory.cooling_ratio(0.9, 0.0)
    assert theory.goldshtein_ratio(r, beta).shape == theory.cooling_K(r, beta, 3).shape == (3, 5)
    assert theory.lun_ratio(beta, np.array([[0.4], [0.5]])).shape == (2, 5)
    for value in (theory.cooling_ratio(0.9, 0), theory.goldshtein_ratio(1, 0)):
        assert isinstance(value, np.float64)


@settings(derandomize=True, deadline=None)
@given(beta=roughness, q=inertia, c=st.floats(-1.0, 1.0))
def test_a_correlation_at_contacts_leaves_rotation_as_it_is(beta, q, c):
    """By Eq. (deltaEr) the ratio does not change; without correlation it is Lun's formula."""
    R = theory.correlated_ratio(beta, q, c)
    assert 0.0 <= R <= 1.0
    assert theory.correlated_ratio(beta, q, 0.0) == pytest.approx(
        theory.lun_ratio(beta, q), rel=1e-13
    )
    square = R / (1.0 - R) / q if R < 1.0 else math.inf  # <v_r^2>/<v_t^2>
    if 1e-200 < square < 1e200:
        change = theory.rotational_energy_change(1.0, c * math.sqrt(square), square, beta, q)
        size = theory.rotational_energy_change(1.0, 0.0, 0.0, beta, q)
        assert abs(change) <= 1e-9 * (size + abs(c) * math.sqrt(square) + square)


def test_dilute_gases_have_the_textbook_frequencies():
    """nu = 2 n sigma sqrt(pi T) and 4 n sigma^2 sqrt(pi T), with the diameter sigma = 2."""
    phi = 1e-9
    n2, n3 = theory.number_density(phi, 2), theory.number_density(phi, 3)
    nu2, nu3 = theory.collision_frequency(4.0, phi, 2), theory.collision_frequency(4.0, phi, 3)
    assert nu2 == pytest.approx(2 * n2 * 2 * np.sqrt(4 * np.pi), rel=1e-8)
    assert nu3 == pytest.approx(4 * n3 * 4 * np.sqrt(4 * np.pi), rel=1e-8)
    free2, free3 = theory.mean_free_path(phi, 2), theory.mean_free_path(phi, 3)
    assert free2 == pytest.approx(1 / (2 * np.sqrt(2) * n2 * 2), rel=1e-8)
    assert free3 == pytest.approx(1 / (np.sqrt(2) * np.pi * n3 * 4), rel=1e-8)


def test_contact_values_follow_the_virial_series():
    """chi = 1 + b phi + ..., b = 25/16 for Henderson's disks (exact: 1.564) and 5/2 for spheres."""
    assert theory.contact_value(0, 2) == theory.contact_value(0, 3) == 1
    assert (theory.contact_value(1e-7, 2) - 1) / 1e-7 == pytest.approx(25 / 16, rel=1e-5)
    assert (theory.contact_value(1e-7, 3) - 1) / 1e-7 == pytest.approx(5 / 2, rel=1e-5)


def test_packing_and_number_density_of_a_box_agree():
    for box in ([10.0, 30.0], [8.0, 9.0, 10.0]):
        phi = theory.packing_fraction(12, box)
        assert theory.number_density(phi, len(box)) == pytest.approx(12 / np.prod(box))


@pytest.mark.slow
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


@pytest.mark.parametrize("dimension", [2, 3])
def test_a_smooth_gas_cools_by_haffs_law(dimension):
    """Haff (1983) for smooth particles: t_h = 2 D/[nu (1 - r^2)]."""
    expected = 2 * dimension / (0.3 * (1 - 0.8**2))
    assert theory.haff_time(0.8, -1, 0.3, dimension) == pytest.approx(expected, rel=1e-14)
    assert theory.decay_rate(0.8, -1 + 1e-9, dimension) < 1e-8


FUNCTIONS_OF = {
    "restitution r": [
        *(theory.goldshtein_ratio, theory.cooling_ratio, theory.cooling_K, theory.collision_rates),
        *(theory.stationary_ratio, theory.stationary_theta, theory.relaxation_rate),
        *(theory.collisions_to_relax, theory.decay_rate),
        lambda r, beta: theory.a_G(r, beta, 0.5),
        lambda r, beta: theory.translational_energy_change(1, 1, 0, 1, r, beta, 0.5),
        lambda r, beta: theory.temperature_changes(1, 1, r, beta),
        lambda r, beta: theory.relax(0, r, beta, 1),
        lambda r, beta: theory.haff_time(r, beta, 1),
        lambda r, beta: theory.haff_temperature(1, 1, r, beta, 1),
    ],
    "dimension": [
        theory.moment_of_inertia,
        lambda dimension: theory.cooling_ratio(0.9, 0, dimension),
        lambda dimension: theory.collision_rates(0.9, 0, dimension),
        lambda dimension: theory.relax(0, 0.9, 0, 1, dimension),
        lambda dimension: theory.collision_frequency(1, 0.1, dimension),
        lambda dimension: theory.mean_spin_squared(1, dimension, 0.5),
    ],
    "inertia q": [
        lambda q: theory.lun_ratio(0, q),
        lambda q: theory.correlated_ratio(0, q, 0),
        lambda q: theory.goldshtein_ratio(0.9, 0, q),
        lambda q: theory.cooling_ratio(0.9, 0, 2, q),
        lambda q: theory.stationary_theta(0.9, 0, 2, q),
        lambda q: theory.rotational_energy_change(1, 0, 1, 0, q),
    ],
}
FUNCTIONS_OF["roughness beta"] = [
    lambda beta, closed_form=closed_form: closed_form(0.9, np.array([0, beta, 1]))
    for closed_form in FUNCTIONS_OF["restitution r"]
]
FUNCTIONS_OF["restitution r"] = [
    lambda r, closed_form=closed_form: closed_form(r, 0)
    for closed_form in FUNCTIONS_OF["restitution r"]
]
ILLEGAL = {
    "restitution r": ([1.5, -0.1, np.nan, np.inf, "0.5", None, True, 1j], "must lie in [0, 1]"),
    "roughness beta": ([1.5, -1.1, np.nan], "must lie in [-1, 1]"),
    "dimension": ([0, 1, 4, 2.5, np.nan, "2", None], "must be 2 or 3"),
    "inertia q": ([0.0, -0.5, np.nan, np.inf], "must be a positive number"),
}


@pytest.mark.parametrize("key", ILLEGAL)
def test_arguments_outside_their_range_are_refused(key):
    values, legal = ILLEGAL[key]
    for function, value in itertools.product(FUNCTIONS_OF[key], values):
        with pytest.raises(InputError) as caught:
            function(value)
        assert str(caught.value) == f"{key} = {value}: {legal}"
