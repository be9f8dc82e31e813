import numpy as np
import pytest
from synthetic import reduced

from roughgas.claims.verdicts import FAILS, HOLDS, NOT_TESTED, QUALIFIED


def bump(size):
    """A difference that grows with dissipation: `size` at r = 0.8, beta = 0."""
    return lambda r, beta: size * (1 - r) / 0.2 * (1 - beta**2)


@pytest.mark.parametrize(
    ("shift", "expected"), [(0.0, HOLDS), (0.015, HOLDS), (0.04, QUALIFIED), (0.09, FAILS)]
)
def test_follows_lun(verdicts, shift, expected):
    finding = verdicts(reduced(shift=bump(shift)))["vibrated_follows_lun"]
    assert finding.verdict == expected
    largest = finding.numbers[0][1]
    if shift:
        assert largest.value == pytest.approx(shift, abs=0.005)
        assert largest.real and "r = 0.8" in finding.reason


def test_one_stray_point_qualifies_but_does_not_refute(verdicts):
    stray = reduced(shift=lambda r, beta: 0.1 * ((r == 0.9) & (beta == 0.3)))
    finding = verdicts(stray)["vibrated_follows_lun"]
    assert finding.verdict == QUALIFIED and "r = 0.9, beta = 0.3" in finding.reason


def test_large_errors_neither_hold_nor_refute(verdicts):
    finding = verdicts(reduced(error=0.02))["vibrated_follows_lun"]
    assert finding.verdict == QUALIFIED and "too large to tell" in finding.reason
    finding = verdicts(reduced(error=0.2))["vibrated_follows_lun"]
    assert finding.verdict == NOT_TESTED and "errors are too large" in finding.reason


@pytest.mark.parametrize(("slope", "expected"), [(0.0, HOLDS), (0.2, QUALIFIED), (0.5, FAILS)])
def test_independent_of_r(verdicts, slope, expected):
    data = reduced(shift=lambda r, beta: slope * (0.99 - r) + 0 * beta)
    finding = verdicts(data)["vibrated_independent_of_r"]
    assert finding.verdict == expected
    assert finding.numbers[1][1].value == pytest.approx(0.19 * slope, abs=0.002)


def test_dependence_on_r_needs_two_r(verdicts):
    finding = verdicts(reduced(r=(0.9,)))["vibrated_independent_of_r"]
    assert finding.verdict == NOT_TESTED and "fewer than two" in finding.reason


@pytest.mark.parametrize(
    ("shift", "expected"),
    [
        (bump(0.03), HOLDS),
        (lambda r, beta: 0.01 + 0 * r * beta, QUALIFIED),
        (bump(0.003), QUALIFIED),
        (bump(0.0), FAILS),
        (bump(-0.03), FAILS),
    ],
    ids=["grows", "everywhere the same", "a trifle", "none", "overestimates"],
)
def test_theory_underestimates(verdicts, shift, expected):
    finding = verdicts(reduced(shift=shift, error=0.0005))["theory_underestimates"]
    assert finding.verdict == expected
    assert "at r = 0.8" in finding.reason


def test_a_direction_within_large_errors_is_not_tested(verdicts):
    finding = verdicts(reduced(error=0.03))["theory_underestimates"]
    assert finding.verdict == NOT_TESTED and "too large to tell a direction" in finding.reason


@pytest.mark.parametrize(("shift", "expected"), [(0, HOLDS), (0.04, QUALIFIED), (-0.1, FAILS)])
def test_equipartition_when_rough(verdicts, shift, expected):
    sheared = reduced("sheared", shift=lambda r, beta: shift * (beta == 1) + 0 * r)
    assert verdicts(reduced(), sheared)["forced_equipartition"].verdict == expected


def test_points_without_a_steady_state_are_set_aside(verdicts):
    equilibrated = np.ones((3, 21))
    equilibrated[0] = 0.25
    data = reduced(shift=lambda r, beta: 0.3 * (r == 0.8) + 0 * beta, equilibrated=equilibrated)
    finding = verdicts(data)["vibrated_follows_lun"]
    assert finding.verdict == HOLDS
    assert "42 of 42 points" in finding.reason
    assert "21 points not in a steady state set aside" in finding.reason
    finding = verdicts(reduced(equilibrated=0.0))["vibrated_follows_lun"]
    assert finding.verdict == NOT_TESTED and "steady state" in finding.reason


def test_points_with_the_contact_time_model_are_not_the_papers(verdicts):
    """At r = 0.6 something else altogether: nothing of it is judged."""
    contact_time = np.array([[1e-4], [np.nan], [np.nan]])

    def elsewhere(r, beta):
        return np.where(r == 0.6, 0.3, 0.0)

    bed = reduced("vibrated", elsewhere, r=(0.6, 0.9, 0.99), contact_time=contact_time)
    same = reduced("vibrated", elsewhere, r=(0.6, 0.9, 0.99))
    assert verdicts(bed)["vibrated_follows_lun"].verdict == HOLDS
    assert verdicts(same)["vibrated_follows_lun"].verdict != HOLDS
