"""Verdicts on mixtures, with data whose R and temperatures are known."""

import numpy as np
import pytest
from synthetic import mixed
from tests.houses import part

from roughgas.claims import evidence
from roughgas.claims.verdicts import FAILS, HOLDS, QUALIFIED
from roughgas.data.point import Point, write_point
from roughgas.results.reduce import reduce_points

mixtures, figure = (part("mixtures", name) for name in ("judges", "figure"))
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


def test_a_decay_that_species_share_is_no_error_of_their_ratio(tmp_path):
    """Whoever shows or judges T_2/T_1 has the scatter of the ratio, not of energies that decay."""
    ratios, decays, paths = [1.654, 1.656, 1.664, 1.677], [1.0, 0.3, 2.1, 0.6], []
    about = mixed("cooling_masses", MASSES, **HOW).attrs | {"r": 0.9, "beta": 0.0}
    for seed, (ratio, decay) in enumerate(zip(ratios, decays, strict=True), 1):
        known = {"R": 0.3, "R_stderr": 0.01, "R_dof": 30.0, "R_ci95": 0.02, "R_ratio_of_means": 0.3}
        known |= {"E_trans": decay, "E_rot": decay, "collisions": 100, "kernel_seconds": 0.5}
        known |= {"equilibrated": 1, "measured_from": 3.0, "species": ["first", "second"]}
        known |= {"R_species": np.array([0.3, 0.3])}
        known |= {"E_trans_species": decay * np.array([1.0, ratio])}
        known |= {"R_series": np.full(9, 0.3), "collisions_per_particle": np.arange(9.0)}
        paths.append(tmp_path / f"seed{seed}.nc")
        place = {"seed": seed, "swept_value": 4.0}
        write_point(paths[-1], Point(known, about | place))
    reduce_points(paths, tmp_path / "cooling_masses.nc")
    gas = evidence.load(tmp_path / "cooling_masses.nc")
    error = np.std(ratios, ddof=1) / 2
    first, second = mixtures._of_theory(gas, "T_tr").values.ravel()
    assert mixtures.temperature_ratio(gas).stderr == pytest.approx([error * first / second])
    axes = figure.draw_cooling(gas, gas).axes[0]
    (low, high) = axes.containers[0][2][0].get_segments()[0][:, 1]
    assert (low + high) / 2 == pytest.approx(np.mean(ratios))
    assert (high - low) / 2 == pytest.approx(error)
