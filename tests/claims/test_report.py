"""The report of verdicts, and the page of criteria."""

import json
import re

import pytest
from synthetic import reduced
from tests.claims import page
from tests.houses import statements

from roughgas.base import InputError
from roughgas.claims import PAPER, averages, judge, of_studies, paper, verdicts
from roughgas.claims.verdicts import NOT_TESTED


@pytest.fixture
def paths(tmp_path):
    paths = [tmp_path / "vibrated.nc", tmp_path / "cooling.nc"]
    reduced().to_netcdf(paths[0])
    reduced("cooling").to_netcdf(paths[1])
    return paths


def test_one_row_for_each_statement_in_both_reports(paths, tmp_path):
    findings = judge(paths, tmp_path / "claims.json", tmp_path / "claims.md", PAPER)
    content = json.loads((tmp_path / "claims.json").read_text())
    assert [claim["id"] for claim in content["claims"]] == [one.name for one in PAPER.statements]
    assert content["scale"] == "small" and content["data"]["cooling"]["theory"] == "K"
    markdown = (tmp_path / "claims.md").read_text()
    rows = zip(PAPER.statements, findings, content["claims"], strict=True)
    for statement, finding, claim in rows:
        assert claim["verdict"] == finding.verdict and claim["reason"] == finding.reason
        assert statement.quote in markdown and finding.reason in markdown
        assert f"**{claim['verdict']}** |" in markdown
        if claim["verdict"] != NOT_TESTED:
            deciding = claim["numbers"][0]
            assert claim["deviation"] == deciding["value"] and claim["sigma"] == deciding["sigma"]


def test_missing_experiments_are_named(paths, tmp_path):
    judge(paths, tmp_path / "claims.json", tmp_path / "claims.md", PAPER)
    content = json.loads((tmp_path / "claims.json").read_text())
    claims = {claim["id"]: claim for claim in content["claims"]}
    assert claims["sheared_follows_lun"]["verdict"] == NOT_TESTED
    assert claims["sheared_follows_lun"]["reason"] == "No data of sheared."
    assert claims["sheared_follows_lun"]["sigma"] is None
    assert claims["vibrated_follows_lun"]["verdict"] != NOT_TESTED


def test_the_same_data_give_the_same_bytes(paths, tmp_path):
    reports = []
    for order in (paths, paths[::-1]):
        judge(order, tmp_path / "claims.json", tmp_path / "claims.md", PAPER)
        names = ("claims.json", "claims.md")
        reports.append([(tmp_path / name).read_bytes() for name in names])
    assert reports[0] == reports[1]


def test_datasets_of_several_scales_are_refused(paths, tmp_path):
    reduced("sheared").assign_attrs(scale="paper").to_netcdf(tmp_path / "sheared.nc")
    with pytest.raises(InputError, match="paper and small"):
        judge([*paths, tmp_path / "sheared.nc"], tmp_path / "c.json", tmp_path / "c.md", PAPER)
    with pytest.raises(InputError, match="none"):
        judge([], tmp_path / "c.json", tmp_path / "c.md", PAPER)
    assert not (tmp_path / "c.md").exists()


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
