"""Gases that cool by the same drive: curves that cross, as a judge finds it."""

import json

import numpy as np
import pytest
from tests.pages import DOCS
from tests.synthetic import reduced

from roughgas import theory
from roughgas.base.files import module_of
from roughgas.claims.evidence import FAILS, HOLDS, NOT_TESTED, QUALIFIED

STUDY = DOCS.parent / "studies" / "mpemba"
POWER, PACKING = 0.00127, 0.001
ROUGHER, SMOOTHER = (0.7, 0.0), (0.9, -0.7)
"""r and beta of the two materials."""
ERROR = 0.001
BEGIN, END = 4000.0, 20000.0


@pytest.fixture(scope="module")
def curves():
    return module_of(STUDY, "curves")


def gas(name, T, theta, time, material, power=POWER, share=0.1, stretch=1.0):
    """A reduced dataset of a gas with these temperatures T and theta = T_rot/T_tr over time,
    before and after which it is stationary; `stretch` makes it slower."""
    T_tr = 3 * T / (2 + theta)
    frequency = 0.5 * float(theory_frequency())
    at = np.arange(20.0, 28001.0, 20.0)
    since = np.clip((at - BEGIN) * frequency / stretch, 0.0, None)
    trans = np.interp(since, time, T_tr, right=T_tr[-1])
    rot = np.interp(since, time, theta * T_tr, right=(theta * T_tr)[-1])
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
    series = {
        "time_series": at,
        "E_trans_series": trans / 2,
        "E_rot_series": rot / 2,
        "E_trans_series_stderr": np.full(len(at), ERROR / 2),
        "E_rot_series_stderr": np.full(len(at), ERROR / 2),
        "collisions_series": 2 * frequency * at,
    }
    found = {name: (("r", "beta", "sample"), values[None, None]) for name, values in series.items()}
    found["stage_begin"] = (("r", "beta", "stage"), np.array([[[0.0, BEGIN, END]]]))
    data = reduced(name, r=material[:1], beta=material[1:])
    about = {"experiment_json": json.dumps(settings), "packing": PACKING}
    return data.assign(found).assign_attrs(about)


def remembering(depth):
    """A gas that does what the rate equations say, or `depth` times as much below its last T."""
    drives, lengths = ((0.00521, 1.0), (1e-9, 1.0), (0.000651, 1.0)), (6000.0, 1840.0, 8000.0)
    state, parts, at = (1.3, 9.4), [], np.arange(20.0, 8001.0, 20.0)
    for drive, length in zip(drives, lengths, strict=True):
        part = theory.driven_temperatures(at[at <= length], *state, 0.7, 0.0, PACKING, *drive)
        state = tuple(one[-1] for one in part)
        parts.append(np.array(part))
    end = np.repeat(parts[-1][:, -1:], 400, axis=1)
    parts[-1] = end[:, :1] + depth * (parts[-1] - end[:, :1])
    trans, rot = np.concatenate([*parts, end], axis=1)
    stages = [
        {"effects": {"thermostat": dict(zip(("power", "spin_share"), drive, strict=True))}}
        for drive in drives
    ]
    settings = {"effects": stages[0]["effects"], "schedule": {"stages": [{}, *stages[1:], {}]}}
    time = 20.0 * np.arange(1, len(trans) + 1)
    frequency = float(theory.collision_frequency(end[0, 0], PACKING))
    series = {
        "time_series": time,
        "E_trans_series": trans / 2,
        "E_rot_series": rot / 2,
        "E_trans_series_stderr": np.full(len(time), ERROR / 2),
        "E_rot_series_stderr": np.full(len(time), ERROR / 2),
        "collisions_series": frequency * time,
    }
    found = {name: (("r", "beta", "sample"), values[None, None]) for name, values in series.items()}
    begins = np.concatenate([[0.0], np.cumsum(lengths)])
    found["stage_begin"] = (("r", "beta", "stage"), begins[None, None])
    about = {"experiment_json": json.dumps(settings), "packing": PACKING}
    return reduced("memory", r=(0.7,), beta=(0.0,)).assign(found).assign_attrs(about)


@pytest.mark.parametrize(("depth", "verdict"), [(1.0, HOLDS), (1.08, QUALIFIED), (0.0, FAILS)])
def test_a_hump_is_held_against_the_rate_equations(judged, depth, verdict):
    found = judged("spins_are_remembered", remembering(depth))
    assert found.verdict == verdict, found.reason


def theory_frequency():
    theta = float(theory.stationary_theta(0.7, 0.0, 2, 0.5, 0.1))
    return theory.collision_frequency(3 / (2 + theta), PACKING)


def pair(curves, protocol, material=ROUGHER, **changes):
    """The two gases of a protocol, as they are published."""
    rows = np.genfromtxt(
        curves.REFERENCE,
        delimiter=",",
        names=True,
        dtype=None,
        encoding="utf-8",
        skip_header=curves.SOURCE,
    )
    found, prefix = [], "" if protocol == "crossing" else f"{protocol}_"
    suffix = "" if material == ROUGHER else "_smoother"
    for sample in ("hot", "cold"):
        own = rows[(rows["protocol"] == protocol) & (rows["sample"] == sample)]
        own = own[(own["r"] == material[0]) & (own["beta"] == material[1])]
        T, theta = np.append(own["T"], 1.0), np.append(own["theta"], own["theta"][-1])
        time = np.append(own["time"], own["time"][-1] + 1.0)
        found.append(gas(sample, T, theta, time, material, **changes))
    return [one.assign_attrs(experiment=prefix + one.experiment + suffix) for one in found]


CASES = {
    "hotter_cools_first": ("crossing", ROUGHER),
    "overshoot": ("overshoot", ROUGHER),
    "hotter_cools_first_where_smoother": ("crossing", SMOOTHER),
    "overshoot_where_smoother": ("overshoot", SMOOTHER),
}


@pytest.mark.parametrize("name", CASES)
@pytest.mark.parametrize(("stretch", "verdict"), [(1.0, HOLDS), (1.07, QUALIFIED), (1.3, FAILS)])
def test_gases_as_published_cross_when_they_are_published_to(
    judged, curves, name, stretch, verdict
):
    found = judged(name, *pair(curves, *CASES[name], stretch=stretch))
    assert found.verdict == verdict, found.reason


@pytest.mark.parametrize("name", CASES)
def test_what_is_too_noisy_is_not_judged(judged, curves, name):
    gases = pair(curves, *CASES[name])
    noisy = [one.assign(E_trans_series_stderr=one.E_trans_series_stderr + 1.0) for one in gases]
    assert judged(name, *noisy).verdict == NOT_TESTED


@pytest.mark.parametrize("name", CASES)
def test_curves_that_do_not_cross_fail(judged, curves, name):
    hot, cold = pair(curves, *CASES[name])
    assert judged(name, hot, hot.assign_attrs(experiment=cold.experiment)).verdict == FAILS


def test_the_rate_equations_are_near_the_published_curves(curves):
    for gas_of, sample in zip(pair(curves, "crossing"), ("hot", "cold"), strict=True):
        ours = curves.simulated(gas_of)
        wanted = curves.published("crossing", sample, *ROUGHER)
        known = curves.expected(gas_of, ours)
        away = np.interp(wanted.time, known.time, known.T) - wanted.T
        assert np.abs(away).max() < 0.03
        near = np.interp(wanted.time, ours.time, ours.T) - wanted.T
        assert np.abs(near).max() < 0.04  # between two samples
