"""Judges of materials, mixtures, averages and studies; samples of differences."""

import math
from statistics import NormalDist

import numpy as np
import pytest
import xarray as xr
from synthetic import averaged, couette, mixed, reduced, viscoelastic
from tests.claims.gases import KICKS, boundaries, constant, swept
from tests.study_modules import module_of_study, statements

from roughgas.claims import Fixed, examine, verdicts
from roughgas.claims.verdicts import (
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
from roughgas.statistics.estimates import POWER, Estimate

materials = module_of_study("viscoelastic", "judges")


def judged(judge, *gases):
    return judge(*(verdicts.beside_theory(gas) for gas in gases))


mixtures, figure = (module_of_study("mixtures", name) for name in ("judges", "figure"))
POINTS = {"r": (0.9,), "beta": (-0.5, 0.0, 0.5, 1.0)}
MASSES = "species.second.mass", (1.0, 4.0)
DEVIATIONS = "species.disks.deviation", (0.0, 0.2)
DISKS = [{"name": "disks", "fraction": 1}]
DISKS[0]["radius"] = {"distribution": "uniform", "deviation": 0.1}


def between_walls(shift):
    return couette(shift), reduced("sheared", r=(0.9,), error=1e-6)


def beds(shift):
    return [
        mixed(f"vibrated_{k}", MASSES, shift, hotter=2.5, **POINTS) for k in ("masses", "sizes")
    ]


def cooling(shift=0.0, hotter=0.0):
    return [mixed("cooling_masses", MASSES, shift, 1.0 + hotter, **POINTS)]


def spread(change):
    gas = mixed("vibrated_polydisperse", DEVIATIONS, species=DISKS, error=1e-5, **POINTS)
    return [gas.assign(R=gas.R + change * (gas.deviation > 0))]


CASES = {  # judge, gases with a deviation of some size, label of that number in the finding
    "exponent": (materials.viscoelastic_exponent, lambda x: [viscoelastic(exponent=5 / 3 + x)], ""),
    "restitution": (materials.follows_present_restitution, lambda x: [viscoelastic(shift=x)], ""),
    "couette": (module_of_study("couette", "judges").couette_is_lees_edwards, between_walls, ""),
    "bed": (mixtures.species_follow_lun, beds, ""),
    "cooling": (mixtures.species_follow_cooling_theory, cooling, None),
    "hotter": (mixtures.species_follow_cooling_theory, lambda x: cooling(hotter=x), "T_2/T_1"),
    "spread": (mixtures.spread_changes_nothing, spread, None),
}
SIZES = dict.fromkeys(CASES, (0.0, 0.04, -0.09)) | {"cooling": (0.0, 0.03, 0.09)}
SIZES |= {"exponent": (-0.06, 0.18, 0.33), "bed": (0.015, 0.04, -0.09), "hotter": (0.08, 0.3, 0.8)}


@pytest.mark.parametrize("name", CASES)
def test_a_verdict_depends_on_the_size_of_a_deviation(name):
    """The exponent of time is judged at smooth disks alone: beta = 0 has another exponent."""
    judge, gases, label = CASES[name]
    for size, verdict in zip(SIZES[name], (HOLDS, QUALIFIED, FAILS), strict=True):
        finding = judged(judge, *gases(size))
        assert finding.verdict == verdict
        if label is not None:
            number = next(x for called, x in finding.numbers if label in called)
            assert number.value == pytest.approx(size, abs=1e-9)


def test_other_gases_are_not_tested():
    with pytest.raises(verdicts.NotTestedError, match="how the energy falls"):
        judged(materials.viscoelastic_exponent, reduced("cooling"))
    with pytest.raises(verdicts.NotTestedError, match="how the energy falls"):
        judged(materials.follows_present_restitution, reduced("cooling"))


def test_data_without_equal_disks_or_species_are_not_tested():
    gas = mixed("vibrated_polydisperse", DEVIATIONS, species=DISKS, **POINTS)
    with pytest.raises(verdicts.NotTestedError, match="does not hold disks that are alike"):
        judged(mixtures.spread_changes_nothing, gas.sel(deviation=[0.2]))
    with pytest.raises(verdicts.NotTestedError, match="holds no species"):
        judged(mixtures.species_follow_lun, gas.drop_vars("R_species"))


def test_a_decay_that_species_share_is_no_error_of_their_ratio(tmp_path):
    """Figures and judges of T_2/T_1 use the scatter of the ratio, not of energies that decay."""
    ratios, decays, paths = [1.654, 1.656, 1.664, 1.677], [1.0, 0.3, 2.1, 0.6], []
    attributes = mixed("cooling_masses", MASSES, **POINTS).attrs | {"r": 0.9, "beta": 0.0}
    for seed, (ratio, decay) in enumerate(zip(ratios, decays, strict=True), 1):
        variables = {
            "R": 0.3,
            "R_stderr": 0.01,
            "R_dof": 30.0,
            "R_ci95": 0.02,
            "R_ratio_of_means": 0.3,
        }
        variables |= {"E_trans": decay, "E_rot": decay, "collisions": 100, "kernel_seconds": 0.5}
        variables |= {"equilibrated": 1, "measured_from": 3.0, "species": ["first", "second"]}
        variables |= {"R_species": np.array([0.3, 0.3])}
        variables |= {"E_trans_species": decay * np.array([1.0, ratio])}
        variables |= {"R_series": np.full(9, 0.3), "collisions_per_particle": np.arange(9.0)}
        paths.append(tmp_path / f"seed{seed}.nc")
        coordinates = {"seed": seed, "swept_value": 4.0}
        write_point(paths[-1], Point(variables, attributes | coordinates))
    reduce_points(paths, tmp_path / "cooling_masses.nc")
    gas = beside_theory(read_reduced(tmp_path / "cooling_masses.nc"))
    error = np.std(ratios, ddof=1) / 2
    first, second = mixtures._theory_of_species(gas, "T_tr").values.ravel()
    assert mixtures.temperature_ratio(gas).stderr == pytest.approx([error * first / second])
    axes = figure.draw_cooling(gas, gas).axes[0]
    (low, high) = axes.containers[0][2][0].get_segments()[0][:, 1]
    assert (low + high) / 2 == pytest.approx(np.mean(ratios))
    assert (high - low) / 2 == pytest.approx(error)


def bed(excess=0.04, experiment="vibrated", **contacts):
    """Return a bed whose mean of R(t) is `excess` above Lun's formula at r = 0.8 and beta = 0."""
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
    """The degrees of freedom of the mean follow Welch and Satterthwaite."""
    differences = sample([0.1, -0.3, 0.2], [1, 2, 2], [12, 4, 8])
    dof = 9**2 / (1 / 12 + 16 / 4 + 16 / 8)
    assert differences.mean() == pytest.approx((0.0, 1.0, dof))
    largest, location = differences.largest()
    assert largest == (-0.3, 2.0, 4) and location == "r = 0.9, beta = 0, wave = triangle"
    assert differences.where(BETA > 0).point_text(0) == "r = 0.9, beta = 0.5, wave = sine"
    twice = differences.joined(differences)
    assert twice.size == 6 and twice.point_text(5) == differences.point_text(2)


def test_significance_depends_on_the_degrees_of_freedom():
    """Four seeds alone need ten standard errors for three sigma."""
    differences = sample([0.05, 0.05, 0.05], [0.01, 0.01, math.nan], [3, 100, 100])
    assert differences.off(0.02).tolist() == [False, True, False]
    assert differences.vague(0.02).tolist() == [True, False, True]
    assert not differences.off(0.06).any() and not differences.vague(0.06).any()


@pytest.mark.parametrize(
    ("number", "words"),
    [
        ((0.02713, 0.00039, 1), "+0.02713, 95 % +0.02217 to +0.03209 (2.6 sigma)"),
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
    """Return three sheared gases with `share` of the excess expected by theory, and a bed."""
    expected = np.array([0.005, 0.05, 0.1])
    lun = np.array([1 / 3, 0.5, 0.2])
    theta = lun / (1 - lun) * (1 + share * expected)
    columns = {
        "theta": [*theta, math.nan],
        "theta_stderr": [*(error * lun / (1 - lun)), math.nan],
        "factor": [*(1 + expected), math.nan],
        "factor_stderr": [*(0.05 * expected * (error > 0)), math.nan],
        "R_lun": [*lun, 0.2],
    }
    attributes = {"title": "profiles", "scale": "small", "runs": runs}
    return xr.Dataset(
        {name: ("point", column) for name, column in columns.items()}, attrs=attributes
    )


@pytest.mark.parametrize(
    ("share", "verdict"),
    [(1.0, HOLDS), (0.93, HOLDS), (0.75, QUALIFIED), (1.3, QUALIFIED), (0.4, FAILS), (2.0, FAILS)],
)
def test_the_excess_of_a_sheared_gas(share, verdict):
    finding = judged_study("shear_gives_the_excess", profiles=sheared(share))
    assert finding.verdict == verdict and "Over 3 gases" in finding.reason
    assert finding.numbers[0][1].value == pytest.approx(share - 1)
    assert dict(finding.numbers)["expected"].value == pytest.approx(0.155)


def escapes(*exponents, error=0.1):
    """Return times of escape proportional to powers of N, one exponent per mu; the last N is
    unknown."""
    numbers, mu = np.array([100, 1000, 10000]), np.arange(1, len(exponents) + 1) / 10
    time = 1000 * (numbers / 100) ** np.array(exponents)[:, None]
    time[:, -1] = math.nan
    columns = {}
    for kind in ("dsmc", "events"):
        values = {"time": time, "time_stderr": error * time, "escapes": np.where(time > 0, 12, 0)}
        columns |= {
            f"{kind}_{name}": (("mu", f"{kind}_particles"), column)
            for name, column in values.items()
        }
        columns[f"{kind}_particles"] = numbers
    attributes = {"title": "runaway", "scale": "small"}
    return xr.Dataset(columns, {"mu": mu}, attributes)


@pytest.mark.parametrize(
    ("exponents", "verdict"),
    [((-0.3, -1.0), HOLDS), ((-0.05, -1.0), QUALIFIED), ((0.5, -1.0), FAILS)],
    ids=["falls", "in part", "rises"],
)
def test_the_larger_the_gas_the_sooner(exponents, verdict):
    finding = judged_study("sooner_the_larger", runaway=escapes(*exponents))
    assert finding.verdict == verdict and "of 4 cases" in finding.reason
    label, flattest = finding.numbers[0]
    assert "mu = 0.1" in label and flattest.value == pytest.approx(exponents[0])
    assert flattest.stderr == pytest.approx(0.1 * math.sqrt(2) / math.log(10))


def collisional(data, shift=0.0):
    """Return a gas whose mean of R(t) is off; R averaged over collisions is off by `shift`."""
    values = {"R_collisional": data.R + shift, "R_collisional_stderr": data.R_stderr}
    return data.assign(values | {"R_collisional_dof": data.R_dof, "R": data.R + 0.1})


@pytest.mark.parametrize(("size", "verdict"), [(0.0, HOLDS), (0.03, QUALIFIED), (0.1, FAILS)])
def test_one_curve_for_all_drives_is_judged_by_the_worst(size, verdict):
    gases = {name: collisional(boundaries(name), size * (name == DRIVES[1])) for name in DRIVES}
    shares = np.array(KICKS[1])[:, None, None]
    kicked = swept("heated", KICKS, constant(0.0), input_spin_share=shares)
    gases["heated"] = collisional(kicked.assign(input_spin_share_stderr=kicked.R_stderr))
    datasets = {name: beside_theory(data) for name, data in gases.items()}
    finding = judged_study("one_curve_for_all_drives", **datasets)
    assert finding.verdict == verdict
    if size:
        assert finding.numbers[0][0] == "wall_materials: largest difference"
    without = datasets | {"heated": datasets["heated"].drop_vars("R_collisional")}
    assert judged_study("one_curve_for_all_drives", **without).verdict == NOT_TESTED


# ---------------------------------------------------------------- power


def agreeing(stderr, dof=np.inf, value=0.0):
    """Return three differences with equal values and errors."""
    return sample([value] * 3, [stderr] * 3, [dof] * 3)


def test_a_test_that_could_not_have_failed_tests_nothing():
    """Errors that hide a deviation of DISAGREE, or are unknown, agree with anything."""
    detectable = agreeing(1.0).at(0).detectable
    just, hidden = 0.99 * verdicts.DISAGREE / detectable, 1.01 * verdicts.DISAGREE / detectable
    finding = verdicts.agreement(agreeing(just), "0")
    assert finding.verdict == HOLDS and finding.detectable == pytest.approx(0.0594)
    for differences, reason in (
        (agreeing(hidden), "hide deviations up to 0.061, and 0.06 refutes"),
        (agreeing(just, dof=3.0), "hide deviations"),
        (agreeing(math.nan), "its errors are unknown"),
    ):
        with pytest.raises(verdicts.NotTestedError, match=reason):
            verdicts.agreement(differences, "0")
    assert verdicts.agreement(agreeing(hidden, value=1.0), "0").verdict == FAILS


def test_a_detected_deviation_is_seen_with_the_power_that_is_said():
    """Of 1000 tests at the detectable deviation the share that finds it is POWER; 4 sigma."""
    number, stderr = 1000, 0.01
    deviation = Estimate(0.0, stderr).detectable
    noise = np.random.default_rng(1).normal(deviation, stderr, number)
    detected_share = np.mean([Estimate(value, stderr).is_significant for value in noise])
    spread = math.sqrt(POWER * (1 - POWER) / number)
    assert abs(detected_share - POWER) < 4 * spread


def test_the_median_point_tells_what_a_sample_detects():
    """A point without a known error detects nothing."""
    differences = sample([0.0, 0.0, 0.0], [1.0, 2.0, math.nan], [math.inf] * 3)
    assert differences.detectable() == pytest.approx(2.0 * differences.at(0).detectable)
    assert math.isinf(differences.where(np.array([True, False, True])).detectable())


def test_relative_agreement_that_errors_hide_is_qualified():
    """R of 0.01 with an error of 0.005 agrees with a theory of half or twice its value."""
    gas = beside_theory(reduced(beta=(-0.95, -0.94, -0.93), r=(0.9,), error=0.005))
    gas = gas.assign(R=gas.theory)
    finding = verdicts.agreement_in_proportion(gas, "theory")
    assert finding.verdict == QUALIFIED and "could have been seen" in finding.reason
    assert verdicts.agreement(verdicts.deviation(gas), "theory").verdict == HOLDS


def test_a_statement_that_says_its_refutation_is_tested_only_if_that_is_seen():
    estimate = Estimate(0.0, 0.01)
    statement = STATEMENTS["wave_form_changes_nothing"]._replace(
        experiments=("gas",),
        judge=lambda _: verdicts.Finding(HOLDS, "It does.", (("x", estimate),)),
    )
    gas = {"gas": xr.Dataset(attrs={"title": "gas"})}
    beyond = {HOLDS: 1.01 * estimate.detectable, NOT_TESTED: 0.99 * estimate.detectable}
    for verdict, deviation in beyond.items():
        assert examine(statement._replace(refuted_beyond=deviation), gas).verdict == verdict
    assert examine(statement, gas).smallest_deviation == estimate.detectable


def test_criteria_after_data_are_marked():
    marks = {
        Fixed("before data"): "",
        Fixed("before data", note="by hand"): "",
        Fixed("before data", 2): "criterion before its data, 2 tries",
        Fixed("after data"): "criterion after its data, 1 try",
        Fixed("partly after data", 3): "criterion in part after its data, 3 tries",
    }
    assert {fixed: fixed.mark for fixed in marks} == marks
    assert Fixed("after data", 2, "it was seen").text == "after its data, 2 tries; it was seen"
