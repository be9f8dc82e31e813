"""What the documentation says in Python is true: its examples run, and its reference is whole."""

import ast
import importlib
import re
from pathlib import Path

import matplotlib
import pytest

import roughgas
from roughgas import theory

ROOT = Path(__file__).parent.parent
PAGES = [ROOT / "README.md", *sorted((ROOT / "docs").glob("*.md"))]
BLOCK = re.compile(r"^```python\n(.*?)^```", re.M | re.S)


def examples(page):
    """The examples of a page that use the library, as one: a later one goes on from the others."""
    text = "\n".join(BLOCK.findall(page.read_text()))
    return text if "roughgas" in text else ""


@pytest.fixture
def no_display(monkeypatch, tmp_path):
    matplotlib.use("agg")
    monkeypatch.chdir(tmp_path)


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.stem)
def test_examples_run_or_at_least_import(page, no_display):
    text = examples(page)
    if "simulate(" in text and "results/" not in text:
        exec(compile(text, page.name, "exec"), {})
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, ast.ImportFrom) and node.module.startswith("roughgas"):
            module = importlib.import_module(node.module)
            for alias in node.names:
                assert hasattr(module, alias.name) or importlib.import_module(
                    f"{node.module}.{alias.name}"
                )


def test_the_library_has_examples():
    assert examples(ROOT / "docs" / "library.md").count("simulate(") > 4


@pytest.mark.parametrize(("page", "module"), [("theory", theory), ("library", roughgas)])
def test_the_reference_is_whole(page, module):
    text = (ROOT / "docs" / "api" / f"{page}.md").read_text()
    told = re.findall(r"^\.\. auto(?:function|class):: (\w+)$", text, re.M)
    public = [name for name in module.__all__ if not name.startswith("__")]
    assert sorted(told) == sorted(public)


def test_the_tutorial_is_committed_clean():
    text = (ROOT / "docs" / "tutorial.ipynb").read_text()
    assert '"outputs": []' in text and not re.search(r'"execution_count": \d', text)
    assert text.count('"outputs": []') == text.count('"outputs"')
