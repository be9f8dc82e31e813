"""Rows of evidence: t, its probability, and tables of every row."""

import csv
import math

import pytest

from roughgas.base import InputError
from roughgas.results.comparison import Row, read_rows, write_rows
from roughgas.results.evidence_page import as_markdown
from roughgas.results.row_verdicts import combine
from roughgas.statistics.estimates import Estimate


def row(theirs, ours, **texts):
    texts = {"quantity": "Z", "at": "packing = 0.1", "tier": "exact", "read": "Eq. 1"} | texts
    return Row(source="A 1900", theirs=Estimate(*theirs), ours=Estimate(*ours), **texts)


@pytest.mark.parametrize(
    ("theirs", "ours", "t", "probability"),
    [
        ((1.0, 0.0), (1.02, 0.01), 2.0, 0.0455),
        ((1.0, 0.03), (1.25, 0.04), 5.0, 5.73e-7),  # 3, 4, 5
        ((1.0, math.nan), (1.02, 0.01), 2.0, 0.0455),  # an error of theirs would only lower t
        ((1.0, 0.0), (0.6, 0.1, 2), -4.0, 0.0572),  # 4 standard errors of three values
        ((1.0, 0.0), (1.0, math.nan), math.nan, math.nan),
    ],
)
def test_the_probability_is_of_the_gap_over_the_combined_error(theirs, ours, t, probability):
    result = row(theirs, ours)
    assert result.t == pytest.approx(t, nan_ok=True)
    assert result.probability == pytest.approx(probability, rel=2e-3, nan_ok=True)


def test_errors_of_rounding_are_without_chance():
    assert row((1.0, 0.0), (1.0, 1e-11)).is_without_chance
    assert row((4.0, 0.0), (4.0, 0.0)).is_without_chance
    assert not row((1.0, 1e-6), (1.0, 0.0)).is_without_chance


def test_tables_of_studies_join_with_every_row(tmp_path):
    first = row((1.0, 0.0), (1.02, 0.01, 7.0), reason="=1+1, of all things")
    second = row((1.0, 0.1), (9.0, 0.1), quantity="R", tier="theory", at="r = 0.9")
    third = row((1.0, math.nan), (1.5, 0.1), tier="simulation")
    paths = [tmp_path / f"{name}.csv" for name in ("first", "second", "third")]
    for path, entry in zip(paths, (first, second, third), strict=True):
        write_rows(path.stem, [entry], path)
    combine(paths, output=tmp_path / "all.csv")
    rows = read_rows(tmp_path / "all.csv")
    assert rows[:2] == [("first", first), ("second", second)]
    page = as_markdown(rows)
    assert "3 rows from 1 source." in page
    assert "| exact result | 1 | 1 | 0 | 0 | 0 | 0 | 0.01 |" in page
    assert "| approximate theory | 1 | 0 | 1 | 0 | 0 | 0 | 0.01 |" in page
    assert "| r = 0.9 | 1.00(10) | 9.00(10) | +56.6 | inf | 0 |" in page
    assert "| differs by 50 %, no error published |" in page
    combine([tmp_path / "all.csv"], output=tmp_path / "again.csv")
    assert (tmp_path / "again.csv").read_bytes() == (tmp_path / "all.csv").read_bytes()


def test_the_combined_table_says_what_each_row_could_have_seen(tmp_path):
    entry = row((2.0, 0.0), (2.02, 0.01))
    write_rows("study", [entry], tmp_path / "study.csv")
    combine([tmp_path / "study.csv"], output=tmp_path / "all.csv")
    with open(tmp_path / "all.csv", newline="", encoding="utf-8") as file:
        (cells,) = csv.DictReader(file)
    # one row has the level 0.01: quantiles 2.5758 and 1.2816
    assert float(cells["detectable"]) == pytest.approx(0.01 * (2.5758 + 1.2816), rel=1e-4)
    assert float(cells["detectable_share"]) == pytest.approx(0.005 * 3.8574, rel=1e-4)
    assert (float(cells["t"]), cells["dof"], cells["verdict"]) == (
        pytest.approx(2),
        "inf",
        "agrees",
    )


def test_wrong_tiers_and_files_are_refused(tmp_path):
    with pytest.raises(ValueError, match="tier 'rumour' of Z: must be one of exact"):
        write_rows("study", [row((1.0, 0.0), (1.0, 0.1), tier="rumour")], tmp_path / "a.csv")
    assert not (tmp_path / "a.csv").exists()
    (tmp_path / "b.csv").write_text("study,quantity\n")
    with pytest.raises(InputError, match="have the columns at, tier, source"):
        read_rows(tmp_path / "b.csv")
