"""The counts of published rows that docs/evidence.md quotes, of rows whose verdicts are known."""

import math

import pytest

from roughgas.results.comparison import Row
from roughgas.results.row_counts import row_counts
from roughgas.statistics.estimates import Estimate

EXACT, UNPUBLISHED = 0.0, math.nan


def row(ours, stderr, dof, theirs_stderr=EXACT, tier="exact"):
    theirs = Estimate(1.0, theirs_stderr)
    return Row("R", "r = 0.9", tier, "source", "table", theirs, Estimate(ours, stderr, dof))


def test_counts_are_of_rows_with_known_verdicts():
    rows = [
        ("exact", row(1.01, 0.01, math.inf)),  # one error off
        ("exact", row(1.0, 1e-12, math.inf)),
        ("exact", row(1.09, 0.01, math.inf)),  # differs
        ("exact", row(1.01, 0.05, math.inf)),  # could see no tenth
        ("exact", row(1.008, 0.002, 3.0, tier="theory")),  # four errors of 3 degrees of freedom
        ("waves", row(1.01, 0.01, math.inf, UNPUBLISHED)),
        ("waves", row(1.09, 0.01, math.inf, UNPUBLISHED)),
        ("waves", row(1.09, math.nan, math.inf, UNPUBLISHED)),
        ("mpemba", row(1.01, 0.01, math.inf, EXACT, "simulation")),
        ("mpemba", row(1.01, 0.01, math.inf, EXACT, "simulation")),
        ("megias_santos", row(0.98, 0.01, math.inf, EXACT, "simulation")),
        ("megias_santos", row(1.00, 0.01, math.inf, EXACT, "simulation")),
    ]
    counts = row_counts(rows)
    names = "rows", "agree", "differ", "no_error", "not_tested", "not_known"
    assert [int(counts[name]) for name in names] == [12, 8, 1, 1, 1, 1]
    assert sum(int(counts[name]) for name in names[1:]) == len(rows)
    assert (counts["exact.agree"], counts["exact.differ"], counts["theory.rows"]) == ("3", "1", "1")
    assert (counts["far"], counts["far.theory"]) == ("1", "1")
    assert (counts["without_chance"], counts["without_error"]) == ("1", "3")
    assert counts["without_error.studies"] == "1"
    assert (counts["t.mpemba"], counts["t.megias_santos"]) == ("1.00", "−1.00")
    assert (counts["t.megias_santos.rows"], counts["biases"]) == ("2", "4")


def test_limits_are_those_of_students_t():
    """Two exact rows have the level 0.005, and one theory 0.01: their two-sided quantiles."""
    rows = [("exact", row(1.0, 0.01, 5.0))] * 2 + [("exact", row(1.0, 0.01, 3.0, tier="theory"))]
    counts = row_counts(rows)
    assert (counts["exact.level"], counts["theory.level"]) == ("0.005", "0.01")
    assert float(counts["exact.t"]) == pytest.approx(4.773, abs=0.05)
    assert float(counts["theory.t"]) == pytest.approx(5.841, abs=0.05)
    assert float(counts["theory.detectable"]) == pytest.approx(5.841 + 1.638, abs=0.05)
