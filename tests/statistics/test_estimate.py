"""A number with its standard error, its significance, and how it is written."""

import math
from statistics import NormalDist

import mpmath
import pytest

from roughgas.statistics.errors import Estimate


@pytest.mark.parametrize(
    ("value", "stderr", "text"),
    [
        (0.35649, 0.00301, "0.3565(30)"),
        (0.35649, 0.000999, "0.3565(10)"),
        (0.35649, 0.0996, "0.36(10)"),
        (-0.002, 0.0131, "-0.002(13)"),
        (17.03, 1.24, "17.0(1.2)"),
        (1234.5, 87.0, "1234(87)"),
        (1234.5, 1870.0, "1200(1900)"),
        (3.3489e-11, 3.2e-12, "3.35(32)e-11"),
        (2.5e7, 1.25e5, "2.500(12)e+07"),
        (0.0, 0.01, "0.000(10)"),
        (0.123456789, math.nan, "0.123457"),
        (0.5, 0.0, "0.5"),
        (math.nan, 0.1, "nan"),
    ],
)
def test_the_compact_form_has_the_error_in_units_of_the_last_digits(value, stderr, text):
    assert f"{Estimate(value, stderr)}" == text


@pytest.mark.parametrize(
    ("value", "stderr", "how", "text"),
    [
        (0.35649, 0.00301, "±", "0.3565 ± 0.0030"),
        (0.35649, 0.00301, "+±", "+0.3565 ± 0.0030"),
        (68.2, 0.0996, "±", "68.20 ± 0.10"),
        (1234.5, 87.0, "±", "1234 ± 87"),
        (0.5, 0.0, "±", "0.50 ± 0.00"),
        (-0.002, 0.0131, "+.4f", "-0.0020 ± 0.0131"),
        (0.5, math.nan, "+.4f", "+0.5000 (error unknown)"),
    ],
)
def test_the_long_form_applies_one_format_to_both(value, stderr, how, text):
    assert f"{Estimate(value, stderr):{how}}" == text


def beyond(t, dof):
    """Probability that Student's t is larger than `t` > 0 (Abramowitz and Stegun, 26.7.1)."""
    share = dof / (dof + t * t)
    return float(mpmath.betainc(dof / 2, 0.5, 0, share, regularized=True)) / 2


def test_significance_has_the_probability_of_students_t():
    for ratio in (1.0, 2.5, 4.0):
        exact = -NormalDist().inv_cdf(beyond(ratio, 30))
        assert Estimate(ratio, 1.0, 30).sigma == pytest.approx(exact, rel=0.02)
        assert Estimate(-ratio, 1.0, 30).sigma == -Estimate(ratio, 1.0, 30).sigma


def test_significance_of_a_well_known_error_is_the_ratio_itself():
    assert Estimate(6.6, 2.0).sigma == 3.3


def test_four_seeds_alone_need_ten_standard_errors_for_three_sigma():
    assert not Estimate(9.0, 1.0, 3).real
    assert Estimate(10.0, 1.0, 3).real


def test_estimates_without_or_with_zero_error():
    assert math.isnan(Estimate(0.1, math.nan).sigma) and not Estimate(0.1, math.nan).real
    assert Estimate(0.1, 0.0).sigma == math.inf and Estimate(-0.1, 0.0).sigma == -math.inf
    assert Estimate(0.0, 0.0).sigma == 0.0


def test_difference_adds_errors_in_quadrature():
    """Its degrees of freedom are those of Welch and Satterthwaite: 5^4 / (3^4/9 + 4^4/5)."""
    found = Estimate(0.5, 3.0, 9).minus(Estimate(0.2, 4.0, 5))
    assert found == (pytest.approx(0.3), 5.0, pytest.approx(5**4 / (3**4 / 9 + 4**4 / 5)))
