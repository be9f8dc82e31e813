"""The catalogue of hard cases: its margins, its table, and that remedies are really taken out."""

import math

import pytest
from hard_cases.catalogue import Margin, Margins
from hard_cases.pictures import overview
from tests.show.figures.legibility import faults


def margin(**changed):
    row = Margin("Family", "a case", "it breaks", "error", 1e-3, "at most", 1e-2, 1500, "tries")
    return row._replace(**changed)


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


def test_the_picture_has_a_line_for_each_family_and_counts_what_it_cannot_show():
    rows = [margin(), margin(measured=0.0), margin(family="Another", measured=1e-9, limit=1.0)]
    (axes,) = overview(rows).axes
    assert [label.get_text() for label in axes.get_yticklabels()] == ["Family", "Another"]
    assert [text.get_text() for text in axes.texts] == ["1", "1"]
    assert faults(lambda: overview(rows)) == []
