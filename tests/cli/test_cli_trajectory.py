"""`roughgas trajectory`: files for programs that look at particles, or one line why not."""

import json
import sys

import pytest
from schedules import COOLING

from roughgas.cli import main

SMALL = {"particles": 8, "box": [12, 12], "effects": {"spin": {"inertia": 0.5}}}


def make(*outputs, times=("0", "2"), **others):
    told = {"r": "0.9", "beta": "0.5", "settings": json.dumps(SMALL | {"schedule": COOLING})}
    arguments = [f"--{key}={value}" for key, value in (told | others).items()]
    chosen = ["--times", *times] if times else []
    return main(["trajectory", "cooling", *arguments, *chosen, "-o", *map(str, outputs)])


def test_every_file_that_is_asked_for_is_made_and_the_same_each_time(tmp_path, capsys):
    outputs = [tmp_path / "gas.xyz", tmp_path / "gas.nc"]
    assert make(*outputs) == 0
    said = capsys.readouterr()
    assert said.out == "" and said.err.splitlines() == [f"{path}: 2 frames" for path in outputs]
    before = [path.read_bytes() for path in outputs]
    assert make(*outputs) == 0 and [path.read_bytes() for path in outputs] == before
    assert before[0].count(b"Lattice=") == 2


@pytest.mark.parametrize(
    ("choice", "message"),
    [
        ({"times": ("2", "1")}, "times = [2.0, 1.0]: must rise"),
        ({"times": ("x",)}, "--times = x: must be a number"),
        ({"times": ("-1",)}, "times = -1.0: must lie in [0, 1e9]"),
        ({"frames": "3"}, "times = [0.0, 2.0]: must rise, and stand without start"),
        ({"times": None, "frames": "1"}, "--frames = 1: must be a whole number in [2, 10000]"),
        ({"times": None, "length": "0"}, "--length = 0.0: must lie in (0, 1e9]"),
        ({"beta": "2"}, "roughness beta = 2: must lie in [-1, 1]"),
    ],
)
def test_bad_input_is_refused_in_one_line(tmp_path, capsys, choice, message):
    assert make(tmp_path / "gas.xyz", **choice) == 2
    said = capsys.readouterr()
    assert said.err.startswith(f"roughgas: error: {message}") and said.err.count("\n") == 1
    assert said.out == "" and list(tmp_path.iterdir()) == []


def test_an_extra_that_lacks_is_named_before_anything_is_simulated(tmp_path, capsys, monkeypatch):
    monkeypatch.setitem(sys.modules, "gsd", None)
    monkeypatch.setitem(sys.modules, "gsd.hoomd", None)
    assert make(tmp_path / "gas.xyz", tmp_path / "gas.gsd") == 1
    said = "gsd is not installed: pip install 'roughgas[trajectories]'"
    assert capsys.readouterr().err == f"roughgas: error: {said}\n"
    assert list(tmp_path.iterdir()) == []
