"""`roughgas theory`: gases of a single species, and mixtures."""

import json

import numpy as np
import pytest

from roughgas import theory
from roughgas.cli import main

POINT_OPTIONS = ("--r=0.9", "--beta=0", "--dimension=2")


def output_of(capsys, *arguments):
    assert main(["theory", *arguments]) == 0
    return capsys.readouterr().out


def points(capsys, *arguments):
    return json.loads(output_of(capsys, *arguments, "--json"))["points"]


def test_a_point_has_both_dimensions(capsys):
    text = output_of(capsys, "--r", "0.9", "--beta", "-0.5")
    flat, solid = points(capsys, "--r", "0.9", "--beta", "-0.5")
    assert flat["R_driven"] == pytest.approx(theory.lun_ratio(-0.5, 0.5), rel=1e-14)
    assert solid["R_driven"] == pytest.approx(theory.lun_ratio(-0.5, 0.4), rel=1e-14)
    assert flat["R_cooling"] == pytest.approx(theory.cooling_ratio(0.9, -0.5), rel=1e-14)
    assert solid["R_cooling"] == pytest.approx(theory.goldshtein_ratio(0.9, -0.5), rel=1e-14)
    assert solid["rate_cooling"] == theory.relaxation_rate(0.9, -0.5, 3)
    assert flat["settled_driven"] == theory.collisions_to_relax(0.9, -0.5, spin_share=0.0)
    row = next(line for line in text.splitlines() if line.startswith("R, cooling"))
    assert f"{flat['R_cooling']:.5g}" in row and f"{solid['R_cooling']:.5g}" in row
    assert row.endswith("  theory of free cooling")


def test_points_of_a_range_are_exact_decimals(capsys):
    records = points(capsys, "--r", "0.8", "0.9", "--beta", "-1:1:0.1", "--dimension", "2")
    betas = [float(f"{k / 10}") for k in range(-10, 11)]
    assert [(record["r"], record["beta"]) for record in records] == [
        (r, b) for r in (0.8, 0.9) for b in betas
    ]
    driven = [record["R_driven"] for record in records[:21]]
    np.testing.assert_allclose(driven, theory.lun_ratio(np.array(betas), 0.5), rtol=1e-14)
    assert records[0]["settled_cooling"] is None  # infinite, as spin is decoupled there


def test_drive_and_friction_change_the_equations(capsys):
    options = ("--r=0.9", "--beta=0.5", "--dimension=2")
    (record,) = points(capsys, *options, "--inertia=0.1", "--spin-share=0.3")
    assert record["R_driven"] == theory.stationary_ratio(0.9, 0.5, 2, 0.1, 0.3)
    assert record["R_cooling"] == theory.stationary_ratio(0.9, 0.5, 2, 0.1)
    assert record["R_driven_sonine"] == theory.sonine_state(0.9, 0.5, 2, 0.1, 0.3).R
    assert record["R_cooling_sonine"] == theory.sonine_state(0.9, 0.5, 2, 0.1).R
    (record,) = points(capsys, *options, "--mu=0.3")
    assert record["R_driven"] == theory.friction_ratio(0.9, 0.5, 0.3, spin_share=0.0)
    assert record["R_cooling"] == theory.friction_ratio(0.9, 0.5, 0.3)
    assert record["mu_c"] == theory.critical_friction(0.9)
    (rough,) = points(capsys, *options, "--mu=inf")
    assert rough["R_driven"] == pytest.approx(theory.lun_ratio(0.5, 0.5), rel=1e-12)
    assert rough["sliding"] == 0.0


SPECIES_TEXT = "[{fraction: 0.5, name: light}, {fraction: 0.5, radius: 2, mass: 4}]"
SPECIES = [{"fraction": 0.5, "name": "light"}, {"fraction": 0.5, "radius": 2, "mass": 4}]


def test_a_mixture_has_the_numbers_of_the_library(capsys):
    (record,) = points(capsys, *POINT_OPTIONS, "--species", SPECIES_TEXT, "--packing=0.1")
    gas = theory.mixture(SPECIES, 0.9, 0.0)
    cooling = theory.mixture_cooling(gas, 0.1)
    driven = theory.mixture_driven(gas, theory.kick_power(gas), 0.1)
    for drive, state in (("cooling", cooling), ("driven", driven)):
        assert record[f"R_{drive}"] == pytest.approx(state.overall_ratio(gas), rel=1e-12)
        for k, name in enumerate(("light", "2")):
            assert record[f"R_{drive}_{name}"] == pytest.approx(state.R[k], rel=1e-12)
            assert record[f"T_{drive}_{name}"] == pytest.approx(state.T_tr[k], rel=1e-12)
    assert record["decay"] == pytest.approx(theory.mixture_decay_rate(gas, 0.1), rel=1e-12)
