"""The page of criteria is that of the code, and leaves none out."""

import inspect
import re

import pytest
from tests.claims import page

from roughgas.claims import (
    OPEN_QUESTIONS,
    PAPER,
    averages,
    of_studies,
    open_questions,
    paper,
    verdicts,
)

FIXED = re.compile(r"Fixed (before (any|its|the) data|as NEAR was|when R of four points at)")
STATEMENTS = PAPER.statements + OPEN_QUESTIONS.statements


@pytest.mark.parametrize("name", page.tables())
def test_the_tables_of_the_page_are_those_of_the_code(name):
    assert page.written(name) == page.tables()[name], "write it anew: python -m tests.claims.page"


@pytest.mark.parametrize("statement", STATEMENTS, ids=lambda one: one.name)
def test_each_statement_says_its_criterion_and_when_it_was_fixed(statement):
    assert statement.criterion.endswith(".")
    assert statement.fixed.startswith(("before its data", "after its data", "after the data"))


def test_no_tolerance_is_left_out():
    """Each number that a judge is in these files is a constant of the page, or says that it decides
    nothing."""
    for module in (verdicts, averages, of_studies, paper, open_questions):
        said = page.said(module)
        numbers = {name for name in said if isinstance(getattr(module, name), float)}
        left = {name for name in numbers if page.SAID.get(name) is not module}
        assert left <= {"NEAR", "SMOOTH", "SPIN_ALONE"}, "a tolerance without its reason"
    assert "decides nothing" in page.said(paper)["NEAR"]


@pytest.mark.parametrize("name", page.SAID)
def test_each_tolerance_says_when_it_was_fixed(name):
    assert FIXED.search(page.said(page.SAID[name])[name])


def test_criteria_are_those_of_judges_or_samples():
    judges = {one.name: one for one in STATEMENTS}
    said = " ".join(inspect.getdoc(paper.theory_underestimates).split())
    assert judges["theory_underestimates"].criterion == said
    agrees = "R - theory at every point is compatible with zero: agreement with Lun's formula"
    agrees += ", also relative to theory."
    assert judges["vibrated_follows_lun"].criterion == agrees
