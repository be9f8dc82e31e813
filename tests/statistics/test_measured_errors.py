import math

import numpy as np
import pytest

from roughgas.statistics.errors import (
    autocorrelation_time,
    blocking_stderr,
    gaussian_sigmas,
    is_trusted,
    period_means,
    stderr_over_seeds,
    student_t,
)
from roughgas.statistics.steady_state import find_plateau, is_equilibrated

# Samples and integrated autocorrelation time of AR(1) series, at least 20 such times long.
CASES = [(100, 1), (100, 5), (500, 0.5), (500, 5), (500, 25), (2000, 1), (2000, 39), (2000, 100)]


def by_autocorrelation(series):
    """Standard error of the mean, the variance and `autocorrelation_time` being known."""
    return math.sqrt(series.var(ddof=1) * autocorrelation_time(series) / len(series))


@pytest.mark.parametrize("samples, tau", CASES)
def test_blocking_is_calibrated(ar1, samples, tau):
    """The root mean square over 200 series: up to the stated 7 % too large, and never too small, by
    2.5 sigma of its own scatter."""
    series = ar1.series(np.random.default_rng(11), tau, samples, 200)
    estimates = np.array([blocking_stderr(one) for one in series]) / ar1.stderr(tau, samples)
    rms, scatter = np.sqrt(np.mean(estimates**2)), estimates.std() / np.sqrt(200)
    assert -2.5 * scatter < rms - 1 < 0.07 + 2.5 * scatter
    assert estimates.std() < 0.36


@pytest.mark.parametrize("samples, tau", [case for case in CASES if case[1] >= 1])
def test_autocorrelation_is_calibrated(ar1, samples, tau):
    """As above; Sokal's window makes it 5 to 10 % wrong at n = 20 tau."""
    series = ar1.series(np.random.default_rng(12), tau, samples, 200)
    estimates = np.array([by_autocorrelation(one) for one in series]) / ar1.stderr(tau, samples)
    rms, scatter = np.sqrt(np.mean(estimates**2)), estimates.std() / np.sqrt(200)
    assert abs(rms - 1) < 0.10 + 3 * scatter


def test_autocorrelation_time_of_replicas_is_sharper_than_of_one(ar1):
    """Of 20 series of 400 samples with tau = 8: 4 % scatter, tested at 4 sigma."""
    series = ar1.series(np.random.default_rng(14), 8, 400, 20)
    assert autocorrelation_time(series) == pytest.approx(8, rel=0.16)


def test_anticorrelation_is_given_no_credit(ar1):
    series = ar1.series(np.random.default_rng(15), 0.2, 1000, 1)[0]
    assert autocorrelation_time(series) == 1.0


def test_raw_samples_of_a_periodic_drive_mislead_and_period_means_do_not(ar1):
    """Four phases a period over noise of tau = 80 samples, which raw samples hide."""
    slow = 0.01 * ar1.series(np.random.default_rng(16), 80, 16000, 20)
    raw = slow + np.tile([0.18, 0.24, 0.26, 0.21], 4000)
    truth = 0.01 * ar1.stderr(80, 16000)
    naive = np.array([by_autocorrelation(one) for one in raw])
    assert naive.max() < 0.6 * truth
    for estimate in (blocking_stderr, by_autocorrelation):
        estimates = np.array([estimate(period_means(one, 4)) for one in raw])
        # One scatters by 15 %, the root mean square of 20 by 4 %: 4 sigma.
        assert np.sqrt(np.mean(estimates**2)) == pytest.approx(truth, rel=0.16)


def test_a_constant_series_has_no_error_and_no_memory(recwarn):
    constant = np.full(100, 0.1)
    assert blocking_stderr(constant) == 0
    assert autocorrelation_time(constant) == 1.0
    assert is_trusted(100, 1.0)
    assert not recwarn.list


@pytest.mark.parametrize("wrong", [math.nan, math.inf])
def test_a_series_with_a_number_that_is_none_is_never_trusted_nor_steady(wrong):
    series = np.random.default_rng(1).standard_normal(200) + 10.0
    series[150] = wrong
    assert math.isnan(autocorrelation_time(series))
    assert not is_trusted(len(series), autocorrelation_time(series))
    with np.errstate(invalid="ignore"):
        assert not is_equilibrated(series)
        assert not find_plateau(np.arange(200.0), np.tile(series, (12, 1))).found


@pytest.mark.parametrize("estimate", [blocking_stderr, stderr_over_seeds])
def test_one_value_has_no_error(estimate):
    assert math.isnan(estimate(np.array([0.3])))


def test_stderr_over_seeds():
    assert stderr_over_seeds([1.0, 2.0, 3.0, 4.0]) == pytest.approx(math.sqrt(5 / 3) / 2)


@pytest.mark.parametrize(
    "dof, t, sigmas",
    # Student's t whose two-sided probability is that of 1, 2, 3 and 4 sigma of a Gaussian.
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
def test_gaussian_sigmas(dof, t, sigmas):
    assert gaussian_sigmas(t, dof) == pytest.approx(sigmas, abs=0.06)
    assert gaussian_sigmas(-t, dof) == -gaussian_sigmas(t, dof)
    assert student_t(float(gaussian_sigmas(t, dof)), dof) == pytest.approx(t)


def test_autocorrelation_time_is_the_windowed_sum_with_the_correction_for_a_short_series(ar1):
    series = ar1.series(np.random.default_rng(17), 5, 1000, 1)[0]
    apart = series - series.mean()
    time, lag = 1.0, 0
    while lag < 3 * time:  # one lag after the other, by its definition
        lag += 1
        time += 2 * (apart[lag:] @ apart[:-lag]) / (apart @ apart)
    assert autocorrelation_time(series) == pytest.approx(time * (1 + 6 * time / 1000))
