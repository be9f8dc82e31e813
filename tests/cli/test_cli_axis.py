"""Variants of an experiment on the command line."""

import json

import pytest
from schedules import TINY

from roughgas import cli
from roughgas.cli import main
from roughgas.config.reading import read_yaml
from roughgas.data.point import read_point

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
def test_bad_input_is_refused_in_one_line(configuration, tmp_path, capsys, name, settings, message):
    source = configuration if settings is None else f"--settings={settings}"
    command = ["run", name, source, *PLACE, "--seed=1", "-o", str(tmp_path / "point.nc")]
    assert main(command) == cli.BAD_INPUT
    said = capsys.readouterr().err
    assert said.startswith(f"roughgas: error: {message}") and said.count("\n") == 1
    assert not (tmp_path / "point.nc").exists()
