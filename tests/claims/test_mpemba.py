"""Gases that cool by the same drive: judges of the crossings of their curves."""

import json

import numpy as np
import pytest
from tests.pages import DOCS
from tests.synthetic import reduced

from roughgas import theory
from roughgas.base.files import study_module
from roughgas.claims.verdicts import FAILS, HOLDS, NOT_TESTED, QUALIFIED

STUDY = DOCS.parent / "studies" / "mpemba"
POWER, PACKING = 0.00127, 0.001
ROUGHER, SMOOTHER, LESS_INELASTIC = (0.7, 0.0), (0.9, -0.7), (0.9, 0.0)
"""r and beta of materials."""
ERROR = 0.001
SEEDS = 8
BLOCK = 500.0  # T: noise of a seed is constant in it
BEGIN, END = 4000.0, 20000.0
CLAIM_OF_CURVES = "curves_are_published"


@pytest.fixture(scope="module")
def curves():
    return study_module(STUDY, "curves")


def series_of_seeds(times, trans, rot, collisions, error):
    """Return the series of seeds of a gas with these means, by name.

    Temperatures scatter by a standard error `error` of the mean, and add up to the means exactly.
    """
    rng = np.random.default_rng(len(times))
    blocks = (times // BLOCK).astype(int)
    noise = rng.normal(0.0, error * np.sqrt(SEEDS), (2, blocks.max() + 1, SEEDS))
    noise -= noise.mean(axis=-1, keepdims=True)
    energies = {
        "E_trans_series_seed": trans[:, None] / 2 + noise[0, blocks] / 2,
        "E_rot_series_seed": rot[:, None] / 2 + noise[1, blocks] / 2,
        "collisions_series_seed": np.repeat(collisions[:, None], SEEDS, axis=1),
    }
    return {
        name: (("r", "beta", "sample", "seed"), values[None, None])
        for name, values in energies.items()
    } | {"time_series": (("r", "beta", "sample"), times[None, None])}


def gas(name, T, theta, time, material, power=POWER, share=0.1, stretch=1.0, error=ERROR):
    """Return a reduced dataset of a gas with these temperatures T and theta = T_rot/T_tr over time,
    stationary before and after; `stretch` makes it slower."""
    T_tr = 3 * T / (2 + theta)
    frequency = 0.5 * float(theory_frequency())
    times = np.arange(20.0, 28001.0, 20.0)
    reduced_time = np.clip((times - BEGIN) * frequency / stretch, 0.0, None)
    trans = np.interp(reduced_time, time, T_tr, right=T_tr[-1])
    rot = np.interp(reduced_time, time, theta * T_tr, right=(theta * T_tr)[-1])
    stages = [
        {"duration": BEGIN},
        {
            "duration": END - BEGIN,
            "effects": {"thermostat": {"power": power, "spin_share": share}},
            "temperature": float(T_tr[0]),
            "spin_temperature": float(theta[0] * T_tr[0]),
        },
        {"duration": 8000.0},
    ]
    settings = {"effects": {"thermostat": {}}, "schedule": {"stages": stages}}
    variables = series_of_seeds(times, trans, rot, 2 * frequency * times, error)
    variables["stage_begin"] = (("r", "beta", "stage"), np.array([[[0.0, BEGIN, END]]]))
    data = reduced(name, r=material[:1], beta=material[1:], seeds=SEEDS)
    attributes = {"experiment_json": json.dumps(settings), "packing": PACKING}
    return data.assign(variables).assign_attrs(attributes)


def remembering(depth, error=ERROR):
    """Return a gas that follows the rate equations, with its hump multiplied by `depth`."""
    drives, lengths = ((0.00521, 1.0), (1e-9, 1.0), (0.000651, 1.0)), (6000.0, 1840.0, 8000.0)
    state, legs, leg_times = (1.3, 9.4), [], np.arange(20.0, 8001.0, 20.0)
    for drive, length in zip(drives, lengths, strict=True):
        temperatures = theory.driven_temperatures(
            leg_times[leg_times <= length], *state, 0.7, 0.0, PACKING, *drive
        )
        state = tuple(column[-1] for column in temperatures)
        legs.append(np.array(temperatures))
    end = np.repeat(legs[-1][:, -1:], 400, axis=1)
    legs[-1] = end[:, :1] + depth * (legs[-1] - end[:, :1])
    trans, rot = np.concatenate([*legs, end], axis=1)
    stages = [
        {"effects": {"thermostat": dict(zip(("power", "spin_share"), drive, strict=True))}}
        for drive in drives
    ]
    settings = {"effects": stages[0]["effects"], "schedule": {"stages": [{}, *stages[1:], {}]}}
    time = 20.0 * np.arange(1, len(trans) + 1)
    frequency = float(theory.collision_frequency(end[0, 0], PACKING))
    variables = series_of_seeds(time, trans, rot, frequency * time, error)
    begins = np.concatenate([[0.0], np.cumsum(lengths)])
    variables["stage_begin"] = (("r", "beta", "stage"), begins[None, None])
    attributes = {"experiment_json": json.dumps(settings), "packing": PACKING}
    return (
        reduced("memory", r=(0.7,), beta=(0.0,), seeds=SEEDS)
        .assign(variables)
        .assign_attrs(attributes)
    )


@pytest.mark.parametrize(("depth", "verdict"), [(1.0, HOLDS), (1.08, QUALIFIED), (0.0, FAILS)])
def test_a_hump_is_judged_by_the_rate_equations(judged, depth, verdict):
    finding = judged("spins_are_remembered", remembering(depth))
    assert finding.verdict == verdict, finding.reason


def test_a_hump_within_the_errors_is_not_judged(judged):
    assert judged("spins_are_remembered", remembering(1.0, 0.1)).verdict == NOT_TESTED


def theory_frequency():
    theta = float(theory.stationary_theta(0.7, 0.0, 2, 0.5, 0.1))
    return theory.collision_frequency(3 / (2 + theta), PACKING)


def pair(curves, protocol, material=ROUGHER, **changes):
    """Return the two gases of a protocol, with their published curves."""
    rows = np.genfromtxt(
        curves.REFERENCE,
        delimiter=",",
        names=True,
        dtype=None,
        encoding="utf-8",
        skip_header=curves.HEADER_LINES,
    )
    if material == LESS_INELASTIC:  # whose curves differ least
        changes = {"error": ERROR / 4} | changes
    gases, prefix = [], "" if protocol == "crossing" else f"{protocol}_"
    suffix = next(name for name, of_name in MATERIALS.items() if of_name == material)
    for sample in ("hot", "cold"):
        curve = rows[(rows["protocol"] == protocol) & (rows["sample"] == sample)]
        curve = curve[(curve["r"] == material[0]) & (curve["beta"] == material[1])]
        T, theta = np.append(curve["T"], 1.0), np.append(curve["theta"], curve["theta"][-1])
        time = np.append(curve["time"], curve["time"][-1] + 1.0)
        gases.append(gas(sample, T, theta, time, material, **changes))
    return [data.assign_attrs(experiment=prefix + data.experiment + suffix) for data in gases]


MATERIALS = {
    "": ROUGHER,
    "_smoother": SMOOTHER,
    "_smoother_inelastic": (0.7, -0.7),
    "_less_inelastic": LESS_INELASTIC,
}
"""r and beta by the end of the names of experiments."""
CASES = {
    name + (f"_where{suffix}" if suffix else ""): (protocol, material)
    for suffix, material in MATERIALS.items()
    for name, protocol in (("hotter_cools_first", "crossing"), ("overshoot", "overshoot"))
}
NAMES = [
    name if material in (ROUGHER, SMOOTHER) else pytest.param(name, marks=pytest.mark.slow)
    for name, (_, material) in CASES.items()
]


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize(("stretch", "verdict"), [(1.0, HOLDS), (1.07, QUALIFIED), (1.3, FAILS)])
def test_published_gases_cross_at_the_published_time(judged, curves, name, stretch, verdict):
    finding = judged(name, *pair(curves, *CASES[name], stretch=stretch))
    assert finding.verdict == verdict, finding.reason


@pytest.mark.parametrize("name", NAMES)
def test_noisy_curves_are_not_judged(judged, curves, name):
    assert judged(name, *pair(curves, *CASES[name], error=1.0)).verdict == NOT_TESTED


@pytest.mark.parametrize("name", NAMES)
def test_curves_that_do_not_cross_fail(judged, curves, name):
    hot, cold = pair(curves, *CASES[name])
    assert judged(name, hot, hot.assign_attrs(experiment=cold.experiment)).verdict == FAILS


def test_the_rate_equations_are_near_the_published_curves(curves):
    for gas_of, sample in zip(pair(curves, "crossing"), ("hot", "cold"), strict=True):
        ours = curves.Gases([curves.course(gas_of)]).simulated()
        published = curves.published("crossing", sample, *ROUGHER)
        rates = curves.expected(gas_of, ours.time)
        deviation = np.interp(published.time, rates.time, rates.T) - published.T
        assert np.abs(deviation).max() < 0.03
        our_deviation = np.interp(published.time, ours.time, ours.T) - published.T
        assert np.abs(our_deviation).max() < 0.04  # between two samples


def all_gases(curves, shift=0.0):
    """Return all pairs; one quarter of the first curve is off by about `shift`/2 T_st."""
    gases = [gas for case in CASES.values() for gas in pair(curves, *case, error=0.0005)]
    first = gases[0]
    begins, time = first.stage_begin.values[0, 0], first.time_series
    off = shift * ((time > begins[1]) & (time < begins[1] + 800.0))
    gases[0] = first.assign(E_trans_series_seed=first.E_trans_series_seed + off)
    return gases


@pytest.mark.slow
@pytest.mark.parametrize(("shift", "verdict"), [(0.0, HOLDS), (0.02, QUALIFIED), (0.6, FAILS)])
def test_curves_are_judged_with_their_covariance(judged, curves, shift, verdict):
    finding = judged(CLAIM_OF_CURVES, *all_gases(curves, shift))
    assert finding.verdict == verdict, finding.reason
