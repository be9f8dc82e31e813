import numpy as np
import pytest

from roughgas.statistics.steady_state import cut_sigmas, detect_start, drift, is_equilibrated


def noisy(ar1, seed, tau, samples, count, amplitude=0.1):
    return 1 + amplitude * ar1.series(np.random.default_rng(seed), tau, samples, count)


@pytest.mark.parametrize("samples, tau", [(60, 1), (200, 4), (500, 1), (1000, 20)])
def test_stationary_series_pass(ar1, samples, tau):
    """Stated: fails once in 1000 or less for tau up to n/50. Six of 1000: by chance 1 in 1700."""
    flagged = sum(not is_equilibrated(one) for one in noisy(ar1, 21, tau, samples, 1000))
    assert flagged <= 5


@pytest.mark.parametrize("relaxation", [500, 1000, 2000])
def test_relaxation_within_the_window_is_flagged(ar1, relaxation):
    """Drifts of 20 to 31 %, known to 1.8 %: none of 9000 such runs was missed."""
    approach = 1 - 0.5 * np.exp(-np.arange(1000) / relaxation)
    for one in approach * noisy(ar1, 22, 5, 1000, 50):
        assert not is_equilibrated(one)


def test_a_nearly_lossless_bed_is_flagged_through_what_happens_before_the_window(ar1):
    """Like the energy at r = 0.99, beta = 1: relaxing over 1800 T, measured from 5000 T on.

    The drift left in the window itself, 3 %, is about 2 standard errors; from 2500 T on it is 8 or
    more. Missed about once in 600 runs: two of 40 by chance 1 in 500.
    """
    approach = 1 - 0.85 * np.exp(-np.arange(7000) / 1800)
    runs = approach * noisy(ar1, 23, 34, 7000, 40, amplitude=0.06)
    assert sum(is_equilibrated(one, start=5000) for one in runs) <= 1
    assert sum(is_equilibrated(one[5000:]) for one in runs) > 20


def test_a_transient_that_is_long_over_at_start_does_not_matter(ar1):
    approach = 1 - np.exp(-np.arange(3000) / 100)
    for one in approach * noisy(ar1, 24, 10, 3000, 50):
        assert is_equilibrated(one, start=1500)


def test_the_slowest_series_decides(ar1):
    steady, slow = noisy(ar1, 25, 5, 1000, 2)
    assert is_equilibrated(steady, steady)
    assert not is_equilibrated(steady, slow * (1 - np.exp(-np.arange(1000) / 500)))


def test_noise_is_not_taken_for_equilibrium(ar1):
    """Fluctuations of 300 % with tau = n/20: the drift is unknown to within the energy itself."""
    for one in noisy(ar1, 26, 50, 1000, 20, amplitude=3.0):
        assert not is_equilibrated(one)


def test_too_short_a_series_shows_nothing():
    assert not is_equilibrated(np.ones(11))
    assert not is_equilibrated(np.ones(30), start=60)
    with pytest.raises(ValueError, match="must be at least 12"):
        drift(np.ones(11))


@pytest.mark.parametrize("value", [0.0, 0.1])
def test_constant_energies_are_stationary(value, recwarn):
    """Spin never starts at beta = -1; an elastic gas keeps its energy but for rounding."""
    constant = np.full(100, value)
    assert is_equilibrated(constant)
    assert is_equilibrated(constant * (1 + 1e-13 * np.linspace(0, 1, 100)))
    assert detect_start(constant) == 0
    assert not recwarn.list


def test_drift_of_a_straight_line():
    change, stderr, _ = drift(np.linspace(1.0, 2.0, 300))
    assert change == pytest.approx((2 / 3) / (1 + 2 / 3), rel=0.01)
    assert stderr < 1e-12


@pytest.mark.parametrize("samples, tau, relaxation", [(500, 1, 10), (500, 5, 30), (2000, 20, 50)])
def test_start_leaves_less_bias_than_noise(ar1, samples, tau, relaxation):
    approach = 1 - np.exp(-np.arange(samples) / relaxation)
    runs = approach * noisy(ar1, 27, tau, samples, 100)
    means = np.array([one[detect_start(one) :].mean() for one in runs])
    # The mean of 100 runs is known to 0.1 of their scatter: 3 of those on top of the bound.
    assert abs(means.mean() - 1) < (0.5 + 0.3) * means.std()
    assert np.median([detect_start(one) for one in runs]) < 8 * relaxation


def test_start_is_that_of_the_slowest_series(ar1):
    fast, slow = noisy(ar1, 28, 1, 1000, 2) * (1 - np.exp(-np.arange(1000) / np.array([[5], [60]])))
    assert detect_start(fast, slow) == detect_start(slow) > detect_start(fast)


def test_start_never_cuts_more_than_half():
    assert detect_start(np.linspace(0, 1, 1003)) == 503
    assert detect_start(np.arange(4.0)) == 0


@pytest.mark.parametrize("samples, tau", [(100, 1.5), (800, 20), (1000, 50)])
def test_noise_is_hardly_ever_cut(ar1, samples, tau):
    """MSER alone cuts 35 to 42 % of these, this 0.7 to 1.3 %. 28 of 1000: by chance 1 in 5000."""
    runs = noisy(ar1, 29, tau, samples, 1000)
    assert sum(detect_start(one) > 0 for one in runs) <= 27


def test_a_late_start_is_that_of_a_transient(ar1):
    """Planned at 50 of a relaxation over 60: all go on to be cut later, none before."""
    runs = noisy(ar1, 30, 2, 2000, 50) * (1 - np.exp(-np.arange(2000) / 60))
    assert all(detect_start(one, planned=50) > 100 for one in runs)
    assert all(detect_start(one, planned=800) == 800 for one in runs)


def test_how_far_a_cut_stretch_departs(ar1):
    """Of white noise, in sigma: 1000 series give 0 and 1 (two-sided: 0.80 and 0.60) to 3 %."""
    sigmas = [cut_sigmas(one, 40) for one in noisy(ar1, 31, 1, 400, 1000)]
    assert np.mean(sigmas) == pytest.approx(0.80, abs=0.1)
    assert np.std(sigmas) == pytest.approx(0.60, abs=0.1)
    assert cut_sigmas(np.repeat([0.0, 1.0], 20), 20) == np.inf
    assert cut_sigmas(np.ones(20), 5) == 0.0
