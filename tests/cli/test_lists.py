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
    "options",
    [
        "--r 0.9 .8 --beta -.5 .5 --seed 1 2",
        "--r 0.9 --r .8 --beta=-.5 --beta=.5 --seed 1 --seed 2",
        "--r 0.9 .8 --beta -.5:.5:1 --seed 1:2:1",
    ],
)
def test_each_r_is_run_with_each_beta_and_each_seed(options, capsys):
    assert main([*RUN, *options.split(), "--json"]) == 0
    lines = map(json.loads, capsys.readouterr().out.splitlines())
    coordinates = [(record["r"], record["beta"], record["seed"]) for record in lines]
    assert coordinates == [(r, b, s) for r in (0.9, 0.8) for b in (-0.5, 0.5) for s in (1, 2)]
    assert len(list(Path().iterdir())) == 8


@pytest.mark.parametrize(
    ("options", "name"),
    [
        ("--r .9 --beta -.5 --seed 1", "r0.9_beta-0.5_seed1"),
        ("--r 9e-1 --beta -5E-1 --seed 01", "r0.9_beta-0.5_seed1"),
        ("--r 0.90 --beta +0.5 --seed 1", "r0.9_beta0.5_seed1"),
        ("--r 1.0 --beta -0.0 --seed 1", "r1_beta0_seed1"),
        ("--r 1. --beta -1:-1:1 --seed 1", "r1_beta-1_seed1"),
        ("--r 0.50:0.5:0.1 --beta 1e-5 --seed 1", "r0.5_beta0.00001_seed1"),
    ],
)
def test_spellings_of_a_point_give_the_same_name_and_labels(options, name):
    assert main([*RUN, *options.split()]) == 0
    (file,) = Path().iterdir()
    assert file.name == f"cooling_{name}.nc"
    attributes = read_point(file).attrs
    assert (
        f"r{attributes['r_label']}_beta{attributes['beta_label']}_seed{attributes['seed']}" == name
    )
    r, beta, seed = (word.strip("rbetasd") for word in name.split("_"))
    assert attributes["title"] == f"cooling: r = {r}, beta = {beta}"
    assert all(
        f"--{option}" in attributes["command"]
        for option in (f"r={r}", f"beta={beta}", f"seed={seed}")
    )


def test_spellings_of_a_variant_give_the_same_name():
    sweep = {"r": ["0.9"], "beta": ["0"], "seeds": 1, "spin.inertia": ["0.50"]}
    Path("config.yaml").write_text(json.dumps({"experiments": {"gas": GAS | {"sweep": sweep}}}))
    assert main(["run", "gas/inertia.50", "--r=.9", "--beta=0"]) == 0
    assert read_point("gas_inertia0.5_r0.9_beta0_seed1.nc").attrs["variant"] == "inertia0.5"


@pytest.mark.slow  # compiles a kernel of its own
def test_a_movie_takes_the_same_lists(monkeypatch):
    figures = []
    monkeypatch.setattr(movies, "write_movie", lambda _, picture, *__: figures.append(picture()[0]))
    line = "--r 0.9 .8 --beta .5 --seed 1 2 --frames=2 --set particles=10 -o gas.gif"
    assert main(["movie", *RUN[1:], *line.split()]) == 0
    titles = [subfigure.get_suptitle().partition("\n")[2] for subfigure in figures[0].subfigs]
    for (r, seed), title in zip([(0.9, 1), (0.9, 2), (0.8, 1), (0.8, 2)], titles, strict=True):
        assert title == rf"$r = {r}$, $\beta = 0.5$, $N = 10$, seed {seed}"


@pytest.mark.slow
def test_changed_settings_are_in_the_dataset(capsys):
    changes = ["particles=10", "schedule.plateau=4", "effects.friction.mu=.3", "box=18"]
    line = [*RUN, "--r=.9", "--beta=.5", "--set", *changes[:2], "--set", *changes[2:], "--json"]
    assert main(line) == 0
    name = "cooling_particles10_plateau4_mu.3_box18_r0.9_beta0.5_seed1.nc"
    point = read_point(name)
    settings = json.loads(point.attrs["experiment_json"])
    assert settings["particles"] == 10 and settings["box"] == [18, 18]
    assert settings["schedule"] == GAS["schedule"] | {"plateau": 4}
    assert settings["effects"] == GAS["effects"] | {"friction": {"mu": 0.3}}
    assert point.attrs["particles"] == 10 and point.attrs["mu"] == 0.3
    command = shlex.split(point.attrs["command"])[1:]
    assert main([*command[:-1], "again.nc"]) == 0 and read_point("again.nc").R == point.R
    abbreviated = ["friction.mu=.3", "spin.inertia=0.1"]
    assert main([*line[:5], "--set", *abbreviated, "-o", "short.nc"]) == 0
    effects = json.loads(read_point("short.nc").attrs["experiment_json"])["effects"]
    assert effects["friction"] == {"mu": 0.3} and effects["spin"] == {"inertia": 0.1}
    assert main(["trajectory", *line[1:5], "--set", changes[0], "--frames=2", "-o=t.xyz"]) == 0
    assert Path("t.xyz").read_text().startswith("10\n")


@pytest.mark.parametrize(
    ("pattern", "names"),
    [
        pytest.param("cooling", {"cooling"}, marks=pytest.mark.slow),
        pytest.param(
            "vibrated_*_walls",
            {f"vibrated_{kind}_walls" for kind in ("rough", "particle", "smooth")},
            marks=pytest.mark.slow,
        ),
        ("*.cooling_[fi]*", {"friction.cooling_friction", "inertia.cooling_inertia"}),
        pytest.param("s?eared", {"sheared"}, marks=pytest.mark.slow),
    ],
)
def test_a_pattern_chooses_experiments_by_their_names(pattern, names, capsys):
    assert main(["experiments", pattern, "--json"]) == 0
    assert {*json.loads(capsys.readouterr().out)} == names
    assert main(["experiments", pattern]) == 0
    output = capsys.readouterr().out
    assert {line for line in output.splitlines() if line and line[0] != " "} == names


def test_without_a_pattern_all_experiments_are_listed(capsys):
    assert main(["experiments", "--json"]) == 0
    output = capsys.readouterr().out
    assert main(["experiments", "*", "--json"]) == 0
    assert capsys.readouterr().out == output and len(json.loads(output)) > 50


def test_without_arguments_help_is_printed(capsys):
    with pytest.raises(SystemExit) as stop:
        main([])
    output = capsys.readouterr()
    assert stop.value.code == 0 and output.err == ""
    assert output.out.startswith("usage: roughgas") and "  run " in output.out
