"""Student's t, and errors pooled from the scatter of runs and from within them."""

import math

import mpmath
import numpy as np
import pytest

from roughgas.statistics.errors import (
    blocking,
    degrees_of_freedom,
    excess_sigmas,
    half_width,
    pooled,
    sum_error,
)


def exact_t(level, dof):
    """Quantile of Student's t by mpmath's incomplete beta function."""
    inside = lambda t: mpmath.betainc(0.5, dof / 2, 0, t**2 / (dof + t**2), regularized=True)  # noqa: E731
    return float(mpmath.findroot(lambda t: inside(t) - level, (0.5, 4), solver="anderson"))


@pytest.mark.parametrize("level", [0.68, 0.95])
@pytest.mark.parametrize(("dof", "accuracy"), [(3, 0.013), (8, 0.003), (40, 0.002)])
def test_half_width_is_students_t(level, dof, accuracy):
    assert half_width(2.0, dof, level) == pytest.approx(2.0 * exact_t(level, dof), rel=accuracy)


def test_an_error_of_which_nothing_is_known_has_no_interval():
    assert math.isnan(half_width(0.1, 0, 0.95))
    assert math.isnan(half_width(0.1, math.nan, 0.95))


def simulated(runs, within_dof, excess, trials, seed=1):
    """Runs of unit variance, their own errors known with so many degrees of freedom, and `excess`
    times too small."""
    rng = np.random.default_rng(seed)
    means = rng.standard_normal((trials, runs))
    own = np.sqrt(rng.chisquare(within_dof, (trials, runs)) / within_dof) / excess
    return means, own, np.full(runs, within_dof)


@pytest.mark.parametrize(("runs", "within_dof"), [(1, 12), (2, 12), (4, 12), (16, 6)])
@pytest.mark.parametrize("level", [0.68, 0.95])
def test_pooled_intervals_hold_the_truth_as_often_as_they_say(runs, within_dof, level):
    """Exact but for the t quantile's approximation; 4 sigma of 4000 trials."""
    trials = 4000
    means, own, dof = simulated(runs, within_dof, 1.0, trials)
    holds = [
        abs(m.mean()) <= pooled(m, w, dof).half_width(level)
        for m, w in zip(means, own, strict=True)
    ]
    error = math.sqrt(level * (1 - level) / trials)
    assert abs(np.mean(holds) - level) < 4 * error + 0.005


def test_runs_that_miss_slow_motion_are_overruled_by_their_scatter():
    """Own errors three times too small: the intervals of eight runs still hold the truth."""
    means, own, dof = simulated(8, 12, 3.0, 2000)
    holds = [
        abs(m.mean()) <= pooled(m, w, dof).half_width(0.95) for m, w in zip(means, own, strict=True)
    ]
    assert np.mean(holds) > 0.93


def test_runs_without_an_own_error_are_judged_by_their_scatter():
    error = pooled(np.array([1.0, 3.0]), np.array([math.nan, math.nan]), np.zeros(2))
    assert error == (1.0, 1.0)
    assert math.isnan(pooled(np.array([1.0]), np.array([math.nan]), np.zeros(1)).stderr)


def test_excess_of_a_variance_is_gaussian_where_there_is_none():
    rng = np.random.default_rng(3)
    quotient = (rng.chisquare(5, 20000) / 5) / (rng.chisquare(30, 20000) / 30)
    sigmas = np.array([excess_sigmas(one, 5, 1.0, 30) for one in quotient])
    assert abs(sigmas.mean()) < 0.05
    assert sigmas.std() == pytest.approx(1.0, abs=0.05)


@pytest.mark.parametrize("samples, tau", [(100, 1.5), (500, 50), (800, 40), (800, 20), (2000, 1.8)])
@pytest.mark.parametrize("level", [0.68, 0.95])
def test_intervals_of_one_series_hold_the_truth(ar1, samples, tau, level):
    """From ten autocorrelation times on. Of 800 series, at 4 sigma, and 2 % that are granted."""
    series = ar1.series(np.random.default_rng(41), tau, samples, 800)
    found = [blocking(one) for one in series]
    widths = [half_width(one.stderr, degrees_of_freedom(one.blocks), level) for one in found]
    holds = np.abs(series.mean(axis=1)) <= widths
    assert abs(holds.mean() - level) < 4 * math.sqrt(level * (1 - level) / 800) + 0.02


def test_error_of_a_sum():
    """Equal errors add up with their degrees of freedom; one that dominates counts alone."""
    error = sum_error([[1.0, 3.0, 0.0, 1.0], [1.0, 1e-9, 0.0, 1.0]], [[5, 3, 9, 0], [5, 7, 9, 8]])
    np.testing.assert_allclose(error.stderr, [math.sqrt(2), 3.0, 0.0, math.sqrt(2)])
    np.testing.assert_allclose(error.dof, [10, 3, np.inf, 0])
    assert sum_error([1.0, 2.0], [math.inf, math.inf]).dof == math.inf
