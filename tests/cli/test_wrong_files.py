"""Each command says in one line what kind of file it takes, given any other."""

import os
import shutil

import pytest
from tests.entry import main

TAKEN = {
    "reduce {} -o out.nc": "point",
    "table {} -o out.csv": "reduced",
    "claims {} --json out.json --markdown out.md": "reduced studies",
    "run_times {} -o out.md": "reduced",
    "explore {} --points points -o out.html": "reduced",
    "figure fig1a {} -o out.png": "reduced",
    "accuracy_table {} -o out.md": "studies",
    "accuracy_figure coverage {} -o out.png": "studies",
    "accuracy_data {} -o out.nc": "task",
}
NO_FILE = "must be a file"
NAMED = {
    "point": "a point",
    "reduced": "a reduced dataset",
    "studies": "a dataset of studies",
    "task": "a task of a study",
}


@pytest.fixture
def folder(files, tmp_path, monkeypatch):
    shutil.copytree(files["point"].parent, tmp_path, dirs_exist_ok=True)
    monkeypatch.chdir(tmp_path)
    return tmp_path


def said(capsys, line):
    """What a command that ends with status 2 says, in its one line."""
    before = set(os.listdir("."))
    assert main(line) == 2
    assert set(os.listdir(".")) == before
    (text,) = capsys.readouterr().err.splitlines()
    return text.removeprefix("roughgas: error: ")


@pytest.mark.parametrize("command", TAKEN)
def test_another_kind_of_file_is_refused(folder, capsys, command):
    wanted = TAKEN[command].split()
    legal = " or ".join(NAMED[kind] for kind in wanted)
    for kind in NAMED.keys() - {*wanted}:
        line = command.format(f"{kind}.nc").split()
        assert said(capsys, line) == f"file = {kind}.nc: must be {legal}, not {NAMED[kind]}"


def test_a_crate_is_packed_in_the_project(folder, capsys):
    (folder / "config.yaml").write_text("scale: paper\n")
    line = ["crate", "reduced.nc", "--configuration={}", "-o", "run.zip"]
    assert said(capsys, line) == (
        f"folder = {folder}: must be one with the workflow, such as a clone of it: "
        "CHANGELOG.md is missing"
    )


def test_pipes_and_devices_are_not_waited_for(folder, capsys):
    os.mkfifo("pipe")
    for path in ("pipe", "/dev/zero"):
        assert said(capsys, ["show", path]) == f"file = {path}: {NO_FILE}"
