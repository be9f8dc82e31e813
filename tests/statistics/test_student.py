"""Student's t: probabilities, quantiles, and the smallest deviation that a test detects."""

import math

import mpmath
import numpy as np
import pytest

from roughgas.statistics.estimates import POWER, SIGNIFICANCE, Estimate
from roughgas.statistics.student import (
    t_density,
    t_probability,
    t_quantile,
    wallace_sigmas,
    wallace_t,
)

mpmath.mp.dps = 30
DEGREES = [0.5, 1, 1.7, 3, 8, 25.3, 150]


def exact_probability(t, dof):
    """Return the two-sided probability by mpmath: Abramowitz & Stegun, 26.7.1.

    `t` is in standard errors with `dof` degrees of freedom.
    """
    share = mpmath.mpf(dof) / (dof + mpmath.mpf(t) ** 2)
    return mpmath.betainc(mpmath.mpf(dof) / 2, 0.5, 0, share, regularized=True)


@pytest.mark.parametrize("dof", DEGREES)
def test_probabilities_are_exact(dof):
    for t in (1e-3, 1.0, 3.0, 12.0, 300.0):
        assert t_probability(t, dof) == pytest.approx(float(exact_probability(t, dof)), rel=1e-10)
    assert t_probability(0.0, dof) == 1.0 and t_probability(math.inf, dof) == 0.0


def test_many_degrees_of_freedom_are_gaussian():
    """As in the expansion of Fisher (1925), the next order is below 1e-12."""
    for t in (0.5, 3.0, 8.0):
        gaussian = math.erfc(t / math.sqrt(2))
        density = math.exp(-(t**2) / 2) / math.sqrt(2 * math.pi)
        assert t_probability(t, math.inf) == pytest.approx(gaussian, rel=1e-12)
        first_order = density * (t**3 + t) / 2
        assert t_probability(t, 1e5) - gaussian == pytest.approx(first_order / 1e5, rel=1e-2)


def test_shapes_broadcast_and_unknown_errors_have_no_probability():
    t = np.array([[-1.0], [1.0], [math.nan]])
    probabilities = t_probability(t, np.array([1.0, 3.0, 0.0, math.nan]))
    assert probabilities.shape == (3, 4)
    np.testing.assert_array_equal(probabilities[0], probabilities[1])
    np.testing.assert_array_equal(np.isnan(probabilities[0]), [False, False, True, True])
    assert np.isnan(probabilities[2]).all()
    assert math.isnan(t_quantile(0.05, 0.0)) and math.isnan(t_quantile(0.05, math.nan))


@pytest.mark.parametrize("dof", [*DEGREES, 1e4, math.inf])
def test_quantiles_invert_probabilities(dof):
    for probability in (0.999, 0.2, SIGNIFICANCE, 1e-12):
        t = t_quantile(probability, dof)
        assert t_probability(t, dof) == pytest.approx(probability, rel=1e-12)


def test_quantiles_are_those_of_the_tables():
    """Table G.2 of JCGM 100:2008."""
    table = {1: (12.71, 235.78), 3: (3.18, 9.22), 20: (2.09, 3.42), 100: (1.984, 3.077)}
    for dof, quantiles in table.items():
        for confidence, quantile in zip((0.95, 0.9973), quantiles, strict=True):
            assert t_quantile(1 - confidence, dof) == pytest.approx(quantile, abs=0.006)


@pytest.mark.parametrize("probability", [0.0, 1.0, -0.1, math.nan])
def test_impossible_probabilities_are_refused(probability):
    with pytest.raises(ValueError, match="must be above 0 and below 1"):
        t_quantile(probability, 3.0)


@pytest.mark.parametrize("dof", [1.0, 4.5, math.inf])
def test_the_density_is_the_slope_of_the_probability(dof):
    step = 1e-4
    for t in (0.3, 2.0, 5.0):
        slope = (t_probability(t + step, dof) - t_probability(t - step, dof)) / (2 * step)
        assert -slope / 2 == pytest.approx(t_density(t, dof), rel=1e-6)
        assert t_density(-t, dof) == t_density(t, dof)


@pytest.mark.parametrize(
    "dof, t, sigmas",
    # Student's t with the two-sided probabilities of 1, 2, 3 and 4 sigma of a Gaussian.
    [
        (3, 1.1969, 1),
        (3, 3.3068, 2),
        (3, 9.2189, 3),
        (8, 1.0665, 1),
        (8, 2.3664, 2),
        (8, 4.2766, 3),
        (8, 7.5951, 4),
    ],
)
def test_wallaces_formula_approximates_the_probability(dof, t, sigmas):
    assert wallace_sigmas(t, dof) == pytest.approx(sigmas, abs=0.06)
    assert wallace_sigmas(-t, dof) == -wallace_sigmas(t, dof)
    assert wallace_t(float(wallace_sigmas(t, dof)), dof) == pytest.approx(t)
    assert Estimate(t, 1.0, dof).sigma == pytest.approx(sigmas, abs=1e-4)


def test_significance_has_the_probability_of_students_t():
    """Four values may be 9.21 errors from 0 by chance, and not 9.23: the table has 9.22."""
    assert Estimate(-8.0, 2.0, 3).t == -4.0
    expected = float(exact_probability(4.0, 3))
    assert Estimate(-8.0, 2.0, 3).probability == pytest.approx(expected)
    assert Estimate(-9.23, 1.0, 3).is_significant and not Estimate(9.21, 1.0, 3).is_significant
    assert Estimate(3.001, 1.0).is_significant and not Estimate(-2.999, 1.0).is_significant


def test_estimates_without_error_have_no_or_infinite_significance():
    unknown = Estimate(0.1, math.nan)
    assert all(map(math.isnan, (unknown.t, unknown.sigma, unknown.probability, unknown.detectable)))
    assert not unknown.is_significant and math.isnan(Estimate(0.1, 1.0, 0.0).probability)
    assert math.isnan(Estimate(0.1, 1.0, 0.0).detectable)
    for value, infinity in ((0.1, math.inf), (-0.1, -math.inf)):
        certain = Estimate(value, 0.0, 3.0)
        assert certain.sigma == certain.t == infinity and certain.is_significant
    assert Estimate(0.0, 0.0).sigma == 0.0 and Estimate(0.0, 0.0).probability == 1.0
    assert Estimate(0.0, 0.0).detectable == 0.0


@pytest.mark.parametrize(("dof", "power"), [(3, 0.75), (5, 0.81), (20, 0.88), (math.inf, POWER)])
def test_detectable_deviations_are_found_as_often_as_stated(dof, power):
    """Of 40 000 samples; 4 sigma, which fails by chance once in 4000 choices of seeds."""
    rng, trials = np.random.default_rng(41), 40_000
    squares = np.ones(trials) if math.isinf(dof) else rng.chisquare(dof, trials) / dof
    deviation = Estimate(0.0, 1.0, dof).detectable
    t = (deviation + rng.standard_normal(trials)) / np.sqrt(squares)
    share = np.mean(np.abs(t) > t_quantile(SIGNIFICANCE, dof))
    assert abs(share - power) < 4 * math.sqrt(power * (1 - power) / trials) + 0.005  # two digits
