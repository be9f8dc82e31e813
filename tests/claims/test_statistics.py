import math
from statistics import NormalDist

import mpmath
import numpy as np
import pytest

from roughgas.claims.statistics import Estimate, Sample, pooled_errors


def beyond(t, freedom):
    """Probability that Student's t is larger than `t` > 0 (Abramowitz and Stegun, 26.7.1)."""
    share = freedom / (freedom + t * t)
    return float(mpmath.betainc(freedom / 2, 0.5, 0, share, regularized=True)) / 2


def test_significance_has_the_probability_of_students_t():
    for ratio in (1.0, 2.5, 4.0):
        exact = -NormalDist().inv_cdf(beyond(ratio, 30))
        assert Estimate(ratio, 1.0, 30).sigma == pytest.approx(exact, rel=0.02)
        assert Estimate(-ratio, 1.0, 30).sigma == -Estimate(ratio, 1.0, 30).sigma


def test_significance_of_a_well_known_error_is_the_ratio_itself():
    assert Estimate(6.6, 2.0, math.inf).sigma == 3.3


def test_four_seeds_alone_need_ten_standard_errors_for_three_sigma():
    assert not Estimate(9.0, 1.0, 3).real
    assert Estimate(10.0, 1.0, 3).real


def test_estimates_without_or_with_zero_error():
    assert math.isnan(Estimate(0.1, math.nan).sigma) and not Estimate(0.1, math.nan).real
    assert Estimate(0.1, 0.0).sigma == math.inf and Estimate(-0.1, 0.0).sigma == -math.inf
    assert Estimate(0.0, 0.0).sigma == 0.0


def test_difference_adds_errors_in_quadrature():
    assert Estimate(0.5, 3.0, 9).minus(Estimate(0.2, 4.0, 5)) == (pytest.approx(0.3), 5.0, 5)


def test_mean_and_largest_of_a_sample():
    beta = np.array([-0.5, 0.0, 0.5])
    places = {"r": np.full(3, 0.9), "beta": beta, "wave": np.array(["sine", "triangle", "sine"])}
    sample = Sample(places, np.array([0.1, -0.3, 0.2]), np.array([1, 2, 2]), 12)
    assert sample.mean() == (pytest.approx(0.0), pytest.approx(1.0), 12)
    largest, place = sample.largest()
    assert largest == (-0.3, 2.0, 12) and place == "r = 0.9, beta = 0, wave = triangle"
    assert sample.where(beta > 0).place(0) == "r = 0.9, beta = 0.5, wave = sine"
    twice = sample.joined(sample)
    assert twice.size == 6 and twice.place(5) == sample.place(2)


def test_pooled_errors_find_what_the_errors_within_must_be_multiplied_by():
    rng = np.random.default_rng(4)
    within = rng.uniform(0.5, 2, 300)
    true = 1.7 * within
    between = (rng.normal(0, 1, (4, 300)) * 2 * true).std(0, ddof=1) / 2
    errors, freedom = pooled_errors(between, within, np.full(300, 4))
    assert freedom == 900
    ours = errors[errors > between * (1 + 1e-12)] / true[errors > between * (1 + 1e-12)]
    np.testing.assert_allclose(ours, 1.0, atol=0.08)
    assert np.all(errors >= between)


def test_a_drifting_point_keeps_its_own_error_and_spoils_no_other():
    between, within = np.full(21, 1.0), np.full(21, 1.0)
    between[4] = 50.0
    errors, _ = pooled_errors(between, within, np.full(21, 4))
    assert errors[4] == 50.0 and np.delete(errors, 4).max() < 1.2


def test_seeds_or_errors_within_alone():
    nan = np.full(3, np.nan)
    errors, freedom = pooled_errors(np.ones(3), nan, np.full(3, 4))
    assert np.all(errors == 1) and freedom == 3
    errors, freedom = pooled_errors(np.ones(3), np.ones(3), np.ones(3, int))
    assert np.all(errors == 1) and freedom == math.inf
