"""Each command refuses files of a wrong kind in one line, which names the legal kinds."""

import os
import shutil

import pytest
from tests.entry import main
from tests.files import COMBINE, DRAW
from tests.study_modules import ROOT

PAPER = ROOT / "studies" / "paper"
LEGAL_KINDS = {
    "reduce {} -o out.nc": "point",
    "table {} -o out.csv": "reduced",
    f"claims {PAPER} {{}} --title a --json out.json --markdown out.md": "reduced studies",
    "run_times {} -o out.md": "reduced",
    "explore {} --points points -o out.html": "reduced",
    f"figure {PAPER} fig1a {{}} --shows vibrated -o out.png": "reduced studies",
    DRAW: "reduced studies",
    COMBINE: "task",
}
NO_FILE = "must be a file"
DESCRIPTIONS = {
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


def refusal_of(capsys, line):
    """Return the error of a command that must end with status 2, print one line, write no file."""
    before = set(os.listdir("."))
    assert main(line) == 2
    assert set(os.listdir(".")) == before
    (text,) = capsys.readouterr().err.splitlines()
    return text.removeprefix("roughgas: error: ")


@pytest.mark.parametrize("command", LEGAL_KINDS)
def test_another_kind_of_file_is_refused(folder, capsys, command):
    legal_kinds = LEGAL_KINDS[command].split()
    legal = " or ".join(DESCRIPTIONS[kind] for kind in legal_kinds)
    for kind in DESCRIPTIONS.keys() - {*legal_kinds}:
        line = command.format(f"{kind}.nc").split()
        assert (
            refusal_of(capsys, line)
            == f"file = {kind}.nc: must be {legal}, not {DESCRIPTIONS[kind]}"
        )


def test_a_crate_needs_the_folder_of_the_project(folder, capsys):
    (folder / "config.yaml").write_text("scale: paper\n")
    line = ["crate", "reduced.nc", "--configuration={}", "-o", "run.zip"]
    assert refusal_of(capsys, line) == (
        f"folder = {folder}: must be one with the workflow, such as a clone of it: "
        "CHANGELOG.md is missing"
    )


def test_pipes_and_devices_are_refused(folder, capsys):
    os.mkfifo("pipe")
    for path in ("pipe", "/dev/zero"):
        assert refusal_of(capsys, ["show", path]) == f"file = {path}: {NO_FILE}"
