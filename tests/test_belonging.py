"""What makes it a project that others can join, cite and install: forms, metadata, the paper."""

import re
import subprocess
import tomllib
from pathlib import Path

import pytest

import roughgas
from roughgas.base.version import __version__
from roughgas.config.reading import read_yaml

ROOT = Path(__file__).parent.parent
PAGES = ("CONTRIBUTING.md", "CODE_OF_CONDUCT.md", "docs/compared.md", "docs/development.md")
PAGES += ("config/README.md",)
LINK = re.compile(r"\]\(([^)#\s]+)(?:#[^)]*)?\)")


@pytest.mark.parametrize("page", PAGES)
def test_links_lead_somewhere(page):
    path = ROOT / page
    links = [link for link in LINK.findall(path.read_text()) if "://" not in link]
    assert [link for link in links if link != r"RAW/\1" and not (path.parent / link).exists()] == []


def test_forms_for_issues_can_be_read():
    forms = sorted((ROOT / ".github" / "ISSUE_TEMPLATE").glob("*.yml"))
    named = [form for form in map(read_yaml, forms) if "body" in form]
    assert len(named) == 2
    for form in named:
        assert {"name", "description", "body"} <= set(form)
        assert all(part["attributes"]["label"] for part in form["body"])


def test_the_metadata_say_what_it_is_and_where_it_runs():
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    versions = [one.rsplit(" ", 1)[1] for one in project["classifiers"] if ":: 3." in one]
    assert versions[0] == project["requires-python"].removeprefix(">=")
    assert (
        project["version"] == __version__ == roughgas.__version__
        and "granular gas" in project["keywords"]
    )
    assert read_yaml(ROOT / "CITATION.cff")["version"] == __version__


def test_what_the_paper_cites_is_in_its_bibliography():
    cited = set(re.findall(r"@([a-z]+\d{4})", (ROOT / "paper.md").read_text()))
    known = set(re.findall(r"^@\w+\{(\w+),", (ROOT / "paper.bib").read_text(), re.MULTILINE))
    assert cited == known
    _, head, text = (ROOT / "paper.md").read_text().split("---\n", 2)
    assert all(f"\n{key}:" in f"\n{head}" for key in ("title", "tags", "authors", "bibliography"))
    assert 250 < len(text.split()) < 1000  # as the journal asks


def test_the_readme_of_a_package_index_has_no_relative_image():
    page = (ROOT / "docs" / "development.md").read_text()
    (script,) = re.findall(r'^ +sed -E "(.*)" README\.md >', page, re.MULTILINE)
    told = ["sed", "-E", script.replace("RAW", "https://example.org"), "README.md"]
    made = subprocess.run(told, cwd=ROOT, capture_output=True, text=True, check=True).stdout
    images = re.findall(r"!\[[^\]]*\]\(([^)]*)\)", made)
    assert images and all(image.startswith("https://example.org/") for image in images)
