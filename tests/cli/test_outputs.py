"""Commands overwrite only their own earlier outputs."""

import json
import shutil
from pathlib import Path

import pytest

from cli.conftest import GAS
from roughgas.cli import main

RUN = ["run", "cooling", f"--settings={json.dumps(GAS)}", "--r", "0.9"]
RUN_POINT = [*RUN, "--beta", "0.5"]
POINT, REDUCED = "beta0.5_1.nc", "reduced.nc"


@pytest.fixture
def folder(product, tmp_path, monkeypatch):
    shutil.copytree(product, tmp_path, dirs_exist_ok=True)
    monkeypatch.chdir(tmp_path)
    Path("notes.md").write_text("# Notes\n\nof a person\n")
    Path("notes.csv").write_text("a,b\n")
    return tmp_path


def contents_of_files():
    return {path: path.read_bytes() for path in Path().rglob("*") if path.is_file()}


@pytest.mark.parametrize(
    ("line", "message"),
    [
        (
            [*RUN_POINT, "--seed", "1", "2", "-o", "a.nc", "a.nc"],
            "--output = a.nc: must be named once",
        ),
        (
            [*RUN_POINT, "--seed", "1", "2", "-o", "a.nc", "./a.nc"],
            "--output = a.nc: must be named once",
        ),
        ([*RUN_POINT, "--seed", "1", "1"], "--seed = 1: must be given once"),
        ([*RUN_POINT, "--seed", "1", "--seed", "01"], "--seed = 01: must be given once"),
        ([*RUN, "--beta", ".5", "0.50"], "--beta = 0.50: must be given once"),
        ([*RUN_POINT, "--r", ".9"], "--r = .9: must be given once"),
        (
            [*RUN_POINT, "-o", "config.yaml"],
            "--output = config.yaml: must be another file than those",
        ),
        (
            [*RUN_POINT, "--config", "other.yaml", "-o", "config.yaml"],
            "must be new, or hold a point: it",
        ),
        (
            [*RUN_POINT, "-o", REDUCED],
            f"--output = {REDUCED}: must be new, or hold a point: it holds so",
        ),
        (
            [*RUN_POINT, "--from", POINT, "-o", POINT],
            "must be another file than those that are read",
        ),
        (
            [*RUN_POINT, "-o", "nowhere/a.nc"],
            "--output = nowhere/a.nc: must lie in a folder that exists",
        ),
        ([*RUN_POINT, "-o", "."], "--output = .: must be a file, and is a folder"),
        (["reduce", POINT, "-o", POINT], "must be another file than those that are read"),
        (["reduce", "beta0.5_2.nc", "-o", POINT], "must be new, or hold a reduced dataset"),
        (["plot", REDUCED, "-o", "a.png", "a.png"], "--output = a.png: must be named once"),
        (RUN_POINT, "must be new, or hold a point"),  # nor may a default name replace it
    ],
    ids=lambda value: " ".join(value[-4:]) if isinstance(value, list) else "",
)
def test_foreign_files_are_not_overwritten(folder, capsys, line, message):
    shutil.copy("config.yaml", "other.yaml")
    shutil.copy(POINT, "notes.nc")
    Path("cooling_r0.9_beta0.5_seed1.nc").write_text("of a person")
    contents_before = contents_of_files()
    assert main(line) == 2
    (line_of_error,) = capsys.readouterr().err.splitlines()
    assert line_of_error.startswith("roughgas: error: ") and message in line_of_error
    assert contents_of_files() == contents_before


def test_an_unwritable_output_is_refused_before_any_work(folder, capsys):
    assert main([*RUN_POINT, "--seed", "1", "2", "-o", "a.nc", "/proc/none"]) == 1
    assert capsys.readouterr().err == "roughgas: error: /proc/none: cannot be written\n"
    assert not Path("a.nc").exists()


@pytest.mark.parametrize(
    "line",
    [
        [*RUN_POINT, "-o", "a.nc"],
        ["reduce", POINT, "-o", "a.nc"],
        pytest.param(["plot", REDUCED, "-o", "a.png", "a.pdf"], marks=pytest.mark.slow),
        ["trajectory", *RUN_POINT[1:], "--frames=2", "-o", "a.xyz", "a.nc"],
    ],
    ids=lambda line: line[0],
)
def test_a_command_replaces_its_earlier_outputs(folder, line):
    assert main(line) == main(line) == 0
    for output in list(Path().glob("a.*")):
        output.write_bytes(b"")  # as mktemp does
    assert main(line) == 0 and {path.stat().st_size > 0 for path in Path().glob("a.*")} == {True}
