"""Movies, trajectories and variants from the command line."""

import json
import sys

import pytest
from PIL import Image
from schedules import COOLING, TINY

from roughgas import cli
from roughgas.cli import main
from roughgas.config.reading import read_yaml
from roughgas.data.point import read_point

SMALL = {"particles": 8, "box": [12, 12], "effects": {"spin": {"inertia": 0.5}}}
ALONE = SMALL | {"particles": 1, "schedule": COOLING}


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
    assert said.out == ""  # a slow machine says how far it is, before
    assert said.err.splitlines()[-2:] == [f"{path}: 3 frames" for path in outputs]


def make_trajectory(*outputs, times=("0", "2"), **others):
    told = {"r": "0.9", "beta": "0.5", "settings": json.dumps(SMALL | {"schedule": COOLING})}
    arguments = [f"--{key}={value}" for key, value in (told | others).items()]
    chosen = ["--times", *times] if times else []
    return main(["trajectory", "cooling", *arguments, *chosen, "-o", *map(str, outputs)])


def test_every_file_that_is_asked_for_is_made_and_the_same_each_time(tmp_path, capsys):
    outputs = [tmp_path / "gas.xyz", tmp_path / "gas.nc"]
    assert make_trajectory(*outputs) == 0
    said = capsys.readouterr()
    assert said.out == ""
    assert said.err.splitlines()[-2:] == [f"{path}: 2 frames" for path in outputs]
    before = [path.read_bytes() for path in outputs]
    assert make_trajectory(*outputs) == 0 and [path.read_bytes() for path in outputs] == before
    assert before[0].count(b"Lattice=") == 2


@pytest.mark.parametrize(
    ("made", "choice", "message"),
    [
        (make, {"frames": "1"}, "--frames = 1: must be a whole number in [2, 10000]"),
        (make, {"frames": "many"}, "--frames = many: must be a whole number"),
        (make, {"fps": "0"}, "--fps = 0.0: must lie in [1, 50]"),
        (make, {"length": "0"}, "--length = 0.0: must lie in (0, 1e9]"),
        (make, {"start": "nan"}, "--start = nan: must lie in [0, 1e9]"),
        (make, {"seed": "x"}, "seed = x: must be a whole number"),
        (make, {"r": "2"}, "restitution r = 2: must lie in [0, 1]"),
        (make, {"settings": ALONE}, "particles = 1: must be at least 2"),
        (make, {"file": "gas.avi"}, "gas.avi: must end in .mp4 or .gif"),
        (make_trajectory, {"times": ("2", "1")}, "times = [2.0, 1.0]: must rise"),
        (make_trajectory, {"times": ("x",)}, "--times = x: must be a number"),
        (make_trajectory, {"times": ("-1",)}, "times = -1.0: must lie in [0, 1e9]"),
        (make_trajectory, {"frames": "3"}, "times = [0.0, 2.0]: must rise, and stand without"),
        (make_trajectory, {"times": None, "length": "0"}, "--length = 0.0: must lie in (0, 1e9]"),
        (make_trajectory, {"beta": "2"}, "roughness beta = 2: must lie in [-1, 1]"),
    ],
)
def test_bad_input_is_refused_in_one_line(tmp_path, capsys, made, choice, message):
    others = {key: value for key, value in choice.items() if key != "file"}
    usual = "gas.gif" if made is make else "gas.xyz"
    assert made(tmp_path / choice.get("file", usual), **others) == 2
    said = capsys.readouterr()
    assert said.err.startswith("roughgas: error: ") and message in said.err
    assert said.err.count("\n") == 1 and said.out == "" and list(tmp_path.iterdir()) == []


def test_an_extra_that_lacks_is_named_before_anything_is_simulated(tmp_path, capsys, monkeypatch):
    monkeypatch.setitem(sys.modules, "gsd", None)
    monkeypatch.setitem(sys.modules, "gsd.hoomd", None)
    assert make_trajectory(tmp_path / "gas.xyz", tmp_path / "gas.gsd") == 1
    said = "gsd is not installed: pip install 'roughgas[trajectories]'"
    assert capsys.readouterr().err == f"roughgas: error: {said}\n"
    assert list(tmp_path.iterdir()) == []


SWEEP = {"r": ["0.9"], "beta": ["0"], "seeds": 1, "spin.inertia": ["1", "0.1"]}
PLACE = ("--r=0.9", "--beta=0")


@pytest.fixture
def configuration(tmp_path):
    """A file with an experiment that has a third axis, and one that has none."""
    whole = read_yaml("config.yaml")
    plain = {key: value for key, value in SWEEP.items() if key != "spin.inertia"}
    gases = {"spun": TINY | {"sweep": SWEEP}, "plain": TINY | {"sweep": plain}}
    whole |= {"experiments": gases, "scales": {"paper": {}}}
    (tmp_path / "config.yaml").write_text(json.dumps(whole))
    return f"--config={tmp_path / 'config.yaml'}"


def test_a_variant_is_run_by_its_name(configuration, tmp_path):
    path = tmp_path / "point.nc"
    assert main(["run", "spun/inertia0.30", configuration, *PLACE, "--seed=1", f"-o={path}"]) == 0
    point = read_point(path)
    assert point.attrs["experiment"] == "spun" and point.attrs["variant"] == "inertia0.30"
    assert point.attrs["swept_value"] == point.attrs["inertia"] == 0.3
    other = tmp_path / "plain.nc"
    assert main(["run", "plain", configuration, *PLACE, "--seed=1", f"-o={other}"]) == 0
    assert not {"variant", "swept", "swept_value"} & set(read_point(other).attrs)


SETTINGS = json.dumps(TINY | {"swept": "spin.inertia"})


@pytest.mark.parametrize(
    ("name", "settings", "message"),
    [
        ("spun", None, "experiment = 'spun': must be followed by a variant, such as spun/inertia1"),
        ("plain/inertia1", None, "experiment = 'plain/inertia1': must be plain alone, which has"),
        ("spun/inertia2", None, "spun/inertia2.effects.spin.inertia = 2.0: must be a number in"),
        ("spun", SETTINGS, "experiment = spun: must be the variant that its settings are of"),
        ("spun/inertia1", SETTINGS, "experiment = spun/inertia1: must be the variant that"),
        ("spun/inertia0.5", json.dumps(TINY), "experiment = spun/inertia0.5: must be the variant"),
        ("spun", json.dumps(TINY | {"sweep": SWEEP}), "experiment = 'spun': must be followed by"),
    ],
)
def test_what_is_no_variant_is_refused_in_one_line(
    configuration, tmp_path, capsys, name, settings, message
):
    source = configuration if settings is None else f"--settings={settings}"
    command = ["run", name, source, *PLACE, "--seed=1", "-o", str(tmp_path / "point.nc")]
    assert main(command) == cli.BAD_INPUT
    said = capsys.readouterr().err
    assert said.startswith(f"roughgas: error: {message}") and said.count("\n") == 1
    assert not (tmp_path / "point.nc").exists()
