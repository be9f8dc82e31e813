"""Verdicts and counts of points are true: collisions were made, trusted values are right, and early
ends are reported."""

import math
from contextlib import nullcontext
from dataclasses import dataclass

import numpy as np
import pytest
from brute_force import begin, settings
from campaigns import tries
from hypothesis import HealthCheck, Phase, given, seed
from hypothesis import settings as profile
from hypothesis import strategies as st
from raw import cooling, protocols, steady, typed

from roughgas.base import InputError, SilentError
from roughgas.kernel import loop
from roughgas.simulation.gas import Gas
from roughgas.simulation.simulation import Simulation
from roughgas.statistics.sample_sizes import MINIMUM_SAMPLE_SIZE, NO, UNKNOWN, YES
from roughgas.statistics.student import wallace_sigmas

STEADY = {"kind": "steady", "equilibrate": 20.0, "measure": 20.0, "sample_every": 1.0}
COOLING = {
    "kind": "cooling",
    "replicas": 6,
    "thermalise": 2.0,
    "relaxation_times": 16.0,
    "plateau": 30.0,
    "sample_every": 1.0,
}
LARGEST_DEVIATION = 5.0  # sigma, of a Gaussian: by chance once in two million
LENGTH_RATIO = 10
EXAMPLES = tries(100)
LEAST_TRUSTED_SHARE = 0.1  # least share of trusted scenes: a verdict that trusts nothing is useless


@dataclass
class Run:
    """A point of a random scene with a random schedule."""

    kernel: str
    particles: int
    packing: float
    r: float
    beta: float
    schedule: dict

    @property
    def experiment(self):
        """Settings of the point, checked; a bed is open above."""
        side = math.sqrt(self.particles * math.pi / self.packing)
        box = [side, "open"] if self.kernel == "bed" else [side, side]
        experiment = settings(self.kernel, self.particles, box) | {"schedule": self.schedule}
        protocols.check_experiment(experiment)
        return experiment

    def measured(self, seed_number=1, **schedule_changes):
        """(variables of the point, Simulation that measured them)."""
        simulation, raw = (
            Simulation(),
            self.experiment | {"schedule": self.schedule | schedule_changes},
        )
        experiment = typed(raw)
        scene, _ = begin(experiment, self.r, self.beta)
        return protocols.protocol_of(experiment).run(
            scene, experiment, seed_number, simulation
        ), simulation


def lengths(low, high):
    """Positive numbers, log-uniform between two bounds."""
    return st.floats(math.log(low), math.log(high)).map(lambda x: float(f"{math.exp(x):.3g}"))


def runs(kernels, shortest=0.3, longest=3000.0, thinnest=1e-5, replicas=12):
    """Random legal runs, with schedules from absurdly short to sensible."""
    steady_schedules = st.fixed_dictionaries(
        {
            "kind": st.just("steady"),
            "equilibrate": lengths(0.1, 1000),
            "measure": lengths(shortest, longest),
            "sample_every": lengths(0.1, 30),
        }
    )
    cooling_schedules = st.fixed_dictionaries(
        {
            "kind": st.just("cooling"),
            "replicas": st.integers(2, replicas),
            "thermalise": lengths(0.1, 20),
            "relaxation_times": lengths(0.5, 30),
            "plateau": lengths(shortest, 200),
            "sample_every": lengths(0.01, 25),
        }
    )

    def points(kernel):
        schedules = cooling_schedules if kernel == "gas" else steady_schedules
        if kernel == "bed":
            every = st.sampled_from([1 / 32, 0.05, 0.1, 0.25, 0.5])
            schedules = st.tuples(schedules, every).map(
                lambda pair: pair[0] | {"sample_every": pair[1], "period": 1.0}
            )
        return st.builds(
            Run,
            st.just(kernel),
            st.integers(5, 60),
            lengths(thinnest, 0.4) if kernel != "bed" else st.floats(0.1, 0.4),
            st.sampled_from([0.75, 0.9, 0.97]),
            st.sampled_from([-0.9, -0.5, 0.0, 0.5, 1.0]),
            schedules,
        )

    return st.sampled_from(kernels).flatmap(points).filter(is_legal)


def is_legal(run):
    """Whether its settings are legal: a plateau shorter than a sample is not."""
    try:
        return bool(run.experiment)
    except InputError:
        return False


def random_examples(number):
    """A decorator for a number of random examples, the same in each session."""
    off = dict(deadline=None, database=None, suppress_health_check=list(HealthCheck))
    off["phases"] = [Phase.generate]
    return lambda test: seed(1)(profile(max_examples=number, **off)(test))


@pytest.mark.slow
@random_examples(20)
@given(runs(["gas"]))
def test_a_cooling_gas_has_made_the_collisions_that_it_says(run):
    """Counted over all replicas, without the smooth elastic collisions of the thermalisation."""
    variables, simulation = run.measured()
    number, replicas = run.particles, run.schedule["replicas"]
    thermalisation = math.ceil(number / 2 * run.schedule["thermalise"])
    passed = variables["collisions_per_particle"]
    assert passed[-1] * number / 2 == pytest.approx(
        simulation.costs.collisions / replicas - thermalisation
    )
    requested = run.schedule["plateau"] + cooling.transient_length(
        *_scene_and_relaxation_times(run)
    )
    assert requested <= passed[-1] * (1 + 1e-12) and passed[-1] - requested <= passed[0]
    inside = (passed >= variables["measured_from"]) & (passed <= variables["plateau_end"])
    assert variables["measured_collisions"] == pytest.approx(inside.sum() * passed[0])


def _scene_and_relaxation_times(run):
    """(scene, relaxation times of the schedule) of a run."""
    scene, _ = begin(run.experiment, run.r, run.beta)
    return scene, run.schedule["relaxation_times"]


@random_examples(20)
@given(runs(["sheared", "heated"]))
def test_a_driven_gas_has_made_the_collisions_that_it_says(run):
    """Counted from the start of the measurement on, against a run that is stopped there."""
    variables, simulation = run.measured()
    scene, _ = begin(run.experiment, run.r, run.beta)
    gas, every = steady.start(scene, run.experiment, 1), run.schedule["sample_every"]
    gas.in_time(every, round(variables["measured_from"] / every))
    assert gas.time == pytest.approx(variables["measured_from"])
    counted = 2 * (simulation.costs.collisions - gas.collisions) / run.particles
    assert variables["measured_collisions"] == pytest.approx(counted)
    assert variables["time"][-1] >= gas.time


@random_examples(20)
@given(runs(["gas", "sheared", "heated"], shortest=0.05))
def test_nothing_is_known_without_evidence(run):
    """With fewer collisions, samples or replicas than the least, a verdict is unknown."""
    variables, _ = run.measured()
    every = run.schedule["sample_every"]
    too_few = run.schedule.get("replicas", math.inf) < MINIMUM_SAMPLE_SIZE.runs
    too_few |= run.schedule.get("measure", math.inf) / every < MINIMUM_SAMPLE_SIZE.samples - 1
    if variables["measured_collisions"] < MINIMUM_SAMPLE_SIZE.collisions or too_few:
        assert variables["equilibrated"] == variables["R_ci95_trusted"] == UNKNOWN
    if variables["R_ci95_trusted"] == YES:
        assert variables["equilibrated"] == YES and variables["R_stderr"] > 0


@pytest.mark.slow
def test_trusted_values_are_right():
    """Within 5 errors of a run ten times longer with another seed, in random scenes.

    Errors have their degrees of freedom. None of 100 scenes may fail: by chance one fails in three
    thousand runs of this test.
    """
    verdicts, failures = [], []

    @random_examples(EXAMPLES)
    @given(runs(["gas", "sheared", "heated", "bed"], 200.0, 1e4, thinnest=0.01, replicas=40))
    def compare_with_longer_run(run):
        variables, _ = run.measured(1)
        verdicts.append(variables["R_ci95_trusted"])
        if verdicts[-1] == YES:
            key = "plateau" if run.kernel == "gas" else "measure"
            longer, _ = run.measured(2, **{key: LENGTH_RATIO * run.schedule[key]})
            deviation = sigmas(variables, longer)
            if not abs(deviation) < LARGEST_DEVIATION:
                failures.append((round(deviation, 1), run, variables["R"], longer["R"]))

    compare_with_longer_run()
    assert verdicts.count(YES) > LEAST_TRUSTED_SHARE * len(verdicts)
    assert {NO, UNKNOWN} <= set(verdicts)
    assert not failures, "\n".join(map(str, failures))


def sigmas(first, second):
    """The difference of R of two points in sigma, with Welch's degrees of freedom."""
    squares = np.array([first["R_stderr"], second["R_stderr"]]) ** 2
    dof = squares.sum() ** 2 / (squares**2 / [first["R_dof"], second["R_dof"]]).sum()
    return float(wallace_sigmas((first["R"] - second["R"]) / math.sqrt(squares.sum()), dof))


# ------------------------------------------------------------------------ early ends


@pytest.mark.slow
def test_collisions_that_do_not_come_end_a_run_in_one_line():
    """Two disks side by side never meet: no other sample is returned instead."""
    gas = disks_that_never_meet()
    with pytest.raises(SilentError, match=r"do not meet any longer at t = .* after 0 collisions"):
        gas.in_collisions(1, 3)


def test_samples_may_be_arbitrarily_long():
    """A sample of a hundred thousand crossings of the box has its full length."""
    gas = disks_that_never_meet()
    times = gas.in_time(1e6, 2)["time"]
    assert np.array_equal(times, [1e6, 2e6])
    assert loop.MIN_SILENT_SPANS * 20.0 < 1e6


def disks_that_never_meet():
    """A gas of two disks that move side by side."""
    experiment = settings("gas", 2, [20, 20])
    scene, state = begin(experiment, 0.9, 0.0)
    state.trajectory[:, :4] = [[5.0, 5.0, 1.0, 0.0], [5.0, 15.0, 1.0, 0.0]]
    return Gas(scene, state)


@pytest.mark.parametrize(("particles", "packing"), [(40, 1e-8), (5, 1e-6)])
def test_a_dilute_gas_makes_all_its_collisions(particles, packing):
    """Between two collisions, particles cross the box thousands of times."""
    run = Run("gas", particles, packing, 0.9, 0.5, COOLING | {"replicas": 2, "plateau": 5.0})
    variables, simulation = run.measured()
    collisions_made = 2 * simulation.costs.collisions / 2 / particles - run.schedule["thermalise"]
    assert variables["collisions_per_particle"][-1] == pytest.approx(
        collisions_made, abs=2 / particles
    )


def test_a_gas_in_which_nothing_collides_is_not_trusted():
    run = Run("sheared", 40, 1e-7, 0.9, 0.0, STEADY | {"measure": 100.0})
    variables, simulation = run.measured()
    assert simulation.costs.collisions < MINIMUM_SAMPLE_SIZE.collisions * 20
    assert variables["equilibrated"] == variables["R_ci95_trusted"] == UNKNOWN


def test_a_bed_seen_at_few_phases_of_its_floor_is_not_trusted():
    """The same bed, sampled at one phase and at twenty."""
    single_phase = {**STEADY, "equilibrate": 300.0, "measure": 2000.0, "period": 1.0}
    bed = Run("bed", 40, 0.2, 0.8, 0.0, single_phase)
    at_one_phase = bed.measured()[0]
    bed.schedule = single_phase | {"sample_every": 0.05}
    at_twenty_phases = bed.measured()[0]
    assert at_twenty_phases["R_ci95_trusted"] == YES
    assert (at_one_phase["R_ci95_trusted"], at_one_phase["equilibrated"]) == (UNKNOWN, YES)
    assert abs(at_one_phase["R"] - at_twenty_phases["R"]) > 5 * math.hypot(
        at_one_phase["R_stderr"], at_twenty_phases["R_stderr"]
    )


# ------------------------------------------------------------------------ schedules


def test_the_number_of_phases_follows_from_period_and_samples():
    """Three strokes in four samples show four phases, four strokes in four samples show one."""
    for period, every, phases in ((3.0, 0.75, 4), (4.0, 1.0, 1), (2.0, 0.05, 20)):
        run = Run("bed", 10, 0.2, 0.9, 0.0, STEADY | {"period": period, "sample_every": every})
        scene, _ = begin(run.experiment, 0.9, 0.0)
        assert steady.phases(scene, typed(run.experiment).schedule) == phases


@pytest.mark.parametrize(
    ("wall", "legal"),
    [
        ({"amplitude": 1, "period": 2, "wave": "sine"}, False),
        ({"amplitude": 1, "period": 2, "shaken": "along"}, False),
        ({"amplitude": 0, "period": 2, "velocity": 1}, True),
        ({"velocity": 1}, True),
    ],
)
def test_samples_show_all_phases_of_any_wall_that_is_shaken(wall, legal):
    """A period of samples that is no multiple of the wall's would show some phases only."""
    experiment = settings("sheared", 10, [20, 20]) | {"schedule": STEADY | {"period": 3.0}}
    experiment["effects"] = {"bottom_wall": {}, "lid": wall}
    with nullcontext() if legal else pytest.raises(InputError, match="that of lid, 2 T"):
        protocols.check_experiment(experiment)
