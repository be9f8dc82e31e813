"""Files that describe the project agree: version, authors, address, dependencies; and pins."""

import re
import tomllib
from pathlib import Path

import pytest
from jinja2 import Environment, StrictUndefined

import roughgas
from roughgas.base.reading import read_yaml
from roughgas.results.crate import full_name

ROOT = Path(__file__).parents[1]
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
CITED = read_yaml(ROOT / "CITATION.cff")
PAPER = (ROOT / "paper.md").read_text(encoding="utf-8")
WORKFLOWS = sorted((ROOT / ".github" / "workflows").glob("*.yml"))
PROGRAMS = {"bannerman2011", "lam2015", "molder2021", "plimpton2019", "thompson2022"}
PROGRAMS |= {"weinhart2020"}
"""Works on programs, which the page of earlier work does not have."""
OF_CONDA = {
    "dask": "dask-core",
    "matplotlib": "matplotlib-base",
    "snakemake": "snakemake-minimal",
    "typst": "typst-py",
}
"""Names of packages in conda-forge that differ from those of the Python package index."""
REQUIREMENT = re.compile(r"([\w.-]+)\s*([^;]*)")


def rendered(value, names):
    """Return a value of a recipe with its expressions evaluated; `names` are their variables."""
    if isinstance(value, dict):
        return {key: rendered(inner, names) for key, inner in value.items()}
    if isinstance(value, list):
        return [rendered(inner, names) for inner in value]
    environment = Environment(variable_start_string="${{", undefined=StrictUndefined)
    return environment.from_string(value).render(names) if isinstance(value, str) else value


@pytest.fixture(scope="module")
def recipe():
    """The recipe of the conda package, as rattler-build evaluates it."""
    written = read_yaml(ROOT / "recipe" / "recipe.yaml")
    return rendered(written, {**written.pop("context"), "PYTHON": "python"})


def requirements(texts):
    """Return the versions of requirements by name, in the spelling of conda."""
    parsed = [REQUIREMENT.fullmatch(text).groups() for text in texts]
    return {OF_CONDA.get(name.lower(), name.lower()): versions for name, versions in parsed}


def test_the_version_is_the_same_everywhere(recipe):
    assert PROJECT["project"]["dynamic"] == ["version"]  # hatchling reads it where it stands
    assert CITED["version"] == recipe["package"]["version"] == roughgas.__version__


def test_the_recipe_has_the_requirements_of_the_project(recipe):
    project, needs = PROJECT["project"], recipe["requirements"]
    python = f"python {project['requires-python']}"
    assert needs["host"][:2] == [python, "pip"] and needs["run"][0] == python
    assert requirements(needs["host"][2:]) == requirements(PROJECT["build-system"]["requires"])
    assert requirements(needs["run"][1:]) == requirements(project["dependencies"])
    extras = project["optional-dependencies"]
    in_extras = [text for name in roughgas.base.EXTRAS for text in extras[name]]
    optional = [text for text in in_extras if not text.startswith("roughgas[")]
    assert requirements(needs["run_constraints"]) == requirements(optional)


def test_the_recipe_describes_the_project(recipe):
    project, described = PROJECT["project"], recipe["about"]
    assert recipe["package"]["name"] == project["name"]
    assert described["summary"] == project["description"]
    assert described["license"] == project["license"] == CITED["license"]
    assert described["license_file"] == project["license-files"]
    assert described["repository"] == CITED["repository-code"]
    scripts = [f"{name} = {function}" for name, function in project["scripts"].items()]
    assert recipe["build"]["python"]["entry_points"] == scripts


def test_the_authors_are_those_of_the_citation():
    authors = [full_name(author) for author in CITED["authors"]]
    assert [author["name"] for author in PROJECT["project"]["authors"]] == authors
    head = PAPER.split("---\n")[1]
    assert re.findall(r"^  - name: (.*)\n    (?:orcid|affil)", head, re.M) == authors


def pinned(path):
    """Return the pinned packages of a lock file, each a line with its version."""
    text = path.read_text(encoding="utf-8")
    assert "index" not in text and text.count("==") <= text.count(" \\\n    --hash=sha256:")
    return set(re.findall(r"^[\w.-]+==\S+", text, re.M))


def test_lock_files_pin_by_hash_and_repeat_no_package():
    """But for that of clusters, whose environment is apart."""
    base, extras = pinned(ROOT / "requirements.lock"), PROJECT["project"]["optional-dependencies"]
    assert len(base) > 80
    for path in (ROOT / "requirements").glob("*.lock"):
        assert path.stem in extras and pinned(path)
        assert path.stem == "slurm" or not pinned(path) & base


def test_the_paper_cites_what_its_bibliography_has():
    """By DOI. The page of earlier work has all works on physics, and works that the article cites,
    too, are written in the same way."""
    entries = (ROOT / "paper.bib").read_text(encoding="utf-8").split("\n\n")
    keys = [re.match(r"@\w+\{(\w+),", entry)[1] for entry in entries]
    assert set(re.findall(r"@([a-z]+\d{4})", PAPER)) == set(keys)
    assert all(re.search(r"doi = \{10\.\d{4,}/\S+\}", entry) for entry in entries)
    pages = " ".join((ROOT / "docs" / "references.md").read_text(encoding="utf-8").split())
    for key, entry in zip(keys, entries, strict=True):
        volume, page = (re.search(rf"{name} = {{+(\w+)", entry) for name in ("volume", "pages"))
        assert key in PROGRAMS or re.search(rf"\*\*{volume[1]}\*\*,? {page[1]}\b", pages), key
    of_article = (ROOT / "article" / "references.bib").read_text(encoding="utf-8")
    assert [key for key, entry in zip(keys, entries, strict=True) if f"{{{key}," in of_article]
    different = [
        key
        for key, entry in zip(keys, entries, strict=True)
        if f"{{{key}," in of_article and entry.strip() not in of_article
    ]
    assert different == []


def test_the_paper_has_the_length_and_the_sections_that_joss_asks_for():
    text = PAPER.split("---\n", 2)[2]
    assert 750 < len(text.split()) < 1750
    sections = re.findall(r"^# (.*)$", text, re.M)
    assert sections[:3] == ["Summary", "Statement of need", "State of the field"]
    assert sections[-1] == "References"


@pytest.mark.parametrize("path", WORKFLOWS, ids=lambda path: path.stem)
def test_workflows_pin_actions_and_may_read_only(path):
    """By a commit, with its version beside it; a job that may write runs nothing from here."""
    text, workflow = path.read_text(encoding="utf-8"), read_yaml(path)
    used = re.findall(r"uses: (.*)$", text, re.M)
    assert used and all(re.fullmatch(r"[\w/-]+@[0-9a-f]{40} # v[\d.]+", action) for action in used)
    assert workflow["permissions"] in ({}, {"contents": "read"})
    for job in workflow["jobs"].values():
        writes = "write" in job.get("permissions", {}).values()
        assert not (writes and any("run" in step for step in job["steps"]))
        for step in job["steps"]:
            if "actions/checkout@" in step.get("uses", ""):
                assert not writes and step["with"]["persist-credentials"] is False
