"""Judges of materials, mixtures, averages and studies; the sample of differences."""

import math
from statistics import NormalDist

import numpy as np
import pytest
import xarray as xr
from synthetic import averaged, couette, mixed, reduced, viscoelastic
from tests.claims.gases import KICKS, boundaries, constant, swept
from tests.houses import part, statements

from roughgas.claims import evidence, examine
from roughgas.claims.evidence import (
    FAILS,
    HOLDS,
    NOT_TESTED,
    QUALIFIED,
    Sample,
    beside_theory,
    text,
)
from roughgas.data.point import Point, write_point
from roughgas.data.reduced import read_reduced
from roughgas.results.reduce import reduce_points
from roughgas.statistics.errors import Estimate

materials = part("viscoelastic", "judges")


def judged(judge, *gases):
    return judge(*(evidence.beside_theory(gas) for gas in gases))


mixtures, figure = (part("mixtures", name) for name in ("judges", "figure"))
HOW = {"r": (0.9,), "beta": (-0.5, 0.0, 0.5, 1.0)}
MASSES = "species.second.mass", (1.0, 4.0)
DEVIATIONS = "species.disks.deviation", (0.0, 0.2)
DISKS = [{"name": "disks", "fraction": 1}]
DISKS[0]["radius"] = {"distribution": "uniform", "deviation": 0.1}


def between_walls(shift):
    return couette(shift), reduced("sheared", r=(0.9,), error=1e-6)


def beds(shift):
    return [mixed(f"vibrated_{k}", MASSES, shift, hotter=2.5, **HOW) for k in ("masses", "sizes")]


def cooling(shift=0.0, hotter=0.0):
    return [mixed("cooling_masses", MASSES, shift, 1.0 + hotter, **HOW)]


def spread(change):
    gas = mixed("vibrated_polydisperse", DEVIATIONS, species=DISKS, error=1e-5, **HOW)
    return [gas.assign(R=gas.R + change * (gas.deviation > 0))]


CASES = {  # judge, gases off by some size, what the number of that size is called, if it is one
    "exponent": (materials.viscoelastic_exponent, lambda x: [viscoelastic(exponent=5 / 3 + x)], ""),
    "restitution": (materials.follows_present_restitution, lambda x: [viscoelastic(shift=x)], ""),
    "couette": (part("couette", "judges").couette_is_lees_edwards, between_walls, ""),
    "bed": (mixtures.species_follow_lun, beds, ""),
    "cooling": (mixtures.species_follow_cooling_theory, cooling, None),
    "hotter": (mixtures.species_follow_cooling_theory, lambda x: cooling(hotter=x), "T_2/T_1"),
    "spread": (mixtures.spread_changes_nothing, spread, None),
}
SIZES = dict.fromkeys(CASES, (0.0, 0.04, -0.09)) | {"cooling": (0.0, 0.03, 0.09)}
SIZES |= {"exponent": (-0.06, 0.18, 0.33), "bed": (0.015, 0.04, -0.09), "hotter": (0.08, 0.3, 0.8)}


@pytest.mark.parametrize("name", CASES)
def test_a_verdict_depends_on_the_size_of_a_deviation(name):
    """The exponent of time is judged at smooth disks alone: at beta = 0 it is another one."""
    judge, made, label = CASES[name]
    for size, verdict in zip(SIZES[name], (HOLDS, QUALIFIED, FAILS), strict=True):
        found = judged(judge, *made(size))
        assert found.verdict == verdict
        if label is not None:
            number = next(x for called, x in found.numbers if label in called)
            assert number.value == pytest.approx(size, abs=1e-9)


def test_other_gases_test_nothing():
    with pytest.raises(evidence.NotTestedError, match="how the energy falls"):
        judged(materials.viscoelastic_exponent, reduced("cooling"))
    with pytest.raises(evidence.NotTestedError, match="how the energy falls"):
        judged(materials.follows_present_restitution, reduced("cooling"))


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
    gas = beside_theory(read_reduced(tmp_path / "cooling_masses.nc"))
    error = np.std(ratios, ddof=1) / 2
    first, second = mixtures._of_theory(gas, "T_tr").values.ravel()
    assert mixtures.temperature_ratio(gas).stderr == pytest.approx([error * first / second])
    axes = figure.draw_cooling(gas, gas).axes[0]
    (low, high) = axes.containers[0][2][0].get_segments()[0][:, 1]
    assert (low + high) / 2 == pytest.approx(np.mean(ratios))
    assert (high - low) / 2 == pytest.approx(error)


def bed(excess=0.04, experiment="vibrated", **contacts):
    """A bed whose mean of R(t) is `excess` above Lun's formula at r = 0.8 and beta = 0."""
    data = reduced(experiment, lambda r, beta: excess * (1 - r) / 0.2 * (1 - beta**2))
    return averaged(data, **contacts)


@pytest.mark.parametrize(
    ("left", "verdict"), [(0.0, HOLDS), (0.08, QUALIFIED), (1.0, FAILS), (-0.8, FAILS)]
)
def test_lun_over_collisions(judged, left, verdict):
    assert judged("lun_over_collisions", bed(left=left)).verdict == verdict


BETA = np.array([-0.5, 0.0, 0.5])


def sample(value, stderr, dof):
    places = {"r": np.full(3, 0.9), "beta": BETA, "wave": np.array(["sine", "triangle", "sine"])}
    return Sample(places, *(np.array(column, float) for column in (value, stderr, dof)))


def test_mean_and_largest():
    """The degrees of freedom of the mean are those of Welch and Satterthwaite."""
    found = sample([0.1, -0.3, 0.2], [1, 2, 2], [12, 4, 8])
    dof = 9**2 / (1 / 12 + 16 / 4 + 16 / 8)
    assert found.mean() == pytest.approx((0.0, 1.0, dof))
    largest, place = found.largest()
    assert largest == (-0.3, 2.0, 4) and place == "r = 0.9, beta = 0, wave = triangle"
    assert found.where(BETA > 0).place(0) == "r = 0.9, beta = 0.5, wave = sine"
    twice = found.joined(found)
    assert twice.size == 6 and twice.place(5) == found.place(2)


def test_significance_depends_on_the_degrees_of_freedom():
    """Four seeds alone need ten standard errors for three sigma."""
    found = sample([0.05, 0.05, 0.05], [0.01, 0.01, math.nan], [3, 100, 100])
    assert found.off(0.02).tolist() == [False, True, False]
    assert found.vague(0.02).tolist() == [True, False, True]
    assert not found.off(0.06).any() and not found.vague(0.06).any()


@pytest.mark.parametrize(
    ("number", "words"),
    [
        ((0.02713, 0.00039, 1), "+0.02713, 95 % +0.02027 to +0.03399 (2.4 sigma)"),
        ((0.02713, 0.00039, 1000), "+0.02713, 95 % +0.02636 to +0.02790 (> 20 sigma)"),
        ((-0.012, 0.004), "-0.0120, 95 % -0.0198 to -0.0042 (3.0 sigma)"),
        ((0.012, math.nan), "+0.0120 (error unknown)"),
        ((0.012, 0.004, 0), "+0.0120 ± 0.0040"),
    ],
)
def test_numbers_stand_with_the_interval_that_fits_their_sigma(number, words):
    assert text(Estimate(*number)) == words


@pytest.mark.parametrize("dof", [1, 3, 30, math.inf])
def test_sigma_exceeds_196_exactly_if_the_interval_leaves_out_zero(dof):
    for ratio in np.geomspace(1.0, 50.0, 40):
        number = Estimate(ratio, 1.0, dof)
        assert (number.sigma > NormalDist().inv_cdf(0.975)) == (number.ci95 < ratio)


STATEMENTS = statements()
DRIVES = ("floor_materials", "wall_materials", "shaken_walls")


def judged_study(name, **studies):
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
    found = judged_study("shear_gives_the_excess", profiles=sheared(share))
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
    found = judged_study("sooner_the_larger", runaway=escapes(*exponents))
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
    found = judged_study("one_curve_for_all_drives", **known)
    assert found.verdict == verdict
    if size:
        assert found.numbers[0][0] == "wall_materials: largest difference"
    without = known | {"heated": known["heated"].drop_vars("R_collisional")}
    assert judged_study("one_curve_for_all_drives", **without).verdict == NOT_TESTED
