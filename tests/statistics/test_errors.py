"""Standard errors of a series, over seeds, and of combinations of these; intervals."""

import math
import os
import subprocess
import sys

import mpmath
import numpy as np
import pytest

from roughgas.statistics.errors import (
    autocorrelation_time,
    block_means,
    blocking,
    blocking_stderr,
    degrees_of_freedom,
    excess_sigmas,
    half_width,
    period_means,
    pooled_error,
    stderr_over_seeds,
    sum_error,
)
from roughgas.statistics.estimates import Estimate
from roughgas.statistics.sample_sizes import SampleSize
from roughgas.statistics.steady_state import find_plateau, is_equilibrated

# Samples and integrated autocorrelation time of AR(1) series, at least 20 such times long.
CASES = [(100, 1), (100, 5), (500, 0.5), (500, 5), (500, 25), (2000, 1), (2000, 39), (2000, 100)]


def by_autocorrelation(series):
    """Return the standard error of the mean by the variance and `autocorrelation_time`."""
    return math.sqrt(series.var(ddof=1) * autocorrelation_time(series) / len(series))


@pytest.mark.parametrize("samples, tau", CASES)
def test_blocking_is_calibrated(ar1, samples, tau):
    """The root mean square over 200 series: up to the stated 7 % too large, and never too small, to
    2.5 sigma of the scatter."""
    series = ar1.series(np.random.default_rng(11), tau, samples, 200)
    estimates = np.array([blocking_stderr(run) for run in series]) / ar1.stderr(tau, samples)
    rms, scatter = np.sqrt(np.mean(estimates**2)), estimates.std() / np.sqrt(200)
    assert -2.5 * scatter < rms - 1 < 0.07 + 2.5 * scatter
    assert estimates.std() < 0.36


@pytest.mark.parametrize("samples, tau", [case for case in CASES if case[1] >= 1])
def test_autocorrelation_is_calibrated(ar1, samples, tau):
    """As above; Sokal's window makes it 5 to 10 % wrong at n = 20 tau."""
    series = ar1.series(np.random.default_rng(12), tau, samples, 200)
    estimates = np.array([by_autocorrelation(run) for run in series]) / ar1.stderr(tau, samples)
    rms, scatter = np.sqrt(np.mean(estimates**2)), estimates.std() / np.sqrt(200)
    assert abs(rms - 1) < 0.10 + 3 * scatter


def test_raw_samples_of_a_periodic_drive_mislead_and_period_means_do_not(ar1):
    """Four phases a period over noise of tau = 80 samples, which raw samples hide."""
    slow = 0.01 * ar1.series(np.random.default_rng(16), 80, 16000, 20)
    raw = slow + np.tile([0.18, 0.24, 0.26, 0.21], 4000)
    truth = 0.01 * ar1.stderr(80, 16000)
    naive = np.array([by_autocorrelation(run) for run in raw])
    assert naive.max() < 0.6 * truth
    for estimate in (blocking_stderr, by_autocorrelation):
        estimates = np.array([estimate(period_means(run, 4)) for run in raw])
        # An estimate scatters by 15 %, the root mean square of 20 by 4 %: 4 sigma.
        assert np.sqrt(np.mean(estimates**2)) == pytest.approx(truth, rel=0.16)


def test_a_constant_series_has_no_error_and_no_memory(recwarn):
    constant = np.full(100, 0.1)
    assert blocking_stderr(constant) == 0
    assert autocorrelation_time(constant) == 1.0
    assert SampleSize(times=100 / 1.0).suffices()
    assert not recwarn.list


@pytest.mark.parametrize("non_number", [math.nan, math.inf])
def test_a_series_with_nan_or_infinity_is_never_trusted_nor_steady(non_number):
    series = np.random.default_rng(1).standard_normal(200) + 10.0
    series[150] = non_number
    assert math.isnan(autocorrelation_time(series))
    assert not SampleSize(times=len(series) / autocorrelation_time(series)).suffices()
    with np.errstate(invalid="ignore"):
        assert not is_equilibrated(series)
        assert not find_plateau(np.arange(200.0), np.tile(series, (12, 1))).exists


def test_the_error_over_seeds_is_that_of_their_mean():
    assert stderr_over_seeds([1.0, 2.0, 3.0, 4.0]) == pytest.approx(math.sqrt(5 / 3) / 2)


def test_autocorrelation_time_is_the_windowed_sum_with_the_correction_for_a_short_series(ar1):
    series = ar1.series(np.random.default_rng(17), 5, 1000, 1)[0]
    deviations = series - series.mean()
    time, lag = 1.0, 0
    while lag < 3 * time:  # one lag after the other, by its definition
        lag += 1
        time += 2 * (deviations[lag:] @ deviations[:-lag]) / (deviations @ deviations)
    assert autocorrelation_time(series) == pytest.approx(time * (1 + 6 * time / 1000))


@pytest.mark.parametrize(
    ("value", "stderr", "how", "text"),
    [
        (0.35649, 0.00301, "", "0.3565(30)"),
        (0.35649, 0.000999, "", "0.3565(10)"),
        (0.35649, 0.0996, "", "0.36(10)"),
        (-0.002, 0.0131, "", "-0.002(13)"),
        (17.03, 1.24, "", "17.0(1.2)"),
        (1234.5, 87.0, "", "1234(87)"),
        (1234.5, 1870.0, "", "1200(1900)"),
        (3.3489e-11, 3.2e-12, "", "3.35(32)e-11"),
        (2.5e7, 1.25e5, "", "2.500(12)e+07"),
        (0.0, 0.01, "", "0.000(10)"),
        (0.123456789, math.nan, "", "0.123457"),
        (0.5, 0.0, "", "0.5"),
        (math.nan, 0.1, "", "nan"),
        (0.35649, 0.00301, "±", "0.3565 ± 0.0030"),
        (0.35649, 0.00301, "+±", "+0.3565 ± 0.0030"),
        (68.2, 0.0996, "±", "68.20 ± 0.10"),
        (1234.5, 87.0, "±", "1234 ± 87"),
        (0.5, 0.0, "±", "0.50 ± 0.00"),
        (-0.002, 0.0131, "+.4f", "-0.0020 ± 0.0131"),
        (0.5, math.nan, "+.4f", "+0.5000 (error unknown)"),
    ],
)
def test_a_value_and_its_error_are_formatted_together(value, stderr, how, text):
    """The compact form has the error in units of the last digits, the long one a format of both."""
    assert f"{Estimate(value, stderr):{how}}" == text


def test_difference_adds_errors_in_quadrature():
    """Its degrees of freedom are by Welch and Satterthwaite: 5^4 / (3^4/9 + 4^4/5)."""
    difference = Estimate(0.5, 3.0, 9).minus(Estimate(0.2, 4.0, 5))
    assert difference == (pytest.approx(0.3), 5.0, pytest.approx(5**4 / (3**4 / 9 + 4**4 / 5)))


def test_means_of_whole_periods_leave_out_the_incomplete_one():
    np.testing.assert_allclose(period_means(np.arange(11.0), 4), [1.5, 5.5])


def test_means_over_blocks_keep_the_shorter_last_one():
    np.testing.assert_array_equal(block_means(np.arange(5.0), 2), [0.5, 2.5, 4.0])


@pytest.mark.parametrize("samples_per_period", [0, -1, 6])
def test_no_whole_period_is_an_error(samples_per_period):
    with pytest.raises(ValueError, match="no whole period"):
        period_means(np.zeros(5), samples_per_period)


def exact_t(level, dof):
    """Return the quantile of Student's t by mpmath's incomplete beta function."""
    inside = lambda t: mpmath.betainc(0.5, dof / 2, 0, t**2 / (dof + t**2), regularized=True)  # noqa: E731
    return float(mpmath.findroot(lambda t: inside(t) - level, (0.5, 4), solver="anderson"))


@pytest.mark.parametrize("level", [0.68, 0.95])
@pytest.mark.parametrize(("dof", "accuracy"), [(3, 0.013), (8, 0.003), (40, 0.002)])
def test_half_width_is_students_t(level, dof, accuracy):
    assert half_width(2.0, dof, level) == pytest.approx(2.0 * exact_t(level, dof), rel=accuracy)


def test_an_unknown_error_has_no_interval():
    assert math.isnan(half_width(0.1, 0, 0.95))
    assert math.isnan(half_width(0.1, math.nan, 0.95))


def simulated_runs(runs, within_dof, excess, trials, seed=1):
    """Return means of runs of unit variance, their stated errors, and the degrees of freedom.

    The stated errors are `excess` times too small.
    """
    rng = np.random.default_rng(seed)
    means = rng.standard_normal((trials, runs))
    stderrs = np.sqrt(rng.chisquare(within_dof, (trials, runs)) / within_dof) / excess
    return means, stderrs, np.full(runs, within_dof)


@pytest.mark.parametrize(("runs", "within_dof"), [(1, 12), (2, 12), (4, 12), (16, 6)])
@pytest.mark.parametrize("level", [0.68, 0.95])
def test_pooled_intervals_hold_the_truth_as_often_as_they_say(runs, within_dof, level):
    """Exact up to the approximation of the t quantile; 4 sigma of 4000 trials."""
    trials = 4000
    means, stderrs, dof = simulated_runs(runs, within_dof, 1.0, trials)
    holds = [
        abs(m.mean()) <= pooled_error(m, w, dof).half_width(level)
        for m, w in zip(means, stderrs, strict=True)
    ]
    error = math.sqrt(level * (1 - level) / trials)
    assert abs(np.mean(holds) - level) < 4 * error + 0.005


def test_runs_that_miss_slow_motion_are_overruled_by_their_scatter():
    """Stated errors three times too small: the intervals of eight runs still hold the truth."""
    means, stderrs, dof = simulated_runs(8, 12, 3.0, 2000)
    holds = [
        abs(m.mean()) <= pooled_error(m, w, dof).half_width(0.95)
        for m, w in zip(means, stderrs, strict=True)
    ]
    assert np.mean(holds) > 0.93


def test_runs_without_a_stated_error_are_judged_by_their_scatter():
    error = pooled_error(np.array([1.0, 3.0]), np.array([math.nan, math.nan]), np.zeros(2))
    assert error == (1.0, 1.0)
    assert math.isnan(pooled_error(np.array([1.0]), np.array([math.nan]), np.zeros(1)).stderr)


def test_excess_sigmas_are_gaussian_without_an_excess():
    rng = np.random.default_rng(3)
    quotient = (rng.chisquare(5, 20000) / 5) / (rng.chisquare(30, 20000) / 30)
    sigmas = np.array([excess_sigmas(ratio, 5, 1.0, 30) for ratio in quotient])
    assert abs(sigmas.mean()) < 0.05
    assert sigmas.std() == pytest.approx(1.0, abs=0.05)


@pytest.mark.parametrize("samples, tau", [(100, 1.5), (500, 50), (800, 40), (800, 20), (2000, 1.8)])
@pytest.mark.parametrize("level", [0.68, 0.95])
def test_intervals_of_a_single_series_hold_the_truth(ar1, samples, tau, level):
    """From ten autocorrelation times on. Of 800 series, at 4 sigma, and 2 % that are granted."""
    series = ar1.series(np.random.default_rng(41), tau, samples, 800)
    errors = [blocking(run) for run in series]
    widths = [half_width(error.stderr, degrees_of_freedom(error.blocks), level) for error in errors]
    holds = np.abs(series.mean(axis=1)) <= widths
    assert abs(holds.mean() - level) < 4 * math.sqrt(level * (1 - level) / 800) + 0.02


def test_errors_of_a_sum_add_in_quadrature():
    """Equal errors add up with their degrees of freedom; a dominant error counts alone."""
    error = sum_error([[1.0, 3.0, 0.0, 1.0], [1.0, 1e-9, 0.0, 1.0]], [[5, 3, 9, 0], [5, 7, 9, 8]])
    np.testing.assert_allclose(error.stderr, [math.sqrt(2), 3.0, 0.0, math.sqrt(2)])
    np.testing.assert_allclose(error.dof, [10, 3, np.inf, 0])
    assert sum_error([1.0, 2.0], [math.inf, math.inf]).dof == math.inf


ERRORS = """
import numpy as np
from roughgas.statistics.errors import blocking
series = np.random.default_rng(1).standard_normal((40, 439))
print(*[blocking(one[: 400 + n])[0].hex() for n, one in enumerate(series)])
"""


def test_an_error_has_the_same_bits_whatever_kernels_blas_has_for_the_processor():
    """A product of BLAS rounds by its kernel: with a product the bits would differ."""
    outputs = set()
    for kernels in ("Nehalem", "Haswell"):
        environment = os.environ | {"OPENBLAS_CORETYPE": kernels}
        command = [sys.executable, "-c", ERRORS]
        outputs.add(
            subprocess.run(command, env=environment, capture_output=True, check=True).stdout
        )
    assert len(outputs) == 1 and len(outputs.pop().split()) == 40
