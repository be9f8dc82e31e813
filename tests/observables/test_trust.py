"""Which errors of observables are trusted: by the length of a window, phases, visits, replicas."""

import math

import numpy as np
import pytest
from raw import window_of
from schedules import COOLING, SPIN, STEADY
from tests.observables.test_observing import MIXED

from roughgas import simulate
from roughgas.cli.show import observed_table
from roughgas.observables import OBSERVABLES
from roughgas.observables.averages import averaged
from roughgas.observables.plugin import Observable
from roughgas.simulation.trust import ObservedWindow, trust_in
from roughgas.statistics.errors import effective_samples, half_width
from roughgas.statistics.sample_sizes import (
    MINIMUM_SAMPLE_SIZE,
    NO,
    UNKNOWN,
    YES,
    SampleSize,
    verdict,
)

LONG = ObservedWindow(YES, memories=100.0, phases=math.inf)
ENOUGH = 48.0
BED = {
    "particles": 40,
    "box": (12.5, "open"),
    "effects": SPIN
    | {
        "gravity": {"acceleration": 1},
        "floor": {"amplitude": 5, "period": 1, "restitution": 1, "roughness": -1},
        "contact_averages": {},  # for the kernel of the paper's beds
    },
    "schedule": STEADY | {"equilibrate": 30, "measure": 80, "sample_every": 0.05},
}
GAS = {"particles": 20, "box": (25, 25), "effects": SPIN}
COOLED = COOLING | {"relaxation_times": 8, "plateau": 20}


def noise(shape, seed=5):
    """White noise, the same in every order of the tests."""
    return np.random.default_rng(seed).standard_normal(shape)


@pytest.fixture
def lenient_trust(monkeypatch):
    """Let all observables need ENOUGH relaxation times, also in beds, and none depend on flows."""
    for kind in OBSERVABLES.values():
        monkeypatch.setattr(kind, "relaxations", ENOUGH)
        monkeypatch.setattr(kind, "valid_in_beds", True)
        monkeypatch.setattr(kind, "depends_on_flow", False)


def point(observe, **scene):
    return simulate(r=0.9, beta=0.0, observe=observe, progress=False, **scene)


def trust_of_means(values, window=LONG, relaxations=ENOUGH):
    """Return the flags of the means of a series (frames, elements), and the reason for doubt."""
    mean = averaged(dict, [{"x": np.array(values)}])
    return trust_in(mean.value["x"], mean.stderr["x"], mean.sample_size["x"], window, relaxations)


# ------------------------------------------------------------------------ phases of a drive


@pytest.mark.slow
def test_a_bed_that_is_sampled_once_a_period_is_not_trusted(lenient_trust):
    """Its cumulants differ from averages over all phases by several of their errors."""
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
def test_interval_and_period_determine_the_number_of_sampled_phases(every, shown):
    from raw import build

    experiment = {**BED, "box": [12.5, "open"]}
    scene, variables = build(experiment, 0.9, 0.0), {"equilibrated": YES, "slowest_relaxation": 1.0}
    assert window_of(scene, experiment, variables, (30, every)).phases == shown


# ------------------------------------------------------------------------ length, by theory


def test_theory_sets_the_length_of_the_window():
    values = noise((400, 2))
    assert trust_of_means(values).flags.tolist() == [YES, YES] and not trust_of_means(values).lack
    short = trust_of_means(values, LONG._replace(memories=13.2))
    assert short.flags.tolist() == [UNKNOWN, UNKNOWN]
    assert short.lack == "window of 13 relaxation times, 48 needed"
    assert "not known" in trust_of_means(values, relaxations=math.inf).lack
    for memories in (math.nan, 0.0):
        unknown = trust_of_means(values, LONG._replace(memories=memories))
        assert (unknown.flags == UNKNOWN).all() and unknown.lack == "relaxation time not known"


def test_without_a_steady_state_nothing_is_trusted():
    values = noise((400, 1))
    for steady in (NO, UNKNOWN):
        mean = trust_of_means(values, LONG._replace(steady=steady))
        assert mean.flags.tolist() == [steady] and "steady state" in mean.lack


def test_a_verdict_weighs_samples_and_autocorrelation_times():
    evidence = SampleSize(samples=np.array([11, 12, 300]), times=np.array([9.0, 6.0, math.nan]))
    assert verdict(YES, evidence).tolist() == [UNKNOWN, YES, UNKNOWN]
    assert verdict(NO, evidence).tolist() == [NO] * 3
    assert verdict(YES, SampleSize(), MINIMUM_SAMPLE_SIZE._replace(memories=math.inf)) == YES


# ------------------------------------------------------------------------ vetoes of the data


def test_a_column_with_few_visits_is_not_trusted():
    """Three visits of one frame in 400, or two of ten frames; the last column had no visit."""
    values = np.zeros((400, 4))
    values[:, 0] = noise(400)
    values[[40, 170, 333], 1] = 1.0
    for begin in (40, 333):
        values[begin : begin + 10, 2] = 1.0
    mean = trust_of_means(values)
    assert mean.flags.tolist() == [YES, UNKNOWN, UNKNOWN, UNKNOWN]
    assert mean.lack == "variance from fewer than 12 looks"


def test_each_element_of_a_table_has_the_flag_of_its_own_series():
    """Of two rows and three columns an element has a few visits, and another has few frames."""
    values = noise((400, 2, 3))
    values[:, 0, 2] = 0.0
    values[[40, 170, 333], 0, 2] = 1.0
    values[10:, 1, 0] = math.nan
    expected = [[YES, YES, UNKNOWN], [UNKNOWN, YES, YES]]
    assert trust_of_means(values).flags.tolist() == expected


def test_few_or_correlated_frames_are_not_trusted():
    values = np.column_stack([np.cos(np.linspace(0.0, np.pi, 400)), noise(400)])
    mean = trust_of_means(values)
    assert mean.flags.tolist() == [UNKNOWN, YES]
    assert mean.lack == "shorter than 6 autocorrelation times"
    values[8:, 1] = math.nan
    assert trust_of_means(values).lack == (
        "fewer than 12 looks; shorter than 6 autocorrelation times"
    )
    values[:, 1] = math.nan
    assert trust_of_means(values).flags.tolist() == [UNKNOWN, UNKNOWN]


def test_effective_samples_of_a_gaussian_are_its_blocks():
    white = np.array([effective_samples(noise(600, seed=seed), 1.0) for seed in range(40)])
    assert np.median(white) == pytest.approx(600, rel=0.05)
    slow = np.repeat(noise((40, 120)), 5, axis=1)
    assert np.median([effective_samples(series, 5.0) for series in slow]) == pytest.approx(
        600 / 5, rel=0.15
    )
    assert effective_samples(np.zeros(30), 1.0) == effective_samples(np.ones(30), math.nan) == 0.0
    assert effective_samples(np.empty(0), 1.0) == 0.0
    assert effective_samples(np.eye(1, 30)[0], 1.0) == pytest.approx(3.0)


# ------------------------------------------------------------------------ other protocols


def test_replicas_of_a_cooling_gas_are_trusted_with_its_r():
    four_replicas, eight_replicas = (
        point(["cumulants"], schedule={"kind": "cooling", **COOLED, "replicas": n}, **GAS)
        for n in (4, 8)
    )
    assert (four_replicas.R_ci95_trusted, four_replicas.a20_trusted) == (UNKNOWN, UNKNOWN)
    assert eight_replicas.a20_trusted == eight_replicas.R_ci95_trusted != UNKNOWN
    values = [{"x": np.array([[x, math.nan]])} for x in noise(5)]
    mean = averaged(dict, values)
    cooling = ObservedWindow(YES, math.inf, math.inf)
    statistics = mean.value["x"], mean.stderr["x"], mean.sample_size["x"]
    trust = trust_in(*statistics, cooling, math.inf)
    assert trust.flags.tolist() == [YES, UNKNOWN] and trust.lack == "fewer than 5 replicas"


@pytest.mark.slow
def test_a_gas_through_stages_is_not_known_to_be_steady():
    schedule = {"kind": "stages", "sample_every": 1.0, "stages": [{"duration": 30.0}]}
    effects = SPIN | {"shear": {"velocity": 1}}
    mean = point(["cumulants"], **(GAS | {"effects": effects, "schedule": schedule}))
    assert mean.a20_trusted == UNKNOWN and mean.a20_trusted.comment == "steady state not known"


@pytest.mark.slow
def test_functions_of_users_have_no_known_window_length():
    effects = SPIN | {"shear": {"velocity": 1}}
    schedule = STEADY | {"equilibrate": 400, "measure": 1000, "sample_every": 2, "period": 2}
    energy = {"energy": lambda frame: frame.energy.mean()}
    mean = point(energy, **(GAS | {"effects": effects, "schedule": schedule}))
    assert mean.equilibrated == YES and mean.energy_trusted == UNKNOWN
    assert mean.energy_trusted.comment == "needed length of the window not known"
    assert Observable.relaxations == math.inf


@pytest.mark.slow
def test_each_species_has_separate_flags(lenient_trust):
    effects = SPIN | {"thermostat": {"power": 1, "spin_share": 0, "interval": 1}}
    schedule = STEADY | {"sample_every": 0.5, "period": 0.5}
    scene = GAS | {"effects": effects, "schedule": schedule, "species": MIXED}
    mean = point({"cumulants": {}, "profiles": {"bins": 3}}, **scene)
    assert mean.a20_species_trusted.dims == ("species",)
    assert mean.flow_profile_species_trusted.dims == mean.flow_profile_species.dims
    assert mean.a20_species_trusted.dtype == np.int8


# ------------------------------------------------------------------------ flags in output


def test_reduced_datasets_have_the_share_of_trusted_seeds():
    schedule = {"kind": "cooling", **COOLED, "replicas": 8}
    scene = GAS | {"schedule": schedule, "observe": ["cumulants", "profiles"]}
    seeds = [simulate(r=0.9, beta=0.0, seed=n, progress=False, **scene) for n in (1, 2, 3)]
    reduced = simulate(r=0.9, beta=[0.0], seed=[1, 2, 3], progress=False, **scene).isel(beta=0)
    for name in ("a20_trusted", "flow_profile_trusted"):
        flags = np.array([dataset[name].values for dataset in seeds])
        unknown = (flags == UNKNOWN).mean(axis=0) >= 0.5
        expected = np.where(unknown, UNKNOWN, (flags == YES).mean(axis=0))
        assert reduced[name].values.squeeze() == pytest.approx(expected)
    assert reduced.flow_profile_trusted.dims == reduced.flow_profile.dims


@pytest.mark.slow
def test_show_marks_untrusted_numbers_and_gives_the_reason(lenient_trust):
    mean = point({"cumulants": {"every": 20}, "profiles": {"every": 20, "bins": 10}}, **BED)
    text = observed_table(mean)
    a20, flow = (
        next(line for line in text.splitlines() if line.startswith(name))
        for name in ("a20", "flow_profile")
    )
    assert ")? " in a20 and "20 of 20 ?" in flow
    assert "\n  1 phase of the drive, 16 needed: " in text
    longer = BED | {"schedule": BED["schedule"] | {"measure": 240}}
    assert "?" not in observed_table(point(["cumulants"], **longer))


# ------------------------------------------------------------------------ calibration of trust

HEATED = {
    "particles": 40,
    "box": (25, 25),
    "effects": SPIN | {"thermostat": {"power": 0.1, "interval": 0.5, "spin_share": 0}},
}
RELAXATION = 5.8  # T, by theory
RUNS, MISSED_SHARE = 80, 0.08
SETTINGS = {"spin_correlation": {}, "pair_correlation": {"bins": 4, "reach": 6.0}}


@pytest.mark.slow
@pytest.mark.parametrize("kind", SETTINGS)
def test_trusted_intervals_miss_as_rarely_as_they_say(kind):
    """They miss the mean of all runs, with the needed window, up to two binomial errors.

    Half of the elements or more are trusted, and none in half of the window.
    """
    relaxations = OBSERVABLES[kind].relaxations
    short, long = (
        _heated_runs(kind, 0.5 * relaxations, 3),
        _heated_runs(kind, 1.1 * relaxations, RUNS),
    )
    assert not any(
        (dataset[f"{name}_trusted"] == YES).any()
        for dataset in short
        for name in _judged_variables(dataset)
    )
    away, flags = [], []
    for name in _judged_variables(long[0]):
        values, stderr, dof, trust = (
            np.array([dataset[f"{name}{end}"].values.ravel() for dataset in long])
            for end in ("", "_stderr", "_dof", "_trusted")
        )
        half = np.vectorize(half_width)(stderr, dof, 0.95)
        away.append(abs(values - values.mean(axis=0)) > half)
        flags.append(trust == YES)
    missed, sure = np.hstack(away), np.hstack(flags)
    count = np.count_nonzero(sure)
    assert count > 0.5 * sure.size
    allowed = MISSED_SHARE + 2.0 * math.sqrt(MISSED_SHARE * (1.0 - MISSED_SHARE) / count)
    assert np.count_nonzero(missed & sure) <= allowed * count


def _heated_runs(kind, relaxations, runs):
    schedule = {"kind": "steady", "equilibrate": 60, "sample_every": 1.04}
    schedule["measure"] = math.ceil(relaxations * RELAXATION)
    observe = {kind: SETTINGS[kind]}
    return [point(observe, **HEATED, schedule=schedule, seed=n) for n in range(runs)]


def _judged_variables(mean):
    names = [str(name) for name in mean.data_vars if "observable" in mean[name].attrs]
    return [name for name in names if f"{name}_trusted" in mean]


# ------------------------------------------------------------------------ unknown verdicts


WEAK = {"langevin": {"interval": 0.5, "drag": 5e-3, "temperature": 1.0}}


@pytest.mark.slow
def test_flows_that_last_need_a_longer_window():
    """In a bath of weak drag the total momentum lasts 200 T, and temperatures 15."""
    timing = STEADY | {"equilibrate": 100, "measure": 3000}
    dataset = point(
        {"profiles": {"bins": 2}, "histograms": {}},
        **GAS | {"effects": SPIN | WEAK, "schedule": timing},
    )
    assert dataset.flow_relaxation == pytest.approx(200.0) and dataset.slowest_relaxation < 25.0
    assert (dataset.flow_profile_trusted == UNKNOWN).all()
    assert (dataset.velocity_histogram_trusted == YES).any()


@pytest.mark.parametrize(
    ("observe", "name"), [("profiles", "packing_profile"), ("cumulants", "a20")]
)
def test_observables_that_are_unreliable_in_beds_have_no_verdict_there(observe, name):
    long = BED | {"schedule": BED["schedule"] | {"measure": 400}}
    dataset = point({observe: {}}, **long)
    assert dataset.equilibrated == YES and (dataset[f"{name}_trusted"] == UNKNOWN).all()
    assert "not known" in dataset[f"{name}_trusted"].comment


@pytest.mark.slow
def test_a_variable_whose_errors_are_too_small_is_never_trusted():
    timing = STEADY | {"equilibrate": 60, "measure": 1500}
    heated = {"thermostat": {"power": 0.1, "interval": 0.5, "spin_share": 0}}
    dataset = point({"stress": {}}, **GAS | {"effects": SPIN | heated, "schedule": timing})
    assert (dataset.stress_collisional_trusted == UNKNOWN).all()
    assert dataset.pressure_trusted == YES
