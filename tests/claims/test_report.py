"""The report of verdicts, and the page of criteria."""

import json
import re

import pytest
from synthetic import reduced
from tests.study_modules import subject

from roughgas.base import InputError
from roughgas.claims import as_json, as_markdown, judge
from roughgas.claims.verdicts import NOT_TESTED, Finding

PAPER = subject("paper")


@pytest.fixture
def paths(tmp_path):
    paths = [tmp_path / "vibrated.nc", tmp_path / "cooling.nc"]
    reduced().to_netcdf(paths[0])
    reduced("cooling").to_netcdf(paths[1])
    return paths


def test_one_row_for_each_statement_in_both_reports(paths, tmp_path):
    findings = judge(paths, tmp_path / "claims.json", tmp_path / "claims.md", PAPER)
    content = json.loads((tmp_path / "claims.json").read_text())
    assert [claim["id"] for claim in content["claims"]] == [
        statement.name for statement in PAPER.statements
    ]
    assert content["scale"] == "small" and content["data"]["cooling"]["theory"] == "K"
    markdown = (tmp_path / "claims.md").read_text()
    rows = zip(PAPER.statements, findings, content["claims"], strict=True)
    for statement, finding, claim in rows:
        assert claim["verdict"] == finding.verdict and claim["reason"] == finding.reason
        assert statement.quote in markdown and finding.reason in markdown
        assert f"**{claim['verdict']}**" in markdown
        assert claim["text"] == statement.text and claim["mark"] == statement.fixed.mark
        assert claim["fixed"] == statement.fixed.text and claim["tries"] == statement.fixed.tries
        if claim["verdict"] != NOT_TESTED:
            deciding = claim["numbers"][0]
            assert claim["deviation"] == deciding["value"] and claim["sigma"] == deciding["sigma"]
            assert claim["ci95"] == deciding["ci95"] >= 1.9 * claim["error"]
            assert claim["detectable"] > 0
            assert f"{deciding['label']}: {deciding['text']}" in markdown
    ours = [statement.name for statement in PAPER.statements if statement.ours]
    assert ours == ["lun_over_collisions", "excess_is_of_averaging"]
    assert [claim["id"] for claim in content["claims"] if claim["ours"]] == ours
    assert "Of 18 statements: " in markdown and "Of 2 statements of ours: " in markdown
    headings = re.findall(r"^### \d+\. (.*)$", markdown, re.MULTILINE)
    assert headings == [statement.text for statement in PAPER.statements]
    assert markdown.count("| Ours: ") == 2
    assert content["summary"] in markdown and content["how_to_read"] in markdown


def test_criteria_that_were_not_fixed_before_the_data_are_said_to_be_so():
    """Of a copied study no criterion was; of a study the marked criteria were not."""
    findings = [Finding(NOT_TESTED, "No data.")] * len(PAPER.statements)
    markdown = as_markdown(PAPER, findings, "small")
    assert "(criterion in part after its data, 2 tries)" in markdown
    assert "Fixed before its data." in markdown and "Not fixed" not in markdown
    copied = PAPER._replace(reservation="Of other data.")
    markdown = as_markdown(copied, findings, "small")
    content = json.loads(as_json(copied, findings, {}, "small"))
    assert content["reservation"] == "Of other data."
    assert {claim["mark"] for claim in content["claims"]} == {
        "criterion not fixed before these data"
    }
    assert "**Not fixed before these data.** Of other data." in markdown
    assert "Fixed before" not in markdown and "in part after" not in markdown
    assert markdown.count("(criterion not fixed before these data)") == len(PAPER.statements)


def test_datasets_of_several_scales_are_refused(paths, tmp_path):
    reduced("sheared").assign_attrs(scale="paper").to_netcdf(tmp_path / "sheared.nc")
    with pytest.raises(InputError, match="paper and small"):
        judge([*paths, tmp_path / "sheared.nc"], tmp_path / "c.json", tmp_path / "c.md", PAPER)
    with pytest.raises(InputError, match="none"):
        judge([], tmp_path / "c.json", tmp_path / "c.md", PAPER)
    assert not (tmp_path / "c.md").exists()
