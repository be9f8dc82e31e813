"""Lists of r, beta and seeds, and settings changed by `--set`."""

import json
import shlex
from pathlib import Path

import pytest

from cli.conftest import GAS
from roughgas.cli import main
from roughgas.data.point import read_point
from roughgas.show import movies

RUN = ["run", "cooling", f"--settings={json.dumps(GAS)}"]


@pytest.fixture(autouse=True)
def folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)


@pytest.mark.parametrize(
    "told",
    [
        "--r 0.9 .8 --beta -.5 .5 --seed 1 2",
        "--r 0.9 --r .8 --beta=-.5 --beta=.5 --seed 1 --seed 2",
        "--r 0.9 .8 --beta -.5:.5:1 --seed 1:2:1",
    ],
)
def test_each_r_is_run_with_each_beta_and_each_seed(told, capsys):
    assert main([*RUN, *told.split(), "--json"]) == 0
    lines = map(json.loads, capsys.readouterr().out.splitlines())
    found = [(one["r"], one["beta"], one["seed"]) for one in lines]
    assert found == [(r, b, s) for r in (0.9, 0.8) for b in (-0.5, 0.5) for s in (1, 2)]
    assert len(list(Path().iterdir())) == 8


def test_a_movie_takes_the_same_lists(monkeypatch):
    drawn = []
    monkeypatch.setattr(movies, "write_movie", lambda _, picture, *__: drawn.append(picture()[0]))
    line = "--r 0.9 .8 --beta .5 --seed 1 2 --frames=2 --set particles=10 -o gas.gif"
    assert main(["movie", *RUN[1:], *line.split()]) == 0
    titles = [part.get_suptitle().partition("\n")[2] for part in drawn[0].subfigs]
    for (r, seed), title in zip([(0.9, 1), (0.9, 2), (0.8, 1), (0.8, 2)], titles, strict=True):
        assert title == rf"$r = {r}$, $\beta = 0.5$, $N = 10$, seed {seed}"


def test_settings_that_are_changed_are_those_of_the_dataset(capsys):
    changes = ["particles=10", "schedule.plateau=4", "effects.friction.mu=.3", "box=18"]
    line = [*RUN, "--r=.9", "--beta=.5", "--set", *changes[:2], "--set", *changes[2:], "--json"]
    assert main(line) == 0
    name = "cooling_particles10_plateau4_mu.3_box18_r.9_beta.5_seed1.nc"
    point = read_point(name)
    settings = json.loads(point.attrs["experiment_json"])
    assert settings["particles"] == 10 and settings["box"] == [18, 18]
    assert settings["schedule"] == GAS["schedule"] | {"plateau": 4}
    assert settings["effects"] == GAS["effects"] | {"friction": {"mu": 0.3}}
    assert point.attrs["particles"] == 10 and point.attrs["mu"] == 0.3
    again = shlex.split(point.attrs["command"])[1:]
    assert main([*again[:-1], "again.nc"]) == 0 and read_point("again.nc").R == point.R
    short = ["friction.mu=.3", "spin.inertia=0.1"]
    assert main([*line[:5], "--set", *short, "-o", "short.nc"]) == 0
    found = json.loads(read_point("short.nc").attrs["experiment_json"])["effects"]
    assert found["friction"] == {"mu": 0.3} and found["spin"] == {"inertia": 0.1}
    assert main(["trajectory", *line[1:5], "--set", changes[0], "--frames=2", "-o=t.xyz"]) == 0
    assert Path("t.xyz").read_text().startswith("10\n")


def test_the_command_alone_is_its_help(capsys):
    with pytest.raises(SystemExit) as stop:
        main([])
    said = capsys.readouterr()
    assert stop.value.code == 0 and said.err == ""
    assert said.out.startswith("usage: roughgas") and "  run " in said.out
