"""Verdicts on rows of evidence: the level of a tier, what a row could see, biases of sources."""

import math

import numpy as np
import pytest

from roughgas.results.comparison import Row
from roughgas.results.row_verdicts import (
    AGREES,
    DIFFERS,
    FALSE_DISCOVERIES,
    NO_ERROR,
    NOT_KNOWN,
    NOT_TESTED,
    biases,
    judge,
    largest_undetected,
    verdicts,
)
from roughgas.statistics.estimates import SIGNIFICANCE, Estimate
from roughgas.statistics.false_discovery import false_discovery_level
from roughgas.statistics.student import t_quantile


def row(theirs, ours, tier="exact", source="A 1900"):
    return Row("Z", "packing = 0.1", tier, source, "Eq. 1", Estimate(*theirs), Estimate(*ours))


def far(t, tier="exact", stderr=0.01):
    return row((1.0, 0.0), (1.0 + stderr * t, stderr), tier)


@pytest.mark.parametrize(
    ("theirs", "ours", "verdict"),
    [
        ((1.0, 0.0), (1.02, 0.01), AGREES),
        ((1.0, 0.03), (1.25, 0.04), DIFFERS),
        ((1.0, math.nan), (1.02, 0.01), AGREES),
        ((1.0, math.nan), (1.25, 0.05), NO_ERROR),
        ((1.0, 0.0), (1.0, math.nan), NOT_KNOWN),
        ((1.0, 0.0), (1.0, 0.03), NOT_TESTED),  # detects 0.03 * 3.86, more than a tenth of 1
        ((1.0, 0.0), (1.5, 0.03), DIFFERS),  # whatever it could have seen
        ((0.01, 0.0), (0.011, 0.0025), AGREES),  # near 0 a tenth of 0.1 counts
        ((0.01, 0.0), (0.011, 0.0027), NOT_TESTED),
        ((2.0, 0.0), (2.0, 1e-11), AGREES),
        ((2.0, 0.0), (2.0 + 1e-9, 1e-11), DIFFERS),
    ],
)
def test_verdicts_on_single_rows(theirs, ours, verdict):
    assert verdicts([row(theirs, ours)]) == [verdict]


def test_more_rows_of_a_tier_lower_its_level():
    """3.1 sigma alone differ, among 100 rows that agree they do not; other tiers do not count."""
    alone, agreeing = far(3.1), [far(0.5)] * 99
    assert verdicts([alone]) == [DIFFERS]
    assert verdicts([alone, *agreeing])[0] == AGREES
    assert verdicts([alone, *[far(0.5, "theory")] * 99])[0] == DIFFERS
    assert verdicts([far(4.5), *agreeing])[0] == DIFFERS
    assert judge([alone, *agreeing])[0].level == pytest.approx(FALSE_DISCOVERIES / 100)


def test_rows_without_chance_or_error_do_not_lower_the_level():
    unknown, certain = row((1.0, 0.0), (1.0, math.nan)), row((1.0, 0.0), (1.0, 1e-11))
    judgements = judge([far(2.0), *[unknown, certain] * 50])
    assert judgements[0].level == FALSE_DISCOVERIES
    assert math.isnan(judgements[1].level) and judgements[2].level == SIGNIFICANCE


def test_a_row_that_misses_the_level_would_differ_a_little_farther_off():
    """The level of a tier is the one that a further differing row would have to meet."""
    tier = [far(t) for t in (9.0, 7.0, -6.0, 0.3, 1.2, -0.4)]
    level = judge(tier)[0].level
    assert level == pytest.approx(4 * FALSE_DISCOVERIES / 6)
    limit = t_quantile(level, math.inf)
    assert verdicts([*tier[:-1], far(limit + 1e-6)])[-1] == DIFFERS
    assert verdicts([*tier[:-1], far(limit - 1e-6)])[-1] == AGREES


def test_a_row_is_a_test_if_it_detects_a_tenth():
    assert largest_undetected(row((-3.0, 0.0), (1.0, 0.1))) == pytest.approx(0.3)
    assert largest_undetected(row((0.0, 0.0), (1.0, 0.1))) == pytest.approx(0.01)


def adjusted(probabilities):
    """Return Benjamini & Hochberg's adjusted probabilities, each by its definition."""
    ascending = sorted(probabilities)
    return [
        min(len(ascending) * p / (k + 1) for k, p in enumerate(ascending) if p >= probability)
        for probability in probabilities
    ]


def test_levels_find_what_adjusted_probabilities_find():
    rng = np.random.default_rng(5)
    for size in (1, 2, 7, 40):
        for power in (1, 3, 8):  # few, some and many small probabilities
            probabilities = rng.random(size) ** power
            level = false_discovery_level(probabilities, 0.2)
            expected = [p <= 0.2 for p in adjusted(probabilities)]
            assert (probabilities <= level).tolist() == expected
    assert math.isnan(false_discovery_level([], 0.2))


@pytest.mark.parametrize("shared", [0.0, 0.7])
def test_false_discoveries_are_as_rare_as_stated_also_for_shared_errors(shared):
    """Of 40 numbers whose errors have a common share. Any significant one is false: at most a fifth
    of 4000 families, to 4 sigma; half of that or more if errors are independent."""
    rng, families, rate = np.random.default_rng(6), 4000, 0.2
    common = math.sqrt(shared) * rng.standard_normal((families, 1))
    t = common + math.sqrt(1 - shared) * rng.standard_normal((families, 40))
    probabilities = np.vectorize(math.erfc)(np.abs(t) / math.sqrt(2))
    false = np.mean([p.min() <= false_discovery_level(p, rate) for p in probabilities])
    assert false < rate + 4 * math.sqrt(rate * (1 - rate) / families)
    assert shared or false > rate - 4 * math.sqrt(rate * (1 - rate) / families)


def test_a_bias_of_a_source_is_seen_where_no_row_differs():
    rng = np.random.default_rng(7)
    t = rng.standard_normal((2, 100))
    pairs = [("a", far(x + 0.6, "simulation")) for x in t[0]]
    pairs += [("b", far(x, "simulation")) for x in t[1]]
    pairs += [("b", row((1.0, 0.0), (1.0, 1e-11), "simulation"))]
    shifted, unshifted = biases(pairs)
    assert shifted.mean.value == pytest.approx(t[0].mean() + 0.6)
    assert shifted.mean.stderr == pytest.approx(t[0].std(ddof=1) / 10)
    assert (shifted.is_common, unshifted.is_common) == (True, False)
    assert unshifted.mean.dof == 99
    assert DIFFERS not in verdicts([entry for _, entry in pairs])
