"""The report of verdicts, and the page of criteria."""

import json

import pytest
from synthetic import reduced

from roughgas.base import InputError
from roughgas.claims import PAPER, judge
from roughgas.claims.evidence import NOT_TESTED


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
            assert claim["ci95"] == deciding["ci95"] >= 1.9 * claim["error"]
    ours = [one.name for one in PAPER.statements if one.ours]
    assert ours == ["lun_over_collisions", "excess_is_of_averaging"]
    assert [claim["id"] for claim in content["claims"] if claim["ours"]] == ours
    assert "Of 17 statements: " in markdown and "Of 2 statements of ours: " in markdown
    assert markdown.count("| Ours: ") == markdown.count("> Ours: ") == 2


def test_datasets_of_several_scales_are_refused(paths, tmp_path):
    reduced("sheared").assign_attrs(scale="paper").to_netcdf(tmp_path / "sheared.nc")
    with pytest.raises(InputError, match="paper and small"):
        judge([*paths, tmp_path / "sheared.nc"], tmp_path / "c.json", tmp_path / "c.md", PAPER)
    with pytest.raises(InputError, match="none"):
        judge([], tmp_path / "c.json", tmp_path / "c.md", PAPER)
    assert not (tmp_path / "c.md").exists()
