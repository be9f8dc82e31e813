"""What commands write replaces nothing but their own earlier product."""

import json
import shutil
from pathlib import Path

import pytest

from cli.conftest import GAS
from roughgas.cli import main

RUN = ["run", "cooling", f"--settings={json.dumps(GAS)}", "--r", "0.9"]
ONE = [*RUN, "--beta", "0.5"]
POINT, REDUCED = "beta0.5_1.nc", "reduced.nc"


@pytest.fixture
def folder(product, tmp_path, monkeypatch):
    shutil.copytree(product, tmp_path, dirs_exist_ok=True)
    monkeypatch.chdir(tmp_path)
    Path("notes.md").write_text("# Notes\n\nof a person\n")
    Path("notes.csv").write_text("a,b\n")
    return tmp_path


def contents():
    return {path: path.read_bytes() for path in Path().rglob("*") if path.is_file()}


@pytest.mark.parametrize(
    ("line", "said"),
    [
        ([*ONE, "--seed", "1", "2", "-o", "a.nc", "a.nc"], "--output = a.nc: must be named once"),
        ([*ONE, "--seed", "1", "2", "-o", "a.nc", "./a.nc"], "--output = a.nc: must be named once"),
        ([*ONE, "--seed", "1", "1"], "--seed = 1: must be given once"),
        ([*ONE, "--seed", "1", "--seed", "01"], "--seed = 01: must be given once"),
        ([*RUN, "--beta", ".5", "0.50"], "--beta = 0.50: must be given once"),
        ([*ONE, "--r", ".9"], "--r = .9: must be given once"),
        ([*ONE, "-o", "config.yaml"], "--output = config.yaml: must be another file than those"),
        ([*ONE, "--config", "other.yaml", "-o", "config.yaml"], "must be new, or hold a point: it"),
        ([*ONE, "-o", REDUCED], f"--output = {REDUCED}: must be new, or hold a point: it holds so"),
        ([*ONE, "--from", POINT, "-o", POINT], "must be another file than those that are read"),
        ([*ONE, "-o", "nowhere/a.nc"], "--output = nowhere/a.nc: must lie in a folder that exists"),
        ([*ONE, "-o", "."], "--output = .: must be a file, and is a folder"),
        (["reduce", POINT, "-o", POINT], "must be another file than those that are read"),
        (["reduce", "beta0.5_2.nc", "-o", POINT], "must be new, or hold a reduced dataset"),
        (["plot", REDUCED, "-o", "a.png", "a.png"], "--output = a.png: must be named once"),
        (ONE, "must be new, or hold a point"),  # a name of its own is no excuse
    ],
    ids=lambda value: " ".join(value[-4:]) if isinstance(value, list) else "",
)
def test_nothing_is_overwritten_without_a_word(folder, capsys, line, said):
    shutil.copy("config.yaml", "other.yaml")
    shutil.copy(POINT, "notes.nc")
    Path("cooling_r0.9_beta0.5_seed1.nc").write_text("of a person")
    before = contents()
    assert main(line) == 2
    (found,) = capsys.readouterr().err.splitlines()
    assert found.startswith("roughgas: error: ") and said in found
    assert contents() == before


def test_where_nothing_can_be_written_is_seen_before_any_work(folder, capsys):
    assert main([*ONE, "--seed", "1", "2", "-o", "a.nc", "/proc/none"]) == 1
    assert capsys.readouterr().err == "roughgas: error: /proc/none: cannot be written\n"
    assert not Path("a.nc").exists()


@pytest.mark.parametrize(
    "line",
    [
        [*ONE, "-o", "a.nc"],
        ["reduce", POINT, "-o", "a.nc"],
        ["plot", REDUCED, "-o", "a.png", "a.pdf"],
        ["trajectory", *ONE[1:], "--frames=2", "-o", "a.xyz", "a.nc"],
    ],
    ids=lambda line: line[0],
)
def test_a_command_replaces_what_it_has_made(folder, line):
    assert main(line) == main(line) == 0
    for made in list(Path().glob("a.*")):
        made.write_bytes(b"")  # as mktemp does
    assert main(line) == 0 and {path.stat().st_size > 0 for path in Path().glob("a.*")} == {True}
