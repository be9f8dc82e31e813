"""The closed forms against each other, against the equations at high precision, and in limits."""

import itertools
import math

import mpmath
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from roughgas import theory

DIGITS = 110  # the textbook root loses up to 50 of them
BETAS = [-1 + 1e-12, -1 + 1e-9, -1 + 1e-6, -0.9999, -0.99, -0.95, -0.8, -0.5, 0, 0.5, 0.9]
BETAS += [1 - 1e-6, 1 - 1e-12, 1]
RS = [0, 0.1, 0.4, 0.8, 0.9, 0.99, 1 - 1e-6, 1 - 1e-9, 1 - 1e-12, 1]
unit = st.floats(0, 1)
roughness = st.floats(-1, 1)
inertia = st.floats(0.01, 1)


def exact_K(r, beta, dimension, q):
    """K by the textbook root of the theory of free cooling, in mpmath."""
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
def test_cooling_ratio_at_high_precision(dimension):
    q = theory.moment_of_inertia(dimension)
    for r, beta in itertools.product(RS, BETAS):
        exact = exact_K(r, beta, dimension, q)
        K = theory.cooling_K(r, beta, dimension)
        R = theory.cooling_ratio(r, beta, dimension)
        with mpmath.workdps(DIGITS):
            ratio = 1 / (1 + exact)
        assert relative_error(K, exact) < 1e-14, (r, beta)
        assert relative_error(R, ratio) < 1e-14, (r, beta)


def test_lun_ratio_at_high_precision():
    for beta, q in itertools.product(BETAS, [0.5, 0.4, 1.0, 1e-3]):
        with mpmath.workdps(50):
            exact_beta, exact_q = mpmath.mpf(float(beta)), mpmath.mpf(q)
            gain = exact_q * (1 + exact_beta)
            exact = gain / (gain + (1 + 2 * exact_q - exact_beta))
        assert relative_error(theory.lun_ratio(beta, q), exact) < 1e-15, (beta, q)


@settings(derandomize=True, deadline=None)
@given(r=unit, beta=roughness, q=inertia)
def test_equation_K_in_three_dimensions_is_goldshtein(r, beta, q):
    ours, theirs = theory.cooling_ratio(r, beta, 3, q), theory.goldshtein_ratio(r, beta, q)
    assert ours == pytest.approx(theirs, rel=1e-13, abs=1e-300)


@settings(derandomize=True, deadline=None)
@given(r=unit, beta=roughness, q=inertia, dimension=st.sampled_from([2, 3]))
def test_ratio_is_a_share_and_K_its_odds(r, beta, q, dimension):
    R, K = theory.cooling_ratio(r, beta, dimension, q), theory.cooling_K(r, beta, dimension, q)
    assert 0 <= R <= 1
    assert pytest.approx(1 / (1 + K), rel=1e-14) == R


@pytest.mark.parametrize("dimension", [2, 3])
def test_elastic_rough_particles_share_energy_equally(dimension):
    q = theory.moment_of_inertia(dimension)
    assert theory.cooling_ratio(1, 1, dimension) == pytest.approx(1 / 2, rel=1e-15)
    assert theory.lun_ratio(1, q) == pytest.approx(1 / 2, rel=1e-15)
    assert theory.goldshtein_ratio(1, 1, q) == pytest.approx(1 / 2, rel=1e-15)


@pytest.mark.parametrize("dimension", [2, 3])
@pytest.mark.parametrize("r", [0, 0.5, 0.9, 1 - 1e-6])
def test_smooth_limit_is_approached_from_above(dimension, r):
    """R - 1 = -K is b/(2 alpha (1 - r^2)) to first order, the theory of free cooling."""
    assert theory.cooling_ratio(r, -1, dimension) == 1
    assert theory.cooling_K(r, -1, dimension) == 0
    beta = -1 + 1e-13
    expected = theory.b_G(beta, theory.moment_of_inertia(dimension)) * (dimension - 1) / 4
    expected /= (1 - r) * (1 + r)
    assert theory.cooling_K(r, beta, dimension) == pytest.approx(expected, rel=1e-6)


@pytest.mark.parametrize("dimension", [2, 3])
def test_smooth_elastic_limit(dimension):
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
    """Put into Eq. (deltaEr), the ratio gives no change; uncorrelated it is Lun's formula."""
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
