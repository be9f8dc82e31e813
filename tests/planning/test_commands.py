"""`roughgas pilot`, `reach`, `plan` and `costs`."""

import json

import numpy as np
import pytest
from tests.planning.conftest import SHEARED

from roughgas.cli import main
from roughgas.config.reading import read_yaml
from roughgas.data.point import read_point
from roughgas.data.reduced import read_reduced
from roughgas.planning.plan import explore
from roughgas.results.costs import cost, saved
from roughgas.results.reduce import reduce_points

SWEEP = {"r": ["0.9"], "beta": ["0", "0.5"]}


@pytest.fixture(scope="module")
def reached(tmp_path_factory):
    """A reduced dataset of two points that were run to a target, and the folder they are in."""
    tmp_path = tmp_path_factory.mktemp("reached")
    for beta in SWEEP["beta"]:
        pilot = tmp_path / f"pilot{beta}.json"
        about = ["sheared", "--r=0.9", f"--beta={beta}", "--settings", json.dumps(SHEARED)]
        assert main(["pilot", *about, "-o", str(pilot)]) == 0
        command = ["reach", *about, "--pilot", str(pilot), "-o", str(tmp_path / f"seeds{beta}")]
        assert main(command) == 0
    reduce_points(tmp_path.glob("seeds*"), tmp_path / "sheared.nc")
    return read_reduced(tmp_path / "sheared.nc"), tmp_path


def test_a_point_is_run_to_its_target(reached, sheared):
    data, folder = reached
    assert (data.R_stderr <= sheared["target_stderr"]).all()
    assert (data.n_seeds >= data.planned_seeds).all()
    assert len(list((folder / "seeds0").iterdir())) == data.n_seeds.sel(beta=0).item()


def test_a_seed_of_it_is_made_again_by_its_own_command(reached, sheared, tmp_path):
    _, folder = reached
    first = read_point(folder / "seeds0" / "seed1.nc")
    settings = first.attrs["experiment_json"]
    again = tmp_path / "again.nc"
    about = ["--r=0.9", "--beta=0", "--seed=1", "-o", str(again)]
    for text in (settings, json.dumps(sheared)):  # with its lengths, and from the target anew
        assert main(["run", "sheared", "--settings", text, *about]) == 0
        assert read_point(again).R.item() == first.R.item()


def test_costs_are_what_the_datasets_say(reached):
    data, folder = reached
    found = cost(data)
    assert found.points == found.met == 2
    assert found.seeds[1] == data.n_seeds.sum() and found.seconds[1] == data.kernel_seconds.sum()
    # as long as they were run anyway, and measured by the same share
    every = (data.measured_from + data.measured_for).values
    share = (data.measured_for / every).values
    one = data.isel(beta=[0])
    schedule = {
        "equilibrate": every[0, 0] * (1 - share[0, 0]),
        "measure": every[0, 0] * share[0, 0],
    }
    assert saved(one, schedule)[0] == pytest.approx(1)
    fixed = json.dumps({"sheared": {"kind": "steady", "equilibrate": 2000, "measure": 5000}})
    output = folder / "costs.md"
    command = ["costs", str(folder / "sheared.nc"), "--fixed", fixed, "-o", str(output)]
    assert main(command) == 0
    text = output.read_text()
    assert "| sheared | 2 | 0.01 | 2 |" in text and "| sheared | 7000 T |" in text


def test_a_plan_is_printed_before_anything_is_run(sheared, tmp_path, capsys):
    fixed = {"kind": "steady", "sample_every": 1, "equilibrate": 100, "measure": 900}
    plain = {key: value for key, value in sheared.items() if key != "target_stderr"}
    experiments = {
        "sheared": sheared | {"sweep": SWEEP},
        "fixed": plain | {"schedule": fixed, "sweep": SWEEP | {"seeds": 3}},
    }
    config = read_yaml("config.yaml")
    config |= {"experiments": experiments, "scales": {"paper": {}}}
    (tmp_path / "config.yaml").write_text(json.dumps(config))
    command = ["plan", "--config", str(tmp_path / "config.yaml"), "--cores", "4"]
    command += ["--pilots", str(tmp_path / "pilots"), "-o", str(tmp_path / "plan.md")]
    assert main(command) == 0
    said = capsys.readouterr().out
    assert said == (tmp_path / "plan.md").read_text()
    rows = {
        line.split("|")[1].strip(): line.split("|") for line in said.splitlines() if "|" in line
    }
    assert rows["sheared"][2].strip() == "0.01" and rows["fixed"][2].strip() == ""
    assert rows["fixed"][4].strip() == "6" and rows["in all"][3].strip() == "4"
    assert "on 4 cores" in said
    assert len(list((tmp_path / "pilots").rglob("pilot.json"))) == 4
    assert main(command) == 0  # the pilots are there, and taken
    numbers = [line for line in capsys.readouterr().out.splitlines() if "sheared" in line]
    assert numbers[0].split("|")[:8] == rows["sheared"][:8]
    assert np.isfinite(float(rows["fixed"][5]))


def test_an_interrupted_plan_says_that_it_will_go_on(sheared, tmp_path, capsys, monkeypatch):
    experiment = sheared | {"sweep": SWEEP}
    config = read_yaml("config.yaml") | {
        "experiments": {"sheared": experiment},
        "scales": {"paper": {}},
    }
    (tmp_path / "config.yaml").write_text(json.dumps(config))
    pilots, done = tmp_path / "pilots", []

    def explored(scene, settings):
        if done:
            raise KeyboardInterrupt
        done.append(explore(scene, settings))
        return done[0]

    monkeypatch.setattr("roughgas.cli.planning.explore", explored)
    command = ["plan", "--config", str(tmp_path / "config.yaml"), "--pilots", str(pilots)]
    assert main(command) == 130
    said = capsys.readouterr()
    expected = f"pilots that are done are kept in {pilots}: the same command goes on from there"
    assert said.err == f"roughgas: stopped: {expected}\n" and said.out == ""
    assert len(list(pilots.rglob("pilot.json"))) == 1
    monkeypatch.setattr("roughgas.cli.planning.explore", lambda *_: done[0])
    assert main(command) == 0 and len(list(pilots.rglob("pilot.json"))) == 2


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["reach", "cooling", "--r=0.9", "--beta=0", "-o", "x"], "target_stderr = (nothing): must"),
        (["plan", "--cores", "none"], "--cores = none: must be a whole number >= 1"),
        (["plan", "flying"], "experiment = 'flying': must be one of"),
        (["pilot", "cooling", "--r=2", "--beta=0", "-o", "x"], "restitution r = 2: must lie in"),
    ],
)
def test_bad_input_is_refused_in_one_line(arguments, message, capsys):
    assert main(arguments) == 2
    said = capsys.readouterr().err
    assert said.startswith(f"roughgas: error: {message}") and said.count("\n") == 1
