"""The table of other groups' papers: verdicts, lines of configuration, CPU time."""

import json

import pytest
from tests.study_modules import FOLDERS, ROOT
from tests.synthetic import reduced

from roughgas import config
from roughgas.claims import as_json, examine, read_study
from roughgas.results import papers

CONFIG = """\
# A comment.
paper: A 1900
experiments:
  gas:
    extends: cooling

    # another comment
    description: A gas.
    sweep: {r: ["0.9"], beta: ["0"]}

scales:
  small: {}
"""
CLAIMS = """\
R_is_theory:
  quote: "[R is theory]"
  experiments: [gas]
  agrees_with: theory
  criterion: R is theory.
  fixed: {when: before data}
"""


@pytest.fixture
def study(tmp_path):
    """A folder with a study of a paper, its verdicts and its data."""
    (tmp_path / "config.yaml").write_text(CONFIG)
    (tmp_path / "claims.yaml").write_text(CLAIMS)
    return tmp_path


def test_lines_of_experiments_are_counted_without_comments_and_blank_lines(study):
    assert papers.experiment_lines(study) == 4


def test_a_row_has_the_verdict_its_number_and_the_cpu_time(study, tmp_path):
    data = reduced("cooling", kernel_seconds=2.0, r=(0.9,), beta=(0.0, 0.5))
    data.attrs["experiment"] = f"{study.name}.gas"
    subject = read_study(study, "title", [f"{study.name}.gas"])
    finding = examine(subject.statements[0], {f"{study.name}.gas": data.assign(theory=data.R)})
    path = study / "claims.json"
    path.write_text(as_json(subject, [finding], {}, "paper"))
    (row,) = papers.rows_of_study(
        study.name,
        {"paper": "A 1900", "folder": str(study)},
        json.loads(path.read_text())["claims"],
        4.0,
    )
    assert row.verdict == "holds" and row.label == "largest difference"
    assert (row.paper, row.lines, row.seconds) == ("A 1900", "4", "4.0")
    assert row.deciding == "0.0000(10)"
    page = papers.as_markdown([row])
    assert f"| {study.name} | A 1900 | 4 | 1 holds | 4 |" in page
    assert "| R is theory | largest difference | 0.0000(10) |" in page


def test_every_study_of_a_paper_states_what_it_reproduces_and_what_could_not_be_had():
    configuration = config.load(ROOT / "config.yaml")
    studies = [study for study in configuration.studies.values() if study.paper]
    assert len(studies) >= 12
    for folder in FOLDERS:
        study = configuration.studies[folder.name]
        if study.heading != "papers":
            continue
        assert study.paper, folder
        assert 10 <= papers.experiment_lines(folder) <= 30, folder
        assert "**What could not be had.**" in (folder / "README.md").read_text(encoding="utf-8")
        assert (folder / "claims.yaml").exists() and "small" in (folder / "config.yaml").read_text()


def test_the_committed_table_has_every_study_of_a_paper():
    rows = papers.read(ROOT / "figures" / "papers.csv")
    configuration = config.load(ROOT / "config.yaml")
    studies = {name for name, study in configuration.studies.items() if study.heading == "papers"}
    assert {row.study for row in rows} == studies
    for study in studies:
        subject = read_study(ROOT / "studies" / study, study, ())
        statements = [statement.name.replace("_", " ") for statement in subject.statements]
        assert [row.statement for row in rows if row.study == study] == statements
