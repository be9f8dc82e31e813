"""Documentation, README, Makefile, recipes of containers: their links, examples and versions."""

import os
import re
import shlex
import shutil
import subprocess
from pathlib import Path

import matplotlib
import pytest
import xarray

import roughgas
from roughgas import config, theory
from roughgas.cli import parser_of
from roughgas.compiling.cache_folders import cache_root
from roughgas.results.crate import project_files

ROOT = Path(__file__).parent.parent
EXAMPLE = re.compile(r"^```python\n(.*?)^```$(?:\n+```text\n(.*?)^```$)?", re.M | re.S)
WITH_EXAMPLES = {"data", "effects", "experiments", "library", "observables", "trajectories"}
WITH_FILES = {"development"}  # all of whose examples are files, with a docstring at their top
SAYING_WHAT_IS_PRINTED = {"experiments", "library", "observables", "trajectories"}


def examples():
    """By the names of pages: their examples in Python, and what each says that it prints, or ""."""
    pages = {page.stem: EXAMPLE.findall(page.read_text()) for page in (ROOT / "docs").glob("*.md")}
    return {name: page_examples for name, page_examples in pages.items() if page_examples}


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
    pages = examples()
    assert pages.keys() == WITH_EXAMPLES | WITH_FILES
    assert {
        name for name in pages if any(output for _, output in pages[name])
    } == SAYING_WHAT_IS_PRINTED
    assert sum("simulate(" in text for text, _ in pages["library"]) > 4


# what these show takes seconds, or is compiled anew
SLOW = {name: [pytest.mark.slow] for name in ("effects", "library", "observables", "trajectories")}


@pytest.mark.parametrize(
    "page", [pytest.param(page, marks=SLOW.get(page, [])) for page in sorted(WITH_EXAMPLES)]
)
def test_examples_run_and_print_what_the_page_says(page, folder, capsys):
    names = {}  # a later example goes on from the others
    for text, output in examples()[page]:
        if not (text.startswith('"""') or "roughgas.register_" in text):  # test_pages.py has those
            exec(compile(text, page, "exec"), names)
            printed = capsys.readouterr().out
            assert not output or printed == output


@pytest.mark.parametrize(("page", "module"), [("theory", theory), ("library", roughgas)])
def test_the_reference_is_whole(page, module):
    text = (ROOT / "docs" / "api" / f"{page}.md").read_text()
    documented = re.findall(r"^\.\. auto(?:function|class):: (\w+)$", text, re.M)
    public = [name for name in module.__all__ if not name.startswith("__")]
    assert sorted(documented) == sorted(public)


PAGES = ("README.md", "CONTRIBUTING.md", "CODE_OF_CONDUCT.md", "config/README.md")
PAGES += ("docs/compared.md", "docs/development.md")
LINK = re.compile(r"\]\(([^)#\s]+)(?:#[^)]*)?\)")


@pytest.mark.parametrize("page", PAGES)
def test_links_lead_somewhere(page):
    path = ROOT / page
    links = [link for link in LINK.findall(path.read_text()) if "://" not in link]
    assert [link for link in links if link != r"RAW/\1" and not (path.parent / link).exists()] == []


README = (ROOT / "README.md").read_text(encoding="utf-8")
CLONE = "git clone ADDRESS roughgas"
PRODUCTS = (
    *("cooling_r0.9_beta0.5_seed1.nc", "bed.mp4", "figures/small/mine.png"),
    *(f"results/small/{page}.html" for page in ("report", "explore", "living")),
)


def blocks(language):
    return re.findall(rf"^```{language}\n(.*?)^```", README, re.M | re.S)


def commands():
    """Return the typed lines, without remarks."""
    lines = [line for block in blocks("console") for line in block.splitlines()]
    return [re.sub(r"\s{2,}# .*", "", line[2:]) for line in lines if line.startswith("$ ")]


def answers():
    """Return the printed lines."""
    lines = [line for block in blocks("console") for line in block.splitlines()]
    return [line for line in lines if not line.startswith("$ ") and line != "..."]


def test_its_commands_are_commands():
    command_lines = [shlex.split(line) for line in commands()]
    subcommands = [line[1:] for line in command_lines if line[0] == "roughgas"]
    assert len(subcommands) == 3
    for arguments in subcommands:
        parser_of(arguments[0]).parse_args(arguments)
    targets = re.findall(r"^([a-z]+):", (ROOT / "Makefile").read_text(), re.M)
    assert {line[-1] for line in command_lines if line[0] == "make"} <= set(targets)


def test_its_snippet_is_a_study(tmp_path, monkeypatch):
    (snippet,) = blocks("yaml")
    shutil.copy(ROOT / "config.yaml", tmp_path)
    (tmp_path / "studies" / "mine").mkdir(parents=True)
    (tmp_path / "studies" / "mine" / "config.yaml").write_text(snippet)
    monkeypatch.chdir(tmp_path)
    configuration = config.load("config.yaml")
    assert configuration.refused == {} and "mine.hollow" in configuration.experiments


@pytest.fixture(scope="module")
def typed(tmp_path_factory):
    """All that is printed where every command is typed, in its order, and the clone."""
    folder = tmp_path_factory.mktemp("typed")
    first, *rest = commands()
    assert first.startswith(CLONE)
    script = [first.replace("ADDRESS", shlex.quote(str(ROOT)), 1), *rest]
    command, environ = ["bash", "-e", "-c", "\n".join(script)], environment(folder)
    ran = subprocess.run(command, cwd=folder, capture_output=True, text=True, env=environ)
    output = ran.stdout + ran.stderr
    assert ran.returncode == 0, output[-3000:]
    return [line.rstrip() for line in output.splitlines()], folder / "roughgas"


@pytest.mark.slow
def test_all_of_it_typed_in_a_fresh_clone(typed):
    """The README's answers are printed, and git sees no new file."""
    lines, clone = typed
    assert not [line for line in answers() if line.rstrip() not in lines]
    assert all((clone / path).stat().st_size > 1000 for path in PRODUCTS)
    status = subprocess.run(
        ["git", "status", "--porcelain"], cwd=clone, capture_output=True, text=True, check=True
    )
    assert status.stdout.split() == ["??", "studies/mine/"]


def environment(folder):
    """Return the environment of a new user: no paths of this process, no caches but of kernels.

    Their folder is named by a hash of their sources; compiling them again takes a minute.
    """
    removed = ("PYTHONPATH", "VIRTUAL_ENV")
    inherited = {key: value for key, value in os.environ.items() if key not in removed}
    caches = {"XDG_CACHE_HOME": str(folder / "cache"), "ROUGHGAS_CACHE_DIR": str(cache_root())}
    return inherited | caches


def test_the_image_holds_all_that_a_run_consists_of():
    copied = re.findall(r"^COPY (?:--\S+ )?(.+) \S+$", (ROOT / "Dockerfile").read_text(), re.M)
    inside = {name for line in copied for name in line.split()}
    assert all((ROOT / name).exists() for name in inside)
    assert all(name in inside or name.split("/")[0] in inside for name in project_files(ROOT))
