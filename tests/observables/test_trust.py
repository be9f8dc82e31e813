"""Which errors of observables are trusted: by the length of a window, phases, visits, replicas."""

import math

import numpy as np
import pytest
from schedules import COOLING, SPIN, STEADY
from tests.observables.test_observing import MIXED

from roughgas import simulate
from roughgas.cli.show import observed
from roughgas.observables import KINDS
from roughgas.observables.plugin import Observable, averaged
from roughgas.simulation.trust import Window, trust_in, window_of
from roughgas.statistics.errors import (
    LEAST,
    NO,
    UNKNOWN,
    YES,
    Evidence,
    carriers,
    half_width,
    verdict,
)

LONG = Window(YES, memories=100.0, phases=math.inf)
ENOUGH = 48.0
BED = {
    "particles": 40,
    "box": (12.5, "open"),
    "effects": SPIN
    | {
        "gravity": {"acceleration": 1},
        "floor": {"amplitude": 5, "period": 1, "restitution": 1, "roughness": -1},
    },
    "schedule": STEADY | {"equilibrate": 30, "measure": 80, "sample_every": 0.05},
}
GAS = {"particles": 20, "box": (25, 25), "effects": SPIN}
COOLED = COOLING | {"relaxation_times": 8, "plateau": 20}


def noise(shape, seed=5):
    """White noise, the same in every order of the tests."""
    return np.random.default_rng(seed).standard_normal(shape)


@pytest.fixture
def measured(monkeypatch):
    """Let all kinds need ENOUGH relaxation times, in beds, too, and none of flows."""
    for kind in KINDS.values():
        monkeypatch.setattr(kind, "relaxations", ENOUGH)
        monkeypatch.setattr(kind, "beds", True)
        monkeypatch.setattr(kind, "of_flow", False)


def point(observe, **scene):
    return simulate(r=0.9, beta=0.0, observe=observe, progress=False, **scene)


def trusted(values, window=LONG, relaxations=ENOUGH):
    """The flags of the means of a series (looks, elements), and what they lack."""
    mean = averaged(dict, [[{"x": look} for look in values]])
    return trust_in(mean.value["x"], mean.stderr["x"], mean.evidence["x"], window, relaxations)


# ------------------------------------------------------------------------ phases of a drive


def test_a_bed_that_is_seen_once_a_period_is_not_trusted(measured):
    """Its cumulants differ from those at all phases by several of their errors."""
    once, often = (
        point({"cumulants": {"every": n}, "profiles": {"every": n, "bins": 30}}, **BED)
        for n in (20, 1)
    )
    for name in ("a20", "a02", "flow_profile"):
        assert (once[f"{name}_trusted"] == UNKNOWN).all()
        assert "1 phase of the drive, 16 needed" in once[f"{name}_trusted"].comment
    assert often.a20_trusted == YES and "comment" not in often.a20_trusted.attrs
    flow = once.flow_profile.isel(component=1, height=slice(None, 5))
    assert abs(flow).max() > 1.0 and once.equilibrated == YES
    assert (often.flow_profile_trusted.isel(height=slice(2, 6)) == YES).all()
    assert (often.flow_profile_trusted.isel(height=-1) == UNKNOWN).all()


@pytest.mark.parametrize(("every", "shown"), [(1, 20), (3, 20), (4, 5), (10, 2), (20, 1), (40, 1)])
def test_looks_show_as_many_phases_as_their_interval_and_the_period_leave(every, shown):
    from roughgas.scene import build

    experiment = {**BED, "box": [12.5, "open"]}
    scene, seen = build(experiment, 0.9, 0.0), {"equilibrated": YES, "slowest_relaxation": 1.0}
    assert window_of(scene, experiment, seen, (30, every)).phases == shown


# ------------------------------------------------------------------------ length, by theory


def test_theory_sets_the_length_of_the_window():
    values = noise((400, 2))
    assert trusted(values).flags.tolist() == [YES, YES] and not trusted(values).lack
    short = trusted(values, LONG._replace(memories=13.2))
    assert short.flags.tolist() == [UNKNOWN, UNKNOWN]
    assert short.lack == "window of 13 relaxation times, 48 needed"
    assert "not known" in trusted(values, relaxations=math.inf).lack
    for memories in (math.nan, 0.0):
        unknown = trusted(values, LONG._replace(memories=memories))
        assert (unknown.flags == UNKNOWN).all() and unknown.lack == "relaxation time not known"


def test_without_a_steady_state_nothing_is_trusted():
    values = noise((400, 1))
    for steady in (NO, UNKNOWN):
        mean = trusted(values, LONG._replace(steady=steady))
        assert mean.flags.tolist() == [steady] and "steady state" in mean.lack


def test_one_function_judges_by_all_the_evidence():
    evidence = Evidence(samples=np.array([11, 12, 300]), times=np.array([9.0, 6.0, math.nan]))
    assert verdict(YES, evidence).tolist() == [UNKNOWN, YES, UNKNOWN]
    assert verdict(NO, evidence).tolist() == [NO] * 3
    assert verdict(YES, Evidence(), LEAST._replace(memories=math.inf)) == YES


# ------------------------------------------------------------------------ what data veto


def test_a_column_that_a_few_visits_make_is_not_trusted():
    """Three visits of one look in 400, or two of ten looks; the last column was never visited."""
    values = np.zeros((400, 4))
    values[:, 0] = noise(400)
    values[[40, 170, 333], 1] = 1.0
    for begin in (40, 333):
        values[begin : begin + 10, 2] = 1.0
    mean = trusted(values)
    assert mean.flags.tolist() == [YES, UNKNOWN, UNKNOWN, UNKNOWN]
    assert mean.lack == "variance from fewer than 12 looks"


def test_each_element_of_a_table_has_the_flag_of_its_own_series():
    """Of two rows and three columns one is made by a few visits, and one has few looks."""
    values = noise((400, 2, 3))
    values[:, 0, 2] = 0.0
    values[[40, 170, 333], 0, 2] = 1.0
    values[10:, 1, 0] = math.nan
    expected = [[YES, YES, UNKNOWN], [UNKNOWN, YES, YES]]
    assert trusted(values).flags.tolist() == expected


def test_looks_that_are_few_or_remember_for_too_long_are_not_trusted():
    values = np.column_stack([np.cos(np.linspace(0.0, np.pi, 400)), noise(400)])
    mean = trusted(values)
    assert mean.flags.tolist() == [UNKNOWN, YES]
    assert mean.lack == "shorter than 6 autocorrelation times"
    values[8:, 1] = math.nan
    assert trusted(values).lack == ("fewer than 12 looks; shorter than 6 autocorrelation times")
    values[:, 1] = math.nan
    assert trusted(values).flags.tolist() == [UNKNOWN, UNKNOWN]


def test_carriers_of_a_gaussian_are_its_blocks():
    white = np.array([carriers(noise(600, seed=seed), 1.0) for seed in range(40)])
    assert np.median(white) == pytest.approx(600, rel=0.05)
    slow = np.repeat(noise((40, 120)), 5, axis=1)
    assert np.median([carriers(one, 5.0) for one in slow]) == pytest.approx(600 / 5, rel=0.15)
    assert carriers(np.zeros(30), 1.0) == carriers(np.ones(30), math.nan) == 0.0
    assert carriers(np.empty(0), 1.0) == 0.0
    assert carriers(np.eye(1, 30)[0], 1.0) == pytest.approx(3.0)


# ------------------------------------------------------------------------ other protocols


def test_replicas_of_a_cooling_gas_are_trusted_with_its_r():
    few, many = (
        point(["cumulants"], schedule={"kind": "cooling", **COOLED, "replicas": n}, **GAS)
        for n in (4, 8)
    )
    assert (few.R_ci95_trusted, few.a20_trusted) == (UNKNOWN, UNKNOWN)
    assert many.a20_trusted == many.R_ci95_trusted != UNKNOWN
    values = [[{"x": np.array([x, math.nan])}] for x in noise(5)]
    mean = averaged(dict, values)
    cooling = Window(YES, math.inf, math.inf)
    parts = mean.value["x"], mean.stderr["x"], mean.evidence["x"]
    trust = trust_in(*parts, cooling, math.inf)
    assert trust.flags.tolist() == [YES, UNKNOWN] and trust.lack == "fewer than 5 replicas"


def test_a_gas_through_stages_is_not_known_to_be_steady():
    schedule = {"kind": "stages", "sample_every": 1.0, "stages": [{"duration": 30.0}]}
    effects = SPIN | {"shear": {"velocity": 1}}
    mean = point(["cumulants"], **(GAS | {"effects": effects, "schedule": schedule}))
    assert mean.a20_trusted == UNKNOWN and mean.a20_trusted.comment == "steady state not known"


def test_no_length_is_known_of_a_function_of_a_users():
    effects = SPIN | {"shear": {"velocity": 1}}
    schedule = STEADY | {"equilibrate": 400, "measure": 1000, "sample_every": 2, "period": 2}
    energy = {"energy": lambda frame: frame.energy.mean()}
    mean = point(energy, **(GAS | {"effects": effects, "schedule": schedule}))
    assert mean.equilibrated == YES and mean.energy_trusted == UNKNOWN
    assert mean.energy_trusted.comment == "needed length of the window not known"
    assert Observable.relaxations == math.inf


def test_each_species_has_flags_of_its_own(measured):
    effects = SPIN | {"thermostat": {"power": 1, "spin_share": 0, "interval": 1}}
    schedule = STEADY | {"sample_every": 0.5, "period": 0.5}
    scene = GAS | {"effects": effects, "schedule": schedule, "species": MIXED}
    mean = point({"cumulants": {}, "profiles": {"bins": 3}}, **scene)
    assert mean.a20_species_trusted.dims == ("species",)
    assert mean.flow_profile_species_trusted.dims == mean.flow_profile_species.dims
    assert mean.a20_species_trusted.dtype == np.int8


# ------------------------------------------------------------------------ what is shown of it


def test_reduced_datasets_have_the_share_of_seeds():
    schedule = {"kind": "cooling", **COOLED, "replicas": 8}
    scene = GAS | {"schedule": schedule, "observe": ["cumulants", "profiles"]}
    seeds = [simulate(r=0.9, beta=0.0, seed=n, progress=False, **scene) for n in (1, 2, 3)]
    whole = simulate(r=0.9, beta=[0.0], seed=[1, 2, 3], progress=False, **scene).isel(beta=0)
    for name in ("a20_trusted", "flow_profile_trusted"):
        flags = np.array([one[name].values for one in seeds])
        unknown = (flags == UNKNOWN).mean(axis=0) >= 0.5
        expected = np.where(unknown, UNKNOWN, (flags == YES).mean(axis=0))
        assert whole[name].values.squeeze() == pytest.approx(expected)
    assert whole.flow_profile_trusted.dims == whole.flow_profile.dims


def test_show_marks_what_is_not_trusted_and_says_why(measured):
    mean = point({"cumulants": {"every": 20}, "profiles": {"every": 20, "bins": 10}}, **BED)
    text = observed(mean)
    a20, flow = (
        next(one for one in text.splitlines() if one.startswith(name))
        for name in ("a20", "flow_profile")
    )
    assert ")? " in a20 and "20 of 20 ?" in flow
    assert "\n  1 phase of the drive, 16 needed: " in text
    longer = BED | {"schedule": BED["schedule"] | {"measure": 240}}
    assert "?" not in observed(point(["cumulants"], **longer))


# ------------------------------------------------------------------------ what trust is worth

HEATED = {
    "particles": 40,
    "box": (25, 25),
    "effects": SPIN | {"thermostat": {"power": 0.1, "interval": 0.5, "spin_share": 0}},
}
RELAXATION = 5.8  # T, by theory
RUNS, MOST = 80, 0.08
SETTINGS = {"spin_correlation": {}, "pair_correlation": {"bins": 4, "reach": 6.0}}


@pytest.mark.slow
@pytest.mark.parametrize("kind", SETTINGS)
def test_trusted_intervals_miss_as_rarely_as_they_say(kind):
    """The mean over all runs, of windows as long as the kind needs; by two binomial errors.

    Half the elements or more are trusted, and none in half the window.
    """
    needed = KINDS[kind].relaxations
    short, long = _heated(kind, 0.5 * needed, 3), _heated(kind, 1.1 * needed, RUNS)
    assert not any((one[f"{name}_trusted"] == YES).any() for one in short for name in _of(one))
    away, flags = [], []
    for name in _of(long[0]):
        values, stderr, dof, trust = (
            np.array([one[f"{name}{end}"].values.ravel() for one in long])
            for end in ("", "_stderr", "_dof", "_trusted")
        )
        half = np.vectorize(half_width)(stderr, dof, 0.95)
        away.append(abs(values - values.mean(axis=0)) > half)
        flags.append(trust == YES)
    missed, sure = np.hstack(away), np.hstack(flags)
    count = np.count_nonzero(sure)
    assert count > 0.5 * sure.size
    allowed = MOST + 2.0 * math.sqrt(MOST * (1.0 - MOST) / count)
    assert np.count_nonzero(missed & sure) <= allowed * count


def _heated(kind, relaxations, runs):
    schedule = {"kind": "steady", "equilibrate": 60, "sample_every": 1.04}
    schedule["measure"] = math.ceil(relaxations * RELAXATION)
    observe = {kind: SETTINGS[kind]}
    return [point(observe, **HEATED, schedule=schedule, seed=n) for n in range(runs)]


def _of(mean):
    names = [str(name) for name in mean.data_vars if "observable" in mean[name].attrs]
    return [name for name in names if f"{name}_trusted" in mean]


# ------------------------------------------------------------------------ what is not known


WEAK = {"langevin": {"interval": 0.5, "drag": 5e-3, "temperature": 1.0}}


def test_flows_that_last_need_a_longer_window():
    """In a bath of weak drag the total momentum lasts 200 T, and temperatures 15."""
    timing = STEADY | {"equilibrate": 100, "measure": 3000}
    seen = point(
        {"profiles": {"bins": 2}, "histograms": {}},
        **GAS | {"effects": SPIN | WEAK, "schedule": timing},
    )
    assert seen.flow_relaxation == pytest.approx(200.0) and seen.slowest_relaxation < 25.0
    assert (seen.flow_profile_trusted == UNKNOWN).all()
    assert (seen.velocity_histogram_trusted == YES).any()


@pytest.mark.parametrize(
    ("observe", "name"), [("profiles", "packing_profile"), ("cumulants", "a20")]
)
def test_what_was_measured_to_miss_in_beds_is_not_known_there(observe, name):
    long = BED | {"schedule": BED["schedule"] | {"measure": 400}}
    seen = point({observe: {}}, **long)
    assert seen.equilibrated == YES and (seen[f"{name}_trusted"] == UNKNOWN).all()
    assert "not known" in seen[f"{name}_trusted"].comment


def test_a_variable_whose_errors_are_too_small_is_never_trusted():
    timing = STEADY | {"equilibrate": 60, "measure": 1500}
    heated = {"thermostat": {"power": 0.1, "interval": 0.5, "spin_share": 0}}
    seen = point({"stress": {}}, **GAS | {"effects": SPIN | heated, "schedule": timing})
    assert (seen.stress_collisional_trusted == UNKNOWN).all()
    assert seen.pressure_trusted == YES
