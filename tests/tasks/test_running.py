"""Tasks of a study in a folder: named, checked, run, continued after a kill, combined."""

from pathlib import Path

import pytest
import xarray as xr
from tests.entry import main

from roughgas import config
from roughgas.base import InputError
from roughgas.base.files import code_in
from roughgas.compiling.compiler import folder_of
from roughgas.config import study_folders
from roughgas.config.schema import read
from roughgas.tasks.running import names

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
from roughgas.tasks import dataset, variables

def combine(parts, settings):
    sums = [float(one.x.sum()) for one in parts.values()]
    return dataset(variables(Path(__file__).with_name("variables.yaml")), {"total": sum(sums)})

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


def joined():
    """The configuration that comes with the package, and the study."""
    whole, source = read(config.SHIPPED)
    return study_folders.joined(whole, "config.yaml", source)


def settings(scale="paper"):
    return study_folders.tasks(joined(), "mine", scale)


def run(folder, task, found=None):
    text = config.as_text(found or settings())
    command = ["study_task", str(folder), task, "--settings", text, "-o", f"{task}.nc"]
    return main(command)


def combine(folder, *tasks):
    paths = [f"{task}.nc" for task in tasks]
    return main(["study_data", str(folder), *paths, "-o", "data.nc", "--table", "data.md"])


def test_settings_are_those_of_the_folder_at_each_scale(folder):
    assert settings()["study"] == {"seed": 1, "lengths": [2, 3]}
    assert settings("small")["study"] == {"seed": 1, "lengths": [1]}
    assert settings("small")["experiments"]["cooling"]["particles"] == 40
    assert joined()["folders"]["mine"]["experiments"] == []


def test_tasks_are_continued_after_a_kill_and_become_one_dataset_and_a_table(folder, capsys):
    for task in names(folder, settings()["study"]):
        assert run(folder, task) == 130
        left = Path(f"{task}.nc.checkpoint.npz")
        assert left.exists() and f"goes on from {left}" in capsys.readouterr().err
        assert run(folder, task) == 0 and not left.exists()
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
def test_a_mistake_in_its_files_leaves_it_out_in_one_line(folder, file, text, message):
    (folder / file).write_text(text)
    line = str(InputError(*joined()["broken"]["mine"]))
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
def test_tasks_that_cannot_be_named_end_in_one_line(folder, code, message):
    (folder / "tasks.py").write_text(f"def tasks(settings):\n    {code}\n")
    with pytest.raises(InputError, match=r"studies/mine/tasks\.py") as error:
        names(folder, settings()["study"])
    assert message in str(error.value)


def test_an_unknown_task_and_a_missing_results_are_refused(folder, capsys):
    assert run(folder, "length-9") == 2
    assert "task = length-9: must be one of length-2, length-3" in capsys.readouterr().err
    assert run(folder, "length-2", {"study": {"seed": 1}, "experiments": {}}) == 2
    assert "study.lengths = (nothing): must be given" in capsys.readouterr().err
    (folder / "results.py").unlink()
    line = str(InputError(*joined()["broken"]["mine"]))
    assert line == "studies/mine/results.py = (nothing): must be there, as config.yaml has tasks"


def test_the_code_of_a_task_is_its_file_and_what_that_imports(folder):
    before = code_in(folder, "tasks"), code_in(folder, "results", ["variables.yaml"])
    (folder / "figure.py").write_text("def draw(data): pass\n")
    assert (code_in(folder, "tasks"), code_in(folder, "results", ["variables.yaml"])) == before
    (folder / "parts.py").write_text("OFFSET = 1\n")
    assert code_in(folder, "tasks") != before[0]
    (folder / "variables.yaml").write_text('"":\n  total: all\n')
    assert code_in(folder, "results", ["variables.yaml"]) != before[1]


def test_compiled_code_is_not_that_of_a_sibling_that_has_changed(folder, monkeypatch):
    monkeypatch.setenv("ROUGHGAS_CACHE_DIR", str(folder / "cache"))
    before = folder_of(folder / "tasks.py")
    assert folder_of(folder / "tasks.py") == before
    (folder / "parts.py").write_text("OFFSET = 1\n")
    assert folder_of(folder / "tasks.py") != before
