"""The sentences on evidence in the documentation, against the rows that are published with it."""

import math
from pathlib import Path

import numpy as np
import pytest
from tests.pages import DOCS

from roughgas.base.files import module_of
from roughgas.results.evidence import AGREES, NOT_KNOWN, read_rows
from roughgas.statistics.errors import SIGNIFICANT, student_t

ROOT = DOCS.parent
ROWS = read_rows(ROOT / "figures" / "evidence.csv")


def words(path):
    return " ".join(Path(ROOT, path).read_text(encoding="utf-8").split())


def raw(row):
    """The difference in combined standard errors; NaN without errors."""
    return abs(row.gap.value / row.gap.stderr) if row.gap.stderr > 0.0 else math.nan


@pytest.fixture(scope="module")
def page():
    return words("docs/evidence.md")


def test_the_page_says_how_many_rows_agree_by_few_degrees_of_freedom(page):
    agree = [row for _, row in ROWS if row.verdict == AGREES]
    lenient = [row for row in agree if row.is_lenient]
    theories = [row for row in lenient if row.tier == "theory"]
    few = [row for row in theories if row.gap.dof < 6]
    others = sorted((row.tier, row.quantity) for row in lenient if row.tier != "theory")
    assert all(raw(row) >= SIGNIFICANT > abs(row.z) for row in lenient)
    assert {round(row.gap.dof) for row in few} == {3, 5}
    assert others == [
        ("exact", "exponent p of T ~ t^-p of a homogeneous cooling gas"),
        ("simulation", "R of disks driven by white noise, DSMC"),
    ]
    dof = [round(row.gap.dof) for row in lenient]
    assert f"{len(lenient)} of the {len(agree)} rows that agree are 3 or more" in page
    assert f"({min(dof)} to {max(dof)}). {len(theories)} of them are theories" in page
    assert f"theories, {len(few)} of these with 3 or 5 degrees of freedom" in page


def test_the_page_says_what_z_means(page):
    sizes = [f"{student_t(SIGNIFICANT, dof):.1f}" for dof in (20, 5, 3)]
    errors = "combined standard errors with 20 degrees of freedom"
    assert "z = 3 is {} {}, {} with 5 and {} with 3".format(sizes[0], errors, *sizes[1:]) in page


def test_the_page_counts_rows_without_a_published_error(page):
    rows = [(study, row) for study, row in ROWS if math.isnan(row.theirs.stderr)]
    unknown = [row for _, row in rows if row.verdict == NOT_KNOWN]
    far = sorted((study, raw(row)) for study, row in rows if abs(row.z) >= SIGNIFICANT)
    assert {row.verdict for _, row in rows} == {AGREES, NOT_KNOWN}
    assert {study for study, _ in rows} == {"exact", "mpemba", "patterns"}
    assert f"**: {len(rows)} rows are such, of three studies" in page
    assert f"{len(rows) - len(unknown)} of them agree, {len(unknown)} are not known" in page
    assert [study for study, _ in far] == ["exact", *3 * ["mpemba"], *2 * ["patterns"]]
    assert [round(far[one][1]) for one in (0, -2, -1)] == [19, 32, 32]


def test_the_page_says_where_simulations_lie(page):
    z = [row.z for _, row in ROWS if row.tier == "simulation" and math.isfinite(row.z)]
    sets = (
        [row.z for study, row in ROWS if study == name and row.tier == "simulation"]
        for name in ("megias_santos", "mpemba")
    )
    assert [f"{np.mean(one):+.1f}" for one in (z, *sets)] == 3 * ["+0.6"]
    assert page.count("+0.6 on average") == 3
    assert words("rules/captions/evidence.rst").count("z is +0.6 on average") == 1


def test_notes_on_errors_are_as_the_code_makes_them():
    """The rows of mpemba say what their errors leave out."""
    notes = module_of(ROOT / "studies" / "mpemba", "evidence")
    made = {notes.OF_CROSSING, notes.INCOMPLETE, notes.ALONG}
    assert {row.reason for study, row in ROWS if study == "mpemba"} == made


def test_the_study_of_exact_numbers_says_how_far_the_farthest_is():
    exact = [row for _, row in ROWS if row.tier == "exact"]
    far, next_far = sorted(exact, key=raw, reverse=True)[:2]
    largest = max(abs(row.z) for row in exact)
    assert raw(far) > SIGNIFICANT > raw(next_far) and far.gap.dof == 5
    readme = words("studies/exact/README.md")
    assert f"all {len(exact)} have |z| < 3, and {largest:.1f} at most" in readme
    assert f"{raw(far):.1f} standard errors off, which five degrees of freedom" in readme
