"""roughgas theory, of one species and of mixtures."""

import json

import numpy as np
import pytest

from roughgas import theory
from roughgas.cli import main

PLACE = ("--r=0.9", "--beta=0", "--dimension=2")


def asked(capsys, *arguments):
    assert main(["theory", *arguments]) == 0
    return capsys.readouterr().out


def points(capsys, *arguments):
    return json.loads(asked(capsys, *arguments, "--json"))["points"]


def test_a_point_in_both_dimensions(capsys):
    text = asked(capsys, "--r", "0.9", "--beta", "-0.5")
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


def test_a_curve_is_as_exact_as_its_range_is_written(capsys):
    found = points(capsys, "--r", "0.8", "0.9", "--beta", "-1:1:0.1", "--dimension", "2")
    betas = [float(f"{k / 10}") for k in range(-10, 11)]
    assert [(one["r"], one["beta"]) for one in found] == [(r, b) for r in (0.8, 0.9) for b in betas]
    driven = [one["R_driven"] for one in found[:21]]
    np.testing.assert_allclose(driven, theory.lun_ratio(np.array(betas), 0.5), rtol=1e-14)
    assert found[0]["settled_cooling"] is None  # never, as spin is decoupled there


def test_what_a_drive_and_friction_change(capsys):
    place = ("--r=0.9", "--beta=0.5", "--dimension=2")
    (one,) = points(capsys, *place, "--inertia=0.1", "--spin-share=0.3")
    assert one["R_driven"] == theory.stationary_ratio(0.9, 0.5, 2, 0.1, 0.3)
    assert one["R_cooling"] == theory.stationary_ratio(0.9, 0.5, 2, 0.1)
    assert one["R_driven_sonine"] == theory.sonine_state(0.9, 0.5, 2, 0.1, 0.3).R
    assert one["R_cooling_sonine"] == theory.sonine_state(0.9, 0.5, 2, 0.1).R
    (one,) = points(capsys, *place, "--mu=0.3")
    assert one["R_driven"] == theory.friction_ratio(0.9, 0.5, 0.3, spin_share=0.0)
    assert one["R_cooling"] == theory.friction_ratio(0.9, 0.5, 0.3)
    assert one["mu_c"] == theory.critical_friction(0.9)
    (rough,) = points(capsys, *place, "--mu=inf")
    assert rough["R_driven"] == pytest.approx(theory.lun_ratio(0.5, 0.5), rel=1e-12)
    assert rough["sliding"] == 0.0


GIVEN = "[{fraction: 0.5, name: light}, {fraction: 0.5, radius: 2, mass: 4}]"
SPECIES = [{"fraction": 0.5, "name": "light"}, {"fraction": 0.5, "radius": 2, "mass": 4}]


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
