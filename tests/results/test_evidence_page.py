"""The sentences on evidence in the documentation, against the rows that are published with it."""

import csv
from collections import Counter
from pathlib import Path

from tests.pages import DOCS

from roughgas.base.files import study_module
from roughgas.base.text import without_comments
from roughgas.results.comparison import read_rows
from roughgas.results.row_verdicts import verdicts

ROOT = DOCS.parent
ROWS = read_rows(ROOT / "figures" / "evidence.csv")
JUDGED = list(zip(ROWS, verdicts([row for _, row in ROWS]), strict=True))


def words(path):
    return " ".join(without_comments(Path(ROOT, path).read_text(encoding="utf-8")).split())


def test_published_reasons_match_the_code():
    """The rows of mpemba name the errors that they share."""
    notes = study_module(ROOT / "studies" / "mpemba", "evidence")
    reasons = {notes.REASON_CROSSING, notes.REASON_CURVE, ""}
    assert {row.reason for study, row in ROWS if study == "mpemba"} == reasons


def test_the_published_table_has_the_verdicts_of_its_rows():
    with open(ROOT / "figures" / "evidence.csv", newline="", encoding="utf-8") as file:
        assert [cells["verdict"] for cells in csv.DictReader(file)] == [v for _, v in JUDGED]


def test_the_readme_of_exact_quotes_verdicts_and_the_farthest_row():
    exact = [(row, verdict) for (_, row), verdict in JUDGED if row.tier == "exact"]
    count = Counter(verdict for _, verdict in exact)
    assert set(count) == {"agrees", "not tested"}
    readme = words("studies/exact/README.md")
    quoted = (
        f"Of {len(exact)} rows none differs: {count['agrees']} agree, and {count['not tested']}"
    )
    assert quoted in readme
    farthest = min((row for row, _ in exact), key=lambda row: row.probability)
    assert f"is {abs(farthest.t):.1f} standard errors off" in readme and farthest.gap.dof == 5
    assert f"exceed this with probability {farthest.probability:.3f}" in readme


def test_the_readme_of_mixtures_quotes_verdicts():
    members = [(row, verdict) for (study, row), verdict in JUDGED if study == "mixtures"]
    count = Counter(verdict for _, verdict in members)
    readme = words("studies/mixtures/README.md")
    assert f"{count['agrees']} of {len(members)} numbers of the cooling gas" in readme
    assert f"all; {count['differs']} differ" in readme and count["not tested"] == 1
    assert all("R of" in row.quantity for row, verdict in members if verdict == "differs")
    assert f"are {sum(abs(row.t) < 3 for row, _ in members)} of the 48" in readme
