"""The statements of the paper, judged on made-up datasets with known answers."""

import numpy as np
import pytest
import xarray as xr
from tests.claims.gases import (
    ROUGH,
    bump,
    constant,
    cooling,
    cooling_as,
    lun,
    sheared,
    smooth_disks_between_rough_walls,
    walls,
)
from tests.study_modules import module_of_study
from tests.synthetic import BETA, reduced

from roughgas.claims.verdicts import FAILS, HOLDS, NOT_TESTED, QUALIFIED

CASES = {  # makers of datasets with an effect of some size; sizes for each verdict
    "vibrated_follows_lun": (lambda size: [reduced(shift=bump(size))], 0.015, 0.04, 0.09),
    "vibrated_independent_of_r": (lambda slope: [falling(slope)], 0.0, 0.2, 0.5),
    "forced_equipartition": (lambda size: [reduced(), at_equal(size)], 0.0, 0.04, -0.1),
    "particle_walls_change_nothing": (lambda size: walls(particle=size), 0.0, 0.02, 0.1),
    "smooth_walls_change_nothing": (lambda size: walls(smooth=size), 0.0, 0.02, 0.1),
    "rough_walls_push_to_half": (lambda size: walls(rough=size), 0.2, 0.003, -0.2),
    "sheared_follows_lun": (lambda size: [sheared(shift=of_lun(2 * size))], 0.0, 0.04, 0.1),
    "shear_fails_unsubtracted": (lambda direct: [sheared(direct, error=0.002)], 0.1, 0.04, 0.0),
    "cooling_follows_k": (lambda size: [cooling(size)], -0.012, 0.03, -0.07),
    "cooling_depends_on_r": (lambda slope: [cooling_as(above_lun(slope))], 1.0, 0.2, 0.0),
    "forcing_decides": (lambda size: [cooling(size), reduced()], 0.0, 0.04, 0.3),
    "restitution_matters_when_cooling": (
        lambda slope: [cooling_as(above_lun(1.0)), falling(slope, 1.0)],
        *(0.0, 0.5, 1.0),
    ),
}


UNCERTAIN_WALLS = [
    gas.assign(R_stderr=xr.full_like(gas.R_stderr, 0.05)) for gas in walls(rough=0.0)
]
COUPLE = "rough_walls_couple_to_the_vertical"


def falling(slope, r_end=0.99):
    return reduced(shift=lambda r, beta: slope * (r_end - r) + 0 * beta)


def at_equal(size):
    return reduced("sheared", shift=lambda r, beta: size * (beta == 1) + 0 * r)


def of_lun(share):
    return lambda r, beta: share * lun(r, beta)


def above_lun(slope):
    return lambda r, beta: lun(r, beta) + slope * (1 - r)


@pytest.mark.parametrize("name", CASES)
def test_a_verdict_depends_on_the_size_of_an_effect(judged, name):
    make, *sizes = CASES[name]
    verdicts = [judged(name, *make(size)).verdict for size in sizes]
    assert verdicts == [HOLDS, QUALIFIED, FAILS]


@pytest.mark.parametrize(
    ("name", "datasets", "index", "value"),
    [
        ("vibrated_follows_lun", [reduced(shift=bump(0.04))], 0, 0.04),
        ("vibrated_independent_of_r", [reduced(shift=bump(0.1), beta=(0.0,))], 1, 0.095),
        ("cooling_follows_k", [cooling(-0.012)], 1, -0.012),
    ],
)
def test_numbers_of_findings_match_the_datasets(judged, name, datasets, index, value):
    _, number = judged(name, *datasets).numbers[index]
    assert number.value == pytest.approx(value, abs=0.005) and number.is_significant


def test_one_stray_point_qualifies_but_does_not_refute(judged):
    stray = reduced(shift=lambda r, beta: 0.1 * ((r == 0.9) & (beta == 0.3)))
    finding = judged("vibrated_follows_lun", stray)
    assert finding.verdict == QUALIFIED and "r = 0.9, beta = 0.3" in finding.reason


@pytest.mark.parametrize(
    ("name", "datasets", "reason"),
    [
        ("vibrated_follows_lun", [reduced(error=0.2)], "errors are too large"),
        ("vibrated_follows_lun", [reduced(equilibrated=0.0)], "steady state"),
        ("vibrated_independent_of_r", [reduced(r=(0.9,))], "fewer than two"),
        ("theory_underestimates", [reduced(error=0.03)], "too large to tell a direction"),
        ("rough_walls_above_half", walls(beta=BETA), "does not reach beta = -1"),
        (COUPLE, walls()[1:2], "no vertical energy"),
        (COUPLE, [smooth_disks_between_rough_walls(error=0.03)], "too large to tell"),
        (COUPLE, [smooth_disks_between_rough_walls(R_dof=1.0)], "energy of spins"),
        ("shear_fails_unsubtracted", [reduced("sheared")], "no un-subtracted R"),
        (
            "only_rough_walls_matter",
            UNCERTAIN_WALLS,
            "may hide a deviation of 0.02",
        ),
        ("cooling_depends_on_r", [cooling(error=0.2)], "may hide a deviation"),
        (
            "restitution_matters_when_cooling",
            [cooling(error=0.2), reduced()],
            "may hide a deviation of 0.02",
        ),
        ("shear_noisier", [sheared(seeds=1), reduced(seeds=1)], "several seeds"),
        ("cooling_reaches_a_constant", [cooling().drop_vars("R_drift")], "no time series"),
    ],
)
def test_undecidable_statements_are_not_tested(judged, name, datasets, reason):
    finding = judged(name, *datasets)
    assert finding.verdict == NOT_TESTED and reason in finding.reason


def test_the_degrees_of_freedom_of_each_point_count(judged):
    """Five standard errors are significant only if they are known well."""
    shifted = {"shift": constant(0.03), "beta": ROUGH, "error": 0.006}
    assert judged("vibrated_follows_lun", reduced(**shifted)).verdict == QUALIFIED
    vague = judged("vibrated_follows_lun", reduced(R_dof=3.0, **shifted))
    assert vague.verdict == NOT_TESTED
    unknown = judged("vibrated_follows_lun", reduced(R_dof=0.0))
    assert unknown.verdict == NOT_TESTED and "its errors are unknown" in unknown.reason


@pytest.mark.parametrize(
    ("shift", "expected"),
    [
        (bump(0.03), HOLDS),
        (constant(0.01), QUALIFIED),
        (bump(0.003), QUALIFIED),
        (bump(0.0), FAILS),
        (bump(-0.03), FAILS),
    ],
    ids=["grows", "everywhere the same", "a trifle", "none", "overestimates"],
)
def test_theory_underestimates(judged, shift, expected):
    finding = judged("theory_underestimates", reduced(shift=shift, error=0.0005))
    assert finding.verdict == expected and "at r = 0.8" in finding.reason


def test_points_without_a_steady_state_are_set_aside(judged):
    equilibrated = np.ones((3, 21))
    equilibrated[0] = 0.25
    data = reduced(shift=lambda r, beta: 0.3 * (r == 0.8) + 0 * beta, equilibrated=equilibrated)
    finding = judged("vibrated_follows_lun", data)
    assert finding.verdict == HOLDS and "42 of 42 points" in finding.reason
    assert "21 points not known to be in a steady state set aside" in finding.reason


def test_points_with_the_contact_time_model_are_set_aside(judged):
    """At r = 0.6 R is far off: nothing of it is judged."""
    contact_time = np.array([[1e-4], [np.nan], [np.nan]])
    elsewhere = {"shift": lambda r, beta: np.where(r == 0.6, 0.3, 0.0), "r": (0.6, 0.9, 0.99)}
    modelled = reduced("vibrated", contact_time=contact_time, **elsewhere)
    assert judged("vibrated_follows_lun", modelled).verdict == HOLDS
    assert judged("vibrated_follows_lun", reduced("vibrated", **elsewhere)).verdict != HOLDS


@pytest.mark.parametrize(
    ("shifts", "expected"),
    [
        ({}, HOLDS),
        ({"particle": 0.02}, QUALIFIED),
        ({"smooth": 0.15}, FAILS),
        ({"rough": 0.0}, FAILS),
        ({"rough": 0.0, "smooth": 0.2}, FAILS),
    ],
    ids=["only rough", "others a little", "smooth as much", "none", "smooth alone"],
)
def test_only_rough_walls_matter(judged, shifts, expected):
    assert judged("only_rough_walls_matter", *walls(**shifts)).verdict == expected


@pytest.mark.parametrize(
    ("above", "expected"), [(0.1, HOLDS), (0.003, QUALIFIED), (0.0, FAILS), (-0.1, FAILS)]
)
def test_above_half_at_smooth_particles(judged, above, expected):
    _, rough, _, _ = walls()
    rough = rough.sel(beta=[-1.0])
    rough = rough.assign(R=0 * rough.R + 0.5 + above, R_stderr=0 * rough.R + 0.0001)
    finding = judged("rough_walls_above_half", rough)
    assert finding.verdict == expected and finding.numbers[0][1].value == pytest.approx(above)


@pytest.mark.parametrize(
    ("anisotropy", "gap", "expected"),
    [
        (0.2, 0.0, HOLDS),
        (0.2, 0.3, QUALIFIED),
        (0.2, -0.3, QUALIFIED),
        (0.008, 0.0, QUALIFIED),
        (0.2, -0.7, FAILS),
        (0.2, 0.7, FAILS),
        (0.0, 0.0, FAILS),
        (-0.2, 0.0, FAILS),
    ],
    ids=[
        *("the vertical energy", "more", "less", "anisotropic by a trifle"),
        *("nearer the horizontal", "much more", "isotropic", "more horizontal energy"),
    ],
)
def test_rough_walls_couple_to_the_vertical(judged, anisotropy, gap, expected):
    error = 2e-4 if 0 <= anisotropy < 0.1 else 0.001
    finding = judged(COUPLE, smooth_disks_between_rough_walls(anisotropy, gap + 1e-9, error))
    assert finding.verdict == expected
    *rest, (_, share) = finding.numbers
    assert share.value == pytest.approx(anisotropy / 2) and share.dof == 40
    assert [number.value for _, number in rest] == [pytest.approx(gap, abs=1e-6)] * (anisotropy > 0)


def test_the_error_of_the_energy_of_spins_is_propagated():
    """It equals finite differences in R and in the share of the vertical energy."""
    judges, error, gap = module_of_study("paper", "judges"), 1e-6, 0.3
    bed = smooth_disks_between_rough_walls(0.2, gap, error)
    shifted_ratio = bed.R + error
    shifted = (
        bed.assign(E_rot=shifted_ratio / (1.0 - shifted_ratio)),
        bed.assign(vertical_share=bed.vertical_share + error),
    )
    differences = [judges.spin_gap(data).value[0] - gap for data in shifted]
    assert judges.spin_gap(bed).stderr[0] == pytest.approx(np.hypot(*differences), rel=1e-3)


@pytest.mark.parametrize(
    ("error", "expected"),
    [(0.004, HOLDS), (0.0013, QUALIFIED), (0.001, QUALIFIED), (0.0005, FAILS)],
)
def test_noisier(judged, error, expected):
    finding = judged("shear_noisier", sheared(error=error), reduced(error=0.001))
    assert finding.verdict == expected
    log = finding.numbers[0][1]
    assert log.value == pytest.approx(np.log(error / 0.001), abs=3 * log.stderr)


@pytest.mark.parametrize(
    ("drift", "steady", "expected"),
    [
        (0.001, 1.0, HOLDS),
        (0.04, 1.0, QUALIFIED),
        (0.1, 1.0, FAILS),
        (0.001, [[0.0], [1.0], [1.0]], QUALIFIED),
        (0.001, [[0.0], [0.0], [1.0]], FAILS),
    ],
)
def test_reaches_a_constant(judged, drift, steady, expected):
    steady = np.broadcast_to(steady, (3, len(ROUGH)))
    data = cooling(equilibrated=steady, R_drift=drift, R_drift_stderr=0.001)
    finding = judged("cooling_reaches_a_constant", data)
    assert finding.verdict == expected and "A plateau was found at" in finding.reason
