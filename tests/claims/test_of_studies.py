"""Statements that studies decide, on studies of which the answer is known."""

import math

import numpy as np
import pytest
import xarray as xr
from tests.claims.gases import KICKS, boundaries, constant, swept
from tests.houses import statements

from roughgas.claims.evidence import beside_theory
from roughgas.claims.statements import examine
from roughgas.claims.verdicts import FAILS, HOLDS, NOT_TESTED, QUALIFIED

STATEMENTS = statements()
DRIVES = ("floor_materials", "wall_materials", "shaken_walls")


def judged(name, **studies):
    return examine(STATEMENTS[name], studies)


def sheared(share, error=0.001, runs=4):
    """Three sheared gases with `share` of the excess that theory expects, and a bed."""
    expected = np.array([0.005, 0.05, 0.1])
    lun = np.array([1 / 3, 0.5, 0.2])
    theta = lun / (1 - lun) * (1 + share * expected)
    columns = {
        "theta": [*theta, math.nan],
        "theta_stderr": [*(error * lun / (1 - lun)), math.nan],
        "factor": [*(1 + expected), math.nan],
        "factor_stderr": [*(0.1 * expected * (error > 0)), math.nan],
        "R_lun": [*lun, 0.2],
    }
    about = {"title": "profiles", "scale": "small", "runs": runs}
    return xr.Dataset({name: ("point", one) for name, one in columns.items()}, attrs=about)


@pytest.mark.parametrize(
    ("share", "verdict"),
    [(1.0, HOLDS), (0.93, HOLDS), (0.75, QUALIFIED), (1.3, QUALIFIED), (0.4, FAILS), (2.0, FAILS)],
)
def test_the_excess_of_a_sheared_gas(share, verdict):
    found = judged("shear_gives_the_excess", profiles=sheared(share))
    assert found.verdict == verdict and "Over 3 gases" in found.reason
    assert found.numbers[0][1].value == pytest.approx(share - 1)
    assert dict(found.numbers)["expected"].value == pytest.approx(0.155)


def escapes(*exponents, error=0.1):
    """Times of escape that go as such powers of N, at a mu each; of the last N nothing is known."""
    numbers, mu = np.array([100, 1000, 10000]), np.arange(1, len(exponents) + 1) / 10
    time = 1000 * (numbers / 100) ** np.array(exponents)[:, None]
    time[:, -1] = math.nan
    columns = {}
    for kind in ("dsmc", "events"):
        parts = {"time": time, "time_stderr": error * time, "escapes": np.where(time > 0, 12, 0)}
        columns |= {
            f"{kind}_{name}": (("mu", f"{kind}_particles"), one) for name, one in parts.items()
        }
        columns[f"{kind}_particles"] = numbers
    about = {"title": "runaway", "scale": "small"}
    return xr.Dataset(columns, {"mu": mu}, about)


@pytest.mark.parametrize(
    ("exponents", "verdict"),
    [((-0.3, -1.0), HOLDS), ((-0.05, -1.0), QUALIFIED), ((0.5, -1.0), FAILS)],
    ids=["falls", "in part", "rises"],
)
def test_the_larger_the_gas_the_sooner(exponents, verdict):
    found = judged("sooner_the_larger", runaway=escapes(*exponents))
    assert found.verdict == verdict and "of 4 cases" in found.reason
    label, flattest = found.numbers[0]
    assert "mu = 0.1" in label and flattest.value == pytest.approx(exponents[0])
    assert flattest.stderr == pytest.approx(0.1 * math.sqrt(2) / math.log(10))


def collisional(data, shift=0.0):
    """A gas whose mean of R(t) is off, but not R averaged over collisions, or that by `shift`."""
    values = {"R_collisional": data.R + shift, "R_collisional_stderr": data.R_stderr}
    return data.assign(values | {"R_collisional_dof": data.R_dof, "R": data.R + 0.1})


@pytest.mark.parametrize(("size", "verdict"), [(0.0, HOLDS), (0.03, QUALIFIED), (0.1, FAILS)])
def test_one_curve_for_all_drives_is_judged_by_the_worst(size, verdict):
    gases = {name: collisional(boundaries(name), size * (name == DRIVES[1])) for name in DRIVES}
    shares = np.array(KICKS[1])[:, None, None]
    kicked = swept("heated", KICKS, constant(0.0), input_spin_share=shares)
    gases["heated"] = collisional(kicked.assign(input_spin_share_stderr=kicked.R_stderr))
    known = {name: beside_theory(data) for name, data in gases.items()}
    found = judged("one_curve_for_all_drives", **known)
    assert found.verdict == verdict
    if size:
        assert found.numbers[0][0] == "wall_materials: largest difference"
    without = known | {"heated": known["heated"].drop_vars("R_collisional")}
    assert judged("one_curve_for_all_drives", **without).verdict == NOT_TESTED
