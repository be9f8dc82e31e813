"""The catalogue of hard cases: its margins, its table, and that remedies are really taken out."""

import math

import pytest
from hard_cases.catalogue import Margin, Margins, Remedy, Without
from hard_cases.pictures import overview, room
from hard_cases.report import number, table
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


def test_the_table_has_every_margin_under_its_family_and_case():
    rows = [margin(), margin(what="share", sense="at least", limit=1e-4), margin(case="another")]
    text = table(rows, [Remedy("Family", "a case", "the remedy")], full=True)
    assert text.count("\n## Family\n") == 1
    assert text.count("What could go wrong: it breaks.") == 2
    assert "| error | 0.001 | at most 0.01 | 10 | 1 500 tries |" in text
    assert "| share | 0.001 | at least 0.0001 | 10 | 1 500 tries |" in text
    assert "2 cases, 3 margins" in text and "1 of the cases fail" in text
    assert text.index("Fails without: the remedy.") < text.index("**another.**")
    assert "with few tries" in table(rows, [], full=False)


def test_the_picture_has_a_line_for_each_family_and_counts_what_it_cannot_show():
    rows = [margin(), margin(measured=0.0), margin(family="Another", measured=1e-9, limit=1.0)]
    (axes,) = overview(rows).axes
    assert [label.get_text() for label in axes.get_yticklabels()] == ["Family", "Another"]
    assert [text.get_text() for text in axes.texts] == ["1", "1"]
    assert faults(lambda: overview(rows)) == []


def test_counts_are_readable():
    assert [number(n) for n in (7, 1500, 1_000_000, 25_000_000)] == ["7", "1 500", "1e6", "2.5e7"]


def test_room_is_a_factor():
    assert room(margin()) == pytest.approx(10.0)
    assert room(margin(sense="at least", limit=1e-4)) == pytest.approx(10.0)
    assert room(margin(measured=0.0)) == room(margin(measured=1e-2)) == math.inf


def test_a_remedy_must_be_in_the_source_once(tmp_path):
    without = Without(tmp_path, "Family")
    with pytest.raises(AssertionError, match="0 times"):
        without("something", test_room_is_a_factor, "scene/composition.py", "no such text", "")
    assert without.rows == []
