"""Movies, trajectories and variants from the command line."""

import json
import sys
import weakref

import pytest
from PIL import Image
from schedules import COOLING, TINY

from roughgas import cli
from roughgas.cli import main, products
from roughgas.config.reading import read_yaml
from roughgas.data.point import read_point

SMALL = {"particles": 8, "box": [12, 12], "effects": {"spin": {"inertia": 0.5}}}


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


def test_a_trajectory_is_written_as_it_goes_on_in_bounded_memory(tmp_path, capsys, monkeypatch):
    path, alive = tmp_path / "gas.xyz", []
    taken = products.snapshots

    def stopped(*given):
        for shot in taken(*given):
            alive.append(weakref.ref(shot.position))
            assert sum(one() is not None for one in alive) <= 2  # this one, and the one before
            yield shot
            del shot
        raise KeyboardInterrupt

    monkeypatch.setattr(products, "snapshots", stopped)
    assert make_trajectory(path, times=[*"0123456789"]) == 130
    assert path.read_text().count("Lattice=") == len(alive) == 10
    assert capsys.readouterr().err == f"roughgas: stopped: {path}: 10 of 10 frames\n"


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


@pytest.mark.parametrize(
    ("name", "message"),
    [
        ("spun", "experiment = 'spun': must be followed by a variant, such as spun/inertia1"),
        ("plain/inertia1", "experiment = 'plain/inertia1': must be plain alone, which has"),
        ("spun/inertia2", "spun/inertia2.effects.spin.inertia = 2.0: must be a number in"),
    ],
)
def test_what_is_no_variant_is_refused_in_one_line(configuration, tmp_path, capsys, name, message):
    command = ["run", name, configuration, *PLACE, "--seed=1", "-o", str(tmp_path / "point.nc")]
    assert main(command) == cli.BAD_INPUT
    said = capsys.readouterr().err
    assert said.startswith(f"roughgas: error: {message}") and said.count("\n") == 1
    assert not (tmp_path / "point.nc").exists()
