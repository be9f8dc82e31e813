"""`roughgas theory --species`: a mixture, given as in config.yaml."""

import json

import pytest

from roughgas import theory
from roughgas.cli import main

GIVEN = "[{fraction: 0.5, name: light}, {fraction: 0.5, radius: 2, mass: 4}]"
SPECIES = [{"fraction": 0.5, "name": "light"}, {"fraction": 0.5, "radius": 2, "mass": 4}]
PLACE = ("--r=0.9", "--beta=0", "--dimension=2")


def asked(capsys, *arguments):
    assert main(["theory", *arguments]) == 0
    return capsys.readouterr().out


def points(capsys, *arguments):
    return json.loads(asked(capsys, *arguments, "--json"))["points"]


def test_it_is_what_the_functions_say(capsys):
    (found,) = points(capsys, *PLACE, "--species", GIVEN, "--packing=0.1")
    gas = theory.mixture(SPECIES, 0.9, 0.0)
    cooling = theory.mixture_cooling(gas, 0.1)
    driven = theory.mixture_driven(gas, theory.kick_power(gas), 0.1)
    for way, state in (("cooling", cooling), ("driven", driven)):
        assert found[f"R_{way}"] == pytest.approx(state.overall_ratio(gas), rel=1e-12)
        for k, name in enumerate(("light", "2")):
            assert found[f"R_{way}_{name}"] == pytest.approx(state.R[k], rel=1e-12)
            assert found[f"T_{way}_{name}"] == pytest.approx(state.T_tr[k], rel=1e-12)
    assert found["decay"] == pytest.approx(theory.mixture_decay_rate(gas, 0.1), rel=1e-12)


def test_a_file_of_species_and_a_curve(capsys, tmp_path):
    path = tmp_path / "mine.yaml"
    path.write_text(f"species: {GIVEN}\n")
    curve = points(capsys, *PLACE[:1], "--beta", "-0.5:0.5:0.5", "--species", str(path))
    assert len(curve) == 6  # of disks and of spheres
    (one,) = points(capsys, *PLACE, "--species", GIVEN)
    assert curve[1] == one


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["--species=[{fraction: 0.5}]"], "species.fraction = 0.5 in all: must add up to 1"),
        (["--species=[{fraction: 1, size: 2}]"], "species = size: must be one of fraction,"),
        (["--species=[{fraction: 1"], "--species: line 1 = "),
        (["--species=[1]"], "species = 1: must be a list of species, each with"),
        (["--packing=0.1"], "--packing needs --species"),
        (["--species=[{number: 3}]", "--packing=2"], "--packing = 2.0: must lie in [0, 1)"),
    ],
)
def test_bad_species_are_refused_in_one_line(capsys, arguments, message):
    assert main(["theory", *PLACE, *arguments]) == 2
    said = capsys.readouterr()
    assert said.out == "" and said.err.count("\n") == 1
    assert said.err.startswith(f"roughgas: error: {message}")
