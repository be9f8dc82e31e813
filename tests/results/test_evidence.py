"""Rows of evidence: what z and the verdict are, and that tables hold every row."""

import math

import pytest

from roughgas.base import InputError
from roughgas.results.evidence import (
    AGREES,
    DIFFERS,
    NOT_KNOWN,
    Row,
    as_markdown,
    combine,
    read_rows,
    write_rows,
)
from roughgas.statistics.errors import Estimate


def row(theirs, ours, **texts):
    texts = {"quantity": "Z", "at": "packing = 0.1", "tier": "exact", "read": "Eq. 1"} | texts
    return Row(source="A 1900", theirs=Estimate(*theirs), ours=Estimate(*ours), **texts)


@pytest.mark.parametrize(
    ("theirs", "ours", "z", "verdict"),
    [
        ((1.0, 0.0), (1.02, 0.01), 2.0, AGREES),
        ((1.0, 0.03), (1.25, 0.04), 5.0, DIFFERS),  # 3, 4, 5
        ((1.0, math.nan), (1.02, 0.01), 2.0, AGREES),  # an error of theirs would only lower z
        ((1.0, math.nan), (1.25, 0.05), 5.0, NOT_KNOWN),
        ((1.0, 0.0), (1.0, math.nan), math.nan, NOT_KNOWN),
    ],
)
def test_rows_differ_by_combined_errors(theirs, ours, z, verdict):
    one = row(theirs, ours)
    assert one.z == pytest.approx(z, nan_ok=True)
    assert one.verdict == verdict


def test_errors_of_few_seeds_count_less():
    """4 standard errors of two degrees of freedom are 1.9 sigma (Student's t: p = 0.057)."""
    one = row((1.0, 0.0), (1.4, 0.1, 2))
    assert one.z == pytest.approx(1.90, abs=0.05)
    assert one.verdict == AGREES and one.is_lenient
    assert not row((1.0, 0.0), (1.2, 0.1, 2)).is_lenient


def test_the_page_counts_verdicts_that_say_little():
    """Three rows agree: by few degrees of freedom, without a published error, and by many."""
    rows = [row((1.0, 0.0), (1.4, 0.1, 2)), row((1.0, math.nan), (1.02, 0.01)), row((1, 0), (1, 1))]
    page = as_markdown([("study", one) for one in rows])
    assert "errors with few degrees of freedom: 1." in page
    assert "and never differ: 1." in page


def test_tables_of_studies_join_with_every_row(tmp_path):
    one = row((1.0, 0.0), (1.02, 0.01, 7.0), reason="=1+1, of all things")
    other = row((1.0, 0.1), (9.0, 0.1), quantity="R", tier="theory", at="r = 0.9")
    paths = [tmp_path / "first.csv", tmp_path / "second.csv"]
    write_rows("first", [one], paths[0])
    write_rows("second", [other], paths[1])
    combine(paths, output=tmp_path / "all.csv")
    rows = read_rows(tmp_path / "all.csv")
    assert rows == [("first", one), ("second", other)]
    page = as_markdown(rows)
    assert "2 rows from 1 source." in page
    assert "| exact result | 1 | 1 | 0 | 0 |" in page
    assert "| approximate theory | 1 | 0 | 1 | 0 |" in page
    assert "| r = 0.9 | 1.00(10) | 9.00(10) | +56.6 | differs |" in page


def test_wrong_tiers_and_files_are_refused(tmp_path):
    with pytest.raises(ValueError, match="tier 'rumour' of Z: must be one of exact"):
        write_rows("study", [row((1.0, 0.0), (1.0, 0.1), tier="rumour")], tmp_path / "a.csv")
    assert not (tmp_path / "a.csv").exists()
    (tmp_path / "b.csv").write_text("study,quantity\n")
    with pytest.raises(InputError, match="have the columns study, quantity, at"):
        read_rows(tmp_path / "b.csv")
