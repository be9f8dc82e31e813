"""Movies, trajectories and variants from the command line."""

import inspect
import json
import sys
import weakref
from contextlib import contextmanager

import numpy as np
import pytest
from PIL import Image
from schedules import COOLING, TINY

from roughgas import cli
from roughgas.base.reading import read_yaml
from roughgas.cli import excerpts, main
from roughgas.data.point import read_point

SMALL = {"particles": 8, "box": [12, 12], "effects": {"spin": {"inertia": 0.5}}}


def make(*outputs, experiment="cooling", settings=SMALL | {"schedule": COOLING}, **options):
    all_options = {"r": "0.9", "beta": "0.5", "frames": "3"} | options
    all_options |= {"settings": json.dumps(settings)} if settings else {}
    arguments = [f"--{key}={value}" for key, value in all_options.items()]
    return main(["movie", experiment, *arguments, "--output", *map(str, outputs)])


@pytest.mark.slow
def test_a_movie_writes_every_output(tmp_path, capsys):
    outputs = [tmp_path / "gas.mp4", tmp_path / "gas.gif"]
    assert make(*outputs, fps="10") == 0
    assert sorted(tmp_path.iterdir()) == sorted(outputs)
    with Image.open(outputs[1]) as image:
        assert image.n_frames == 3 and image.info["duration"] == 100
    output = capsys.readouterr()
    assert output.out == ""  # stderr also has the progress on slow machines
    assert output.err.splitlines()[-2:] == [f"{path}: 3 frames" for path in outputs]


def make_trajectory(*outputs, times=("0", "2"), **options):
    defaults = {"r": "0.9", "beta": "0.5", "settings": json.dumps(SMALL | {"schedule": COOLING})}
    arguments = [f"--{key}={value}" for key, value in (defaults | options).items()]
    time_options = ["--times", *times] if times else []
    return main(["trajectory", "cooling", *arguments, *time_options, "-o", *map(str, outputs)])


@pytest.mark.slow
def test_a_trajectory_writes_every_output_reproducibly(tmp_path, capsys):
    outputs = [tmp_path / "gas.xyz", tmp_path / "gas.nc"]
    assert make_trajectory(*outputs) == 0
    output = capsys.readouterr()
    assert output.out == ""
    assert output.err.splitlines()[-2:] == [f"{path}: 2 frames" for path in outputs]
    first_contents = [path.read_bytes() for path in outputs]
    assert (
        make_trajectory(*outputs) == 0 and [path.read_bytes() for path in outputs] == first_contents
    )
    assert first_contents[0].count(b"Lattice=") == 2


def test_a_long_trajectory_is_written_in_bounded_memory(tmp_path, capsys, monkeypatch):
    """A trajectory too large for a checkpoint: smaller ones keep all frames, to continue from."""
    path, references = tmp_path / "gas.xyz", []
    monkeypatch.setattr("roughgas.simulation.films.LARGEST_CHECKPOINT", 0)
    film = excerpts.film

    def watched(frames):
        for shot in frames:
            references.append(weakref.ref(shot.position))
            assert (
                sum(reference() is not None for reference in references) <= 2
            )  # the present and the previous frame
            yield shot
            del shot
        raise KeyboardInterrupt

    @contextmanager
    def stopped(*arguments):
        with film(*arguments) as frames:
            yield watched(frames)

    monkeypatch.setattr(excerpts, "film", stopped)
    assert make_trajectory(path, times=[*"0123456789"]) == 130
    assert path.read_text().count("Lattice=") == len(references) == 10
    assert capsys.readouterr().err == f"roughgas: stopped: {path}: 10 of 10 frames\n"


def test_gsd_has_double_precision_on_request(tmp_path):
    hoomd = pytest.importorskip("gsd.hoomd")
    if "precision" not in inspect.signature(hoomd.open).parameters:
        pytest.skip("gsd before 5 has single precision alone")
    single, double = tmp_path / "single.gsd", tmp_path / "double.gsd"
    assert make_trajectory(single) == make_trajectory(double, "--double") == 0
    with hoomd.open(single) as rounded, hoomd.open(double) as file:
        for coarse, fine in zip(rounded, file, strict=True):
            assert (coarse.particles.position.dtype, fine.particles.position.dtype) == ("f4", "f8")
            assert np.array_equal(fine.particles.position.astype("f4"), coarse.particles.position)


def test_a_missing_extra_is_named_before_the_simulation(tmp_path, capsys, monkeypatch):
    monkeypatch.setitem(sys.modules, "gsd", None)
    monkeypatch.setitem(sys.modules, "gsd.hoomd", None)
    assert make_trajectory(tmp_path / "gas.xyz", tmp_path / "gas.gsd") == 1
    message = "gsd is not installed: pip install 'roughgas[trajectories]'"
    assert capsys.readouterr().err == f"roughgas: error: {message}\n"
    assert list(tmp_path.iterdir()) == []


SWEEP = {"r": ["0.9"], "beta": ["0"], "seeds": 1, "spin.inertia": ["1", "0.1"]}
POINT_OPTIONS = ("--r=0.9", "--beta=0")


@pytest.fixture
def configuration(tmp_path):
    """The option of a configuration with two experiments: with and without a third axis."""
    raw = read_yaml("config.yaml")
    plain = {key: value for key, value in SWEEP.items() if key != "spin.inertia"}
    gases = {"spun": TINY | {"sweep": SWEEP}, "plain": TINY | {"sweep": plain}}
    raw |= {"experiments": gases, "scales": {"paper": {}}}
    (tmp_path / "config.yaml").write_text(json.dumps(raw))
    return f"--config={tmp_path / 'config.yaml'}"


def test_a_variant_is_run_by_its_name(configuration, tmp_path):
    path = tmp_path / "point.nc"
    assert (
        main(["run", "spun/inertia0.30", configuration, *POINT_OPTIONS, "--seed=1", f"-o={path}"])
        == 0
    )
    point = read_point(path)
    assert point.attrs["experiment"] == "spun" and point.attrs["variant"] == "inertia0.3"
    assert point.attrs["swept_value"] == point.attrs["inertia"] == 0.3
    plain_path = tmp_path / "plain.nc"
    assert (
        main(["run", "plain", configuration, *POINT_OPTIONS, "--seed=1", f"-o={plain_path}"]) == 0
    )
    assert not {"variant", "swept", "swept_value"} & set(read_point(plain_path).attrs)


@pytest.mark.parametrize(
    ("name", "message"),
    [
        ("spun", "experiment = 'spun': must be followed by a variant, such as spun/inertia1"),
        ("plain/inertia1", "experiment = 'plain/inertia1': must be plain alone, which has"),
        ("spun/inertia2", "spun/inertia2.effects.spin.inertia = 2.0: must be a number in"),
    ],
)
def test_an_unknown_variant_is_refused_in_one_line(configuration, tmp_path, capsys, name, message):
    command = [
        "run",
        name,
        configuration,
        *POINT_OPTIONS,
        "--seed=1",
        "-o",
        str(tmp_path / "point.nc"),
    ]
    assert main(command) == cli.BAD_INPUT
    output = capsys.readouterr().err
    assert output.startswith(f"roughgas: error: {message}") and output.count("\n") == 1
    assert not (tmp_path / "point.nc").exists()
