"""Tasks of a study: names, checks, runs, continuation after a kill, combination."""

from pathlib import Path

import pytest
import xarray as xr
from tests.entry import main

from roughgas import config
from roughgas.base import InputError
from roughgas.base.files import code_in
from roughgas.compiling.cache_folders import folder_of_file
from roughgas.config import study_folders
from roughgas.tasks.running import task_names

CONFIG = """
tasks: {experiments: [cooling], seed: 1, lengths: [2, 3]}
scales: {small: {tasks: {lengths: [1]}}}
"""
SCHEMA = """
type: object
additionalProperties: false
required: [seed, lengths]
properties:
  seed: {type: integer, minimum: 0}
  lengths: {type: array, minItems: 1, items: {type: integer, minimum: 1}}
"""
TASKS = """
import numpy as np
import xarray as xr
from .parts import OFFSET

def tasks(settings):
    return [f"length-{n}" for n in settings["lengths"]]

def run(task, settings, experiments, progress, checkpoint):
    if not checkpoint.path.exists():
        checkpoint.path.write_text(checkpoint.owner)
        raise KeyboardInterrupt
    assert checkpoint.path.read_text() == checkpoint.owner and [*experiments] == ["cooling"]
    progress(1, 1)
    return xr.Dataset({"x": ("n", OFFSET + np.arange(int(task.removeprefix("length-"))))})
"""
RESULTS = """
from pathlib import Path
from roughgas.tasks import dataset, read_variables

def combine(parts, settings):
    sums = [float(one.x.sum()) for one in parts.values()]
    return dataset(read_variables(Path(__file__).with_name("variables.yaml")), {"total": sum(sums)})

def table(data):
    return f"## Total\\n\\n{float(data.total):g}\\n"
"""
FILES = {"config.yaml": CONFIG, "schema.yaml": SCHEMA, "tasks.py": TASKS, "results.py": RESULTS}
FILES |= {"parts.py": "OFFSET = 0\n", "variables.yaml": '"":\n  total: sum of all\n'}


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """The folder of a study called mine."""
    monkeypatch.chdir(tmp_path)
    folder = tmp_path / "studies" / "mine"
    folder.mkdir(parents=True)
    for name, text in FILES.items():
        (folder / name).write_text(text)
    return folder


def joined_configuration():
    """Return the configuration of the package, joined with the study."""
    shipped = config.WrittenConfiguration.from_file(config.SHIPPED).configuration("config.yaml")
    return study_folders.with_studies(shipped, ["config.yaml"])


def settings(scale="paper"):
    return study_folders.task_settings(joined_configuration(), "mine", scale)


def run(folder, task, task_settings=None):
    text = (task_settings or settings()).text
    command = ["task", str(folder), task, "--settings", text, "-o", f"{task}.nc"]
    return main(command)


def combine(folder, *tasks):
    paths = [f"{task}.nc" for task in tasks]
    return main(["combine", str(folder), *paths, "-o", "data.nc", "--table", "data.md"])


MODULE = """
import xarray as xr

def tasks(settings):
    return ["only"]

def run(task, settings, experiments, progress):
    progress(1, 1)
    return xr.Dataset({"x": settings["size"]})

def combine(parts, settings):
    return xr.Dataset({"x": parts["only"].x * 2})

def table(data):
    return f"{float(data.x):g}\\n"
"""
FIGURE = """
from matplotlib.figure import Figure

def draw(two):
    assert float(two.x) == 14
    return Figure()
"""


def test_modules_run_their_tasks_and_share_a_dataset(folder, capsys):
    for file in ("tasks.py", "results.py", "schema.yaml"):
        (folder / file).unlink()
    sizes = "tasks: {one: {size: 3}, two: {size: 7}}"
    (folder / "config.yaml").write_text(f"modules: [one, two]\n{sizes}\nfigures: {{mine: [two]}}\n")
    (folder / "figure.py").write_text(FIGURE)
    for module in ("one", "two"):
        (folder / f"{module}.py").write_text(MODULE)
    for module in ("one", "two"):
        text = study_folders.task_settings(joined_configuration(), "mine", "paper", module).text
        options = ["--module", module, "--settings", text, "-o", f"{module}.nc"]
        assert main(["task", str(folder), "only", *options]) == 0
    outputs = ["-o", "data.nc", "--table", "data.md"]
    combined = ["combine", str(folder), "--modules", "one", "two", *outputs]
    assert main([*combined[:2], "one.nc", "two.nc", *combined[2:]]) == 0
    assert Path("data.md").read_text() == "6\n\n14\n"
    figure = ["figure", str(folder), "mine", "data.nc", "--shows", "two", "-o", "mine.png"]
    assert main(figure) == 0
    assert main(["show", "data.nc"]) == 0 and "6\n\n14" in capsys.readouterr().out
    assert main(["show", "one.nc"]) == 0
    assert "snakemake -j1 results/paper/beyond/one/only.nc" in capsys.readouterr().out
    assert main([*combined[:2], "one.nc", *combined[2:]]) == 2
    assert "tasks of two = (nothing): must be given" in capsys.readouterr().err
    options = ["--module", "figure", "--settings", text, "-o", "figure.nc"]
    assert main(["task", str(folder), "only", *options]) == 2
    assert "studies/mine/figure.py = it: must have run()" in capsys.readouterr().err


def test_settings_come_from_the_folder_at_each_scale(folder):
    assert settings().study == {"seed": 1, "lengths": [2, 3]}
    assert settings("small").study == {"seed": 1, "lengths": [1]}
    assert settings("small").experiments["cooling"]["particles"] == 40
    assert joined_configuration().studies["mine"].experiments == []


def test_killed_tasks_are_continued_and_combined(folder, capsys):
    for task in task_names(folder, settings().study):
        assert run(folder, task) == 130
        checkpoint = Path(f"{task}.nc.checkpoint.npz")
        assert checkpoint.exists() and f"goes on from {checkpoint}" in capsys.readouterr().err
        assert run(folder, task) == 0 and not checkpoint.exists()
    assert combine(folder, "length-2", "length-3") == 0
    data = xr.open_datatree("data.nc")["mine"].dataset
    assert float(data.total) == 1 + 3 and data.total.long_name == "sum of all"
    assert Path("data.md").read_text() == "## Total\n\n4\n"
    capsys.readouterr()
    assert combine(folder, "length-2") == 2
    assert "tasks of mine = without length-3: must be complete" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("file", "text", "message"),
    [
        ("config.yaml", CONFIG.replace("seed: 1", "seed: -1"), "seed = -1: must be a whole number"),
        (
            "config.yaml",
            CONFIG.replace("[1]", "[]"),
            "tasks at scale small.lengths = []: must be a",
        ),
        ("config.yaml", CONFIG.replace("cooling", "x"), "tasks.experiments = 'x': must be one of"),
        ("config.yaml", "experiments: {x: {extends: cooling}}", "tasks = (nothing): must be given"),
        ("schema.yaml", "type: 3", "schema.yaml = 3 is not valid"),
        ("schema.yaml", '{$ref: "#/$defs/nothing"}', "must be a JSON schema, with references to"),
    ],
)
def test_a_mistake_in_a_study_excludes_it_with_one_line(folder, file, text, message):
    (folder / file).write_text(text)
    line = str(InputError(*joined_configuration().refused["mine"]))
    assert message in line and line.startswith("studies/mine/") and "\n" not in line


@pytest.mark.parametrize(
    ("code", "message"),
    [
        ("return ['a b']", "name of a task = 'a b': must be of letters, digits"),
        ("return ['a', 'a']", "name of a task = 'a': must be of letters, digits and _+.- alone"),
        ("return settings['x']", "tasks.py = KeyError: 'x': must name its tasks"),
        ("def", "tasks.py = SyntaxError: "),
    ],
)
def test_illegal_names_of_tasks_are_refused_in_one_line(folder, code, message):
    (folder / "tasks.py").write_text(f"def tasks(settings):\n    {code}\n")
    with pytest.raises(InputError, match=r"studies/mine/tasks\.py") as error:
        task_names(folder, settings().study)
    assert message in str(error.value)


def test_unknown_tasks_and_missing_results_py_are_refused(folder, capsys):
    assert run(folder, "length-9") == 2
    assert "task = length-9: must be one of length-2, length-3" in capsys.readouterr().err
    assert run(folder, "length-2", config.TaskSettings({"seed": 1}, {})) == 2
    assert "study.lengths = (nothing): must be given" in capsys.readouterr().err
    (folder / "results.py").unlink()
    line = str(InputError(*joined_configuration().refused["mine"]))
    assert line == "studies/mine/results.py = (nothing): must be there, as config.yaml has tasks"


def test_the_hash_of_a_task_covers_its_file_and_imports(folder):
    hashes_before = code_in(folder, "tasks"), code_in(folder, "results", ["variables.yaml"])
    (folder / "figure.py").write_text("def draw(data): pass\n")
    assert (
        code_in(folder, "tasks"),
        code_in(folder, "results", ["variables.yaml"]),
    ) == hashes_before
    (folder / "parts.py").write_text("OFFSET = 1\n")
    assert code_in(folder, "tasks") != hashes_before[0]
    (folder / "variables.yaml").write_text('"":\n  total: all\n')
    assert code_in(folder, "results", ["variables.yaml"]) != hashes_before[1]


def test_the_cache_folder_depends_on_imported_siblings(folder, monkeypatch):
    monkeypatch.setenv("ROUGHGAS_CACHE_DIR", str(folder / "cache"))
    folder_before = folder_of_file(folder / "tasks.py")
    assert folder_of_file(folder / "tasks.py") == folder_before
    (folder / "parts.py").write_text("OFFSET = 1\n")
    assert folder_of_file(folder / "tasks.py") != folder_before
