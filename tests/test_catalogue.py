"""The catalogue of hard cases: its margins, its table, and that remedies are really taken out."""

import math

import pytest
from hard_cases.catalogue import Margins


def test_a_margin_beyond_its_limit_fails_and_is_noted():
    margins = Margins("Family", "a case", "it breaks", full=False)
    margins.at_most("error", 1.0, 1.0, 1, "try")
    margins.at_least("share", 0.5, 0.5, 1, "try")
    for beyond in (1.1, math.nan):
        with pytest.raises(AssertionError, match="beyond its limit"):
            margins.at_most("error", beyond, 1.0, 1, "try")
        with pytest.raises(AssertionError, match="beyond its limit"):
            margins.at_least("share", -beyond, 0.5, 1, "try")
    assert len(margins.rows) == 6
    assert margins.size(quick=1, full=2) == 1
    assert Margins("Family", "a case", "it breaks", full=True).size(quick=1, full=2) == 2
