"""What the documentation says in Python is true: its examples run, and its reference is whole."""

import re
import shutil
from pathlib import Path

import matplotlib
import pytest
import xarray

import roughgas
from roughgas import theory

ROOT = Path(__file__).parent.parent
EXAMPLE = re.compile(r"^```python\n(.*?)^```$(?:\n+```text\n(.*?)^```$)?", re.M | re.S)
WITH_EXAMPLES = {"data", "effects", "experiments", "library", "observables", "trajectories"}
SAYING_WHAT_IS_PRINTED = {"experiments", "library", "observables"}


def examples():
    """By the names of pages: their examples in Python, and what each says that it prints, or ""."""
    pages = {page.stem: EXAMPLE.findall(page.read_text()) for page in (ROOT / "docs").glob("*.md")}
    return {name: found for name, found in pages.items() if found}


@pytest.fixture
def folder(monkeypatch, tmp_path, files):
    """A folder to be in, with the results that examples read; no display."""
    matplotlib.use("agg")
    monkeypatch.chdir(tmp_path)
    results = tmp_path / "results" / "paper"
    results.mkdir(parents=True)
    shutil.copy(files["reduced"], results / "vibrated.nc")
    (results / "vibrated/r0.9/beta0.5").mkdir(parents=True)
    shutil.copy(files["point"], results / "vibrated/r0.9/beta0.5/seed1.nc")
    xarray.Dataset().to_netcdf(results / "accuracy.nc", group="statistical")


def test_pages_have_the_examples_that_they_should_have():
    found = examples()
    assert found.keys() == WITH_EXAMPLES
    assert {
        name for name in found if any(said for _, said in found[name])
    } == SAYING_WHAT_IS_PRINTED
    assert sum("simulate(" in text for text, _ in found["library"]) > 4


@pytest.mark.parametrize("page", sorted(WITH_EXAMPLES))
def test_examples_run_and_print_what_the_page_says(page, folder, capsys):
    names = {}  # a later example goes on from the others
    for text, said in examples()[page]:
        if "\nregister(" not in text:  # effects/test_worked_example.py runs that one
            exec(compile(text, page, "exec"), names)
        printed = capsys.readouterr().out
        assert not said or printed == said


@pytest.mark.parametrize(("page", "module"), [("theory", theory), ("library", roughgas)])
def test_the_reference_is_whole(page, module):
    text = (ROOT / "docs" / "api" / f"{page}.md").read_text()
    told = re.findall(r"^\.\. auto(?:function|class):: (\w+)$", text, re.M)
    public = [name for name in module.__all__ if not name.startswith("__")]
    assert sorted(told) == sorted(public)
