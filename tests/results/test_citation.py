"""CITATION.cff, codemeta.json and codecheck.yml agree, and name what exists."""

import json
import shutil
from pathlib import Path

import pytest
from project import Project, jobs_by_rule

from roughgas.base.reading import read_yaml
from roughgas.results.crate import codemeta, full_name, write_codemeta
from roughgas.steps import main

ROOT = Path(__file__).parents[2]
CITED = read_yaml(ROOT / "CITATION.cff")
CHECKED = read_yaml(ROOT / "codecheck.yml")


def test_the_committed_codemeta_is_up_to_date(tmp_path):
    assert main(["codemeta", str(ROOT / "CITATION.cff"), "-o", str(tmp_path / "c.json")]) == 0
    written = (tmp_path / "c.json").read_text("utf-8")
    command = "snakemake -j1 --force codemeta.json"
    assert written == (ROOT / "codemeta.json").read_text("utf-8"), command
    metadata = json.loads(written)
    assert (metadata["version"], metadata["description"]) == (CITED["version"], CITED["title"])
    assert metadata["codeRepository"] == CITED["repository-code"]
    assert metadata["referencePublication"][0]["@id"].endswith(CITED["references"][0]["doi"])


def test_codemeta_has_the_fields_of_a_release_if_the_citation_has_them(tmp_path):
    author = {"given-names": "A", "family-names": "B", "orcid": "https://orcid.org/0"}
    release = {"doi": "10.1/x", "date-released": "2026-12-01"}
    metadata = codemeta(CITED | release | {"authors": [author]})
    assert metadata["author"] == [
        {"@type": "Person", "givenName": "A", "familyName": "B", "@id": "https://orcid.org/0"}
    ]
    assert (metadata["identifier"], metadata["datePublished"]) == ("10.1/x", "2026-12-01")
    assert not {"identifier", "datePublished"} & codemeta(CITED).keys()
    (tmp_path / "bad.cff").write_text("a: [")
    assert main(["codemeta", str(tmp_path / "bad.cff"), "-o", str(tmp_path / "c.json")]) == 2
    write_codemeta(ROOT / "CITATION.cff", output=tmp_path / "c.json")


def test_codecheck_has_the_authors_and_title_of_the_citation():
    assert [author["name"] for author in CHECKED["paper"]["authors"]] == list(
        map(full_name, CITED["authors"])
    )
    assert CHECKED["paper"]["title"] == f"[Re] {CITED['references'][0]['title']}"


@pytest.mark.slow  # runs Snakemake
def test_every_file_of_the_manifest_is_made_by_a_rule(tmp_path):
    project, files = Project(tmp_path), [entry["file"] for entry in CHECKED["manifest"]]
    (tmp_path / "docs").mkdir()
    shutil.copy(ROOT / "docs/results.md", tmp_path / "docs")
    planned = jobs_by_rule(project.succeed("-n", "--", *files))
    jobs = {name: planned[name] for name in ("figure", "table", "claims", "quoted_numbers")}
    assert jobs == {"figure": 4, "table": 1, "claims": 1, "quoted_numbers": 1}
