import json

import pytest
from synthetic import BETA, averaged, reduced
from tests.entry import main
from tests.houses import statements

from roughgas.base import InputError
from roughgas.claims import PAPER, judge
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


def test_statements_have_names_of_their_own():
    both = statements().values()
    assert len({statement.name for statement in both}) == len(both)


def test_the_papers_own_experiments_leave_nothing_untested(tmp_path):
    kinds = [f"vibrated_{kind}_walls" for kind in ("rough", "particle", "smooth")]
    sheared = reduced("sheared", error=0.004)
    sheared["R_unsubtracted"], sheared["R_unsubtracted_stderr"] = sheared.R - 0.1, sheared.R_stderr
    walls = [reduced(kind, r=(0.9,), beta=(-1.0, *BETA)) for kind in kinds]
    paths = []
    for data in (averaged(reduced()), reduced("cooling"), sheared, *walls):
        paths.append(tmp_path / f"{data.attrs['experiment']}.nc")
        data.to_netcdf(paths[-1])
    findings = judge(paths, tmp_path / "claims.json", tmp_path / "claims.md", PAPER)
    assert len(findings) == 19
    assert NOT_TESTED not in {finding.verdict for finding in findings}


def test_each_table_says_what_it_is_about(tmp_path):
    reduced("cooling_spheres").to_netcdf(tmp_path / "spheres.nc")
    tables = []
    for option in ([], ["--open-questions"]):
        out = [f"--json={tmp_path / 'c.json'}", f"--markdown={tmp_path / 'c.md'}"]
        assert main(["claims", str(tmp_path / "spheres.nc"), *option, *out]) == 0
        tables.append((tmp_path / "c.md").read_text())
        title = json.loads((tmp_path / "c.json").read_text())["title"]
        assert tables[-1].startswith(f"# {title}\n\nS. McNamara")
    assert "19 statements: holds 0," in tables[0] and "`open_questions.md`" in tables[0]
    assert "2 statements: holds 0," in tables[1] and "`open_questions.md`" not in tables[1]
    assert all("{" not in table and "Significance and size" in table for table in tables)
