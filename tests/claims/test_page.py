"""The page of criteria is that of the code, and leaves none out."""

import re

import pytest
from tests.claims import page
from tests.houses import statements

from roughgas.claims import (
    averages,
    of_studies,
    paper,
    verdicts,
)

FIXED = re.compile(r"Fixed (before (any|its|the) data|as NEAR was|when R of four points at)")
STATEMENTS = statements().values()


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
    for module in (verdicts, averages, of_studies, paper):
        said = page.said(module)
        numbers = {name for name in said if isinstance(getattr(module, name), float)}
        left = {name for name in numbers if page.SAID.get(name) is not module}
        assert left <= {"NEAR"}, "a tolerance without its reason"
    assert "decides nothing" in page.said(paper)["NEAR"]


@pytest.mark.parametrize("name", page.SAID)
def test_each_tolerance_says_when_it_was_fixed(name):
    assert FIXED.search(page.said(page.SAID[name])[name])
