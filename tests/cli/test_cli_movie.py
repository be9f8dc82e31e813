"""`roughgas movie`: a movie from a command, or one line that says why there is none."""

import json
from pathlib import Path

import pytest
from brute_force import settings as scene_settings
from PIL import Image
from schedules import COOLING, STEADY

from roughgas.cli import main
from roughgas.show import encoding as movie

SMALL = {"particles": 8, "box": [12, 12], "effects": {"spin": {"inertia": 0.5}}}
CONFIG = str(Path(__file__).parents[2] / "config.yaml")


def make(*outputs, experiment="cooling", settings=SMALL | {"schedule": COOLING}, **others):
    told = {"r": "0.9", "beta": "0.5", "frames": "3"} | others
    told |= {"settings": json.dumps(settings)} if settings else {}
    arguments = [f"--{key}={value}" for key, value in told.items()]
    return main(["movie", experiment, *arguments, "--output", *map(str, outputs)])


def test_every_file_that_is_asked_for_is_made(tmp_path, capsys):
    outputs = [tmp_path / "gas.mp4", tmp_path / "gas.gif"]
    assert make(*outputs, fps="10") == 0
    assert sorted(tmp_path.iterdir()) == sorted(outputs)
    with Image.open(outputs[1]) as image:
        assert image.n_frames == 3 and image.info["duration"] == 100
    said = capsys.readouterr()
    assert said.out == "" and said.err.splitlines() == [f"{path}: 3 frames" for path in outputs]


@pytest.mark.parametrize(
    ("choice", "message"),
    [
        ({"frames": "1"}, "--frames = 1: must be a whole number in [2, 10000]"),
        ({"frames": "many"}, "--frames = many: must be a whole number"),
        ({"fps": "0"}, "--fps = 0.0: must lie in [1, 50]"),
        ({"length": "0"}, "--length = 0.0: must lie in (0, 1e9]"),
        ({"start": "-1"}, "--start = -1.0: must lie in [0, 1e9]"),
        ({"start": "nan"}, "--start = nan: must lie in [0, 1e9]"),
        ({"seed": "x"}, "seed = x: must be a whole number"),
        ({"r": "2"}, "restitution r = 2: must lie in [0, 1]"),
        (
            {"experiment": "coolin", "settings": None, "config": CONFIG},
            "experiment = 'coolin': must be one of cooling",
        ),
        (
            {"settings": SMALL | {"particles": 1, "schedule": COOLING}},
            "particles = 1: must be at least 2",
        ),
    ],
)
def test_bad_input_is_refused_in_one_line(tmp_path, capsys, choice, message):
    assert make(tmp_path / "gas.gif", **choice) == 2
    said = capsys.readouterr()
    assert said.err.startswith(f"roughgas: error: {message}") and said.err.count("\n") == 1
    assert said.out == "" and list(tmp_path.iterdir()) == []


def test_another_kind_of_file_is_refused_before_anything_is_simulated(tmp_path, capsys):
    assert make(tmp_path / "gas.gif", tmp_path / "gas.avi") == 2
    message = f"file = {tmp_path / 'gas.avi'}: must end in .mp4 or .gif\n"
    assert capsys.readouterr().err == f"roughgas: error: {message}"
    assert list(tmp_path.iterdir()) == []


def test_a_collapse_is_told_in_one_line(tmp_path, capsys):
    floor = {"amplitude": 0, "restitution": 0.1}
    bed = scene_settings("bed", 12, [6, "open"], floor=floor) | {"schedule": STEADY}
    assert make(tmp_path / "bed.gif", settings=bed, r="0.1", beta="0", start="100") == 1
    said = capsys.readouterr().err
    assert said.startswith("roughgas: error: inelastic collapse at t =") and said.count("\n") == 1
    assert list(tmp_path.iterdir()) == []


def test_an_interruption_leaves_nothing(tmp_path, capsys, monkeypatch):
    def stop(*_):
        raise KeyboardInterrupt

    monkeypatch.setattr(movie.subprocess.Popen, "communicate", stop)
    assert make(tmp_path / "gas.mp4") == 130
    assert capsys.readouterr().err.startswith("roughgas: stopped: ")
    assert list(tmp_path.iterdir()) == []
