"""Each command says in one line what kind of file it takes, given any other."""

import json
import os
import shutil

import netCDF4
import pytest
from tests.entry import main

TAKEN = {
    "reduce {} -o out.nc": "point",
    "table {} -o out.csv": "reduced",
    "claims {} --json out.json --markdown out.md": "reduced studies",
    "run_times {} -o out.md": "reduced",
    "explore {} --points points -o out.html": "reduced",
    "figure fig1a {} -o out.png": "reduced",
    "study_tables {} -o out.md": "studies",
    "figure coverage {} -o out.png": "studies",
    "combine {} -o out.nc": "task",
    "film {} -o out.png": "film",
}
NO_FILE = "must be a file"
NAMED = {
    "point": "a point",
    "reduced": "a reduced dataset",
    "film": "a film of a cooling gas",
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


@pytest.mark.parametrize("value", [[1, 2], "two", 99, 1.5])
@pytest.mark.parametrize("kind", NAMED)
def test_a_schema_of_somebody_else_is_refused(folder, capsys, kind, value):
    with netCDF4.Dataset(f"{kind}.nc", "a") as file:
        file.schema_version = value
    assert said(capsys, ["show", f"{kind}.nc"]).startswith(f"schema_version of {kind}.nc = ")


def test_a_page_needs_the_labels_of_points(folder, capsys):
    line = "explore reduced.nc --points . -o out.html".split()
    (folder / "vibrated").mkdir()
    (folder / "points/saw0.9_1.nc").rename(folder / "vibrated/seed1.nc")
    assert said(capsys, line) == "attribute r_label of vibrated/seed1.nc = (nothing): must be given"


def test_a_crate_is_packed_in_the_project(folder, capsys):
    (folder / "config.yaml").write_text("scale: paper\n")
    line = ["crate", "reduced.nc", "--configuration={}", "-o", "run.zip"]
    assert said(capsys, line) == (
        f"folder = {folder}: must be one with the workflow, such as a clone of it: "
        "CHANGELOG.md is missing"
    )


def test_names_are_utf_8(folder, capsys):
    name = os.fsdecode(b"\xff.nc")
    assert said(capsys, ["show", name]) == r"argument = '\udcff.nc': must be text in UTF-8"


def test_pipes_and_devices_are_not_waited_for(folder, capsys):
    os.mkfifo("pipe")
    for path in ("pipe", "/dev/zero"):
        assert said(capsys, ["show", path]) == f"file = {path}: {NO_FILE}"


def test_what_another_program_has_changed_is_blamed_on_it(folder, capsys):
    with netCDF4.Dataset("film.nc", "a") as file:
        file.settings_json = json.dumps({"particles": 3, "box": [8, 8], "effects": {"spin": 3}})
        file.setncatts({"packing": 0.1, "r": 0.9, "beta": 0.0, "seed": 1, "command": ""})
    text = said(capsys, ["show", "film.nc"])
    assert text.startswith("file = film.nc: must hold what roughgas writes, as it wrote it: ")


def test_a_film_without_its_window_is_not_drawn(folder, capsys):
    text = said(capsys, ["film", "film.nc", "-o", "out.png"])
    assert text == "attribute window of film.nc = (nothing): must be given"
