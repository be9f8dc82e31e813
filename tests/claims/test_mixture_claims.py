"""Verdicts on mixtures, with data whose R and temperatures are known."""

import pytest
from synthetic import mixed

from roughgas.claims import evidence, mixtures
from roughgas.claims.verdicts import FAILS, HOLDS, QUALIFIED

HOW = {"r": (0.9,), "beta": (-0.5, 0.0, 0.5, 1.0)}
MASSES = "species.second.mass", (1.0, 4.0)
DEVIATIONS = "species.disks.deviation", (0.0, 0.2)
DISKS = [{"name": "disks", "fraction": 1}]
DISKS[0]["radius"] = {"distribution": "uniform", "deviation": 0.1}


def judged(judge, *gases):
    return judge(*(evidence.beside_theory(gas) for gas in gases))


@pytest.mark.parametrize(
    ("shift", "verdict"), [(0.0, HOLDS), (0.015, HOLDS), (0.04, QUALIFIED), (-0.09, FAILS)]
)
def test_species_of_a_bed_follow_lun(shift, verdict):
    beds = [mixed(f"vibrated_{k}", MASSES, shift, hotter=2.5, **HOW) for k in ("masses", "sizes")]
    found = judged(mixtures.species_follow_lun, *beds)
    assert found.verdict == verdict
    assert found.numbers[0][1].value == pytest.approx(shift, abs=1e-9)


@pytest.mark.parametrize(
    ("shift", "hotter", "verdict"),
    [
        (0.0, 1.0, HOLDS),
        (0.0, 1.08, HOLDS),
        (0.0, 1.3, QUALIFIED),
        (0.0, 1.8, FAILS),
        (0.03, 1.0, QUALIFIED),
        (0.09, 1.0, FAILS),
    ],
)
def test_species_of_a_cooling_gas_follow_theory(shift, hotter, verdict):
    gas = mixed("cooling_masses", MASSES, shift, hotter, **HOW)
    found = judged(mixtures.species_follow_cooling_theory, gas)
    assert found.verdict == verdict
    (ratio,) = (x for name, x in found.numbers if "T_2/T_1" in name)
    assert ratio.value == pytest.approx(hotter - 1, abs=1e-9)


@pytest.mark.parametrize(("change", "verdict"), [(0.0, HOLDS), (0.04, QUALIFIED), (0.09, FAILS)])
def test_spread_radii(change, verdict):
    about = HOW | {"species": DISKS, "error": 1e-5}
    gas = mixed("vibrated_polydisperse", DEVIATIONS, **about)
    gas["R"] = gas.R + change * (gas.deviation > 0)
    assert judged(mixtures.spread_changes_nothing, gas).verdict == verdict


def test_data_without_equal_disks_or_species_test_nothing():
    gas = mixed("vibrated_polydisperse", DEVIATIONS, species=DISKS, **HOW)
    with pytest.raises(evidence.NotTestedError, match="does not hold disks that are alike"):
        judged(mixtures.spread_changes_nothing, gas.sel(deviation=[0.2]))
    with pytest.raises(evidence.NotTestedError, match="holds no species"):
        judged(mixtures.species_follow_lun, gas.drop_vars("R_species"))
