"""What a point says of itself: whatever it calls counted was counted, whatever it calls trusted is
right, and what ends early says so."""

import math
from contextlib import nullcontext
from dataclasses import dataclass

import numpy as np
import pytest
from brute_force import begin, settings
from hypothesis import HealthCheck, Phase, given, seed
from hypothesis import settings as profile
from hypothesis import strategies as st

from roughgas.base import InputError, SilentError
from roughgas.kernel import loop
from roughgas.simulation import cooling, schedule, steady
from roughgas.simulation.gas import Gas
from roughgas.simulation.recorder import Recorder
from roughgas.statistics.errors import LEAST, NO, UNKNOWN, YES, gaussian_sigmas

STEADY = {"kind": "steady", "equilibrate": 20.0, "measure": 20.0, "sample_every": 1.0}
COOLING = {
    "kind": "cooling",
    "replicas": 6,
    "thermalise": 2.0,
    "relaxation_times": 16.0,
    "plateau": 30.0,
    "sample_every": 1.0,
}
FAR = 5.0  # sigma, of a Gaussian: by chance once in two million
LONGER = 10
TRIED = 300
SHARE = 0.1  # of the scenes that must be trusted, lest a verdict that trusts nothing passes


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
        """Its settings: a bed is as wide as five particles and has a drive with a period."""
        side = math.sqrt(self.particles * math.pi / self.packing)
        box = [side, "open"] if self.kernel == "bed" else [side, side]
        found = settings(self.kernel, self.particles, box) | {"schedule": self.schedule}
        schedule.check(found)
        return found

    def measured(self, number=1, **longer):
        """The variables of the point, and the recorder of what it has cost."""
        recorder, experiment = Recorder(keep=1), self.experiment
        experiment["schedule"] = self.schedule | longer
        scene, _ = begin(experiment, self.r, self.beta)
        return schedule.of(experiment).run(scene, experiment, number, recorder), recorder


def lengths(low, high):
    """Positive numbers, evenly spread over their orders of magnitude."""
    return st.floats(math.log(low), math.log(high)).map(lambda x: float(f"{math.exp(x):.3g}"))


def runs(kernels, shortest=0.3, longest=3000.0, thinnest=1e-5, replicas=12):
    """Random legal points, with schedules from absurdly short to sensible."""
    steady_ones = st.fixed_dictionaries(
        {
            "kind": st.just("steady"),
            "equilibrate": lengths(0.1, 1000),
            "measure": lengths(shortest, longest),
            "sample_every": lengths(0.1, 30),
        }
    )
    cooling_ones = st.fixed_dictionaries(
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
        own = cooling_ones if kernel == "gas" else steady_ones
        if kernel == "bed":
            every = st.sampled_from([1 / 32, 0.05, 0.1, 0.25, 0.5])
            own = st.tuples(own, every).map(
                lambda pair: pair[0] | {"sample_every": pair[1], "period": 1.0}
            )
        return st.builds(
            Run,
            st.just(kernel),
            st.integers(5, 60),
            lengths(thinnest, 0.4) if kernel != "bed" else st.floats(0.1, 0.4),
            st.sampled_from([0.75, 0.9, 0.97]),
            st.sampled_from([-0.9, -0.5, 0.0, 0.5, 1.0]),
            own,
        )

    return st.sampled_from(kernels).flatmap(points).filter(is_legal)


def is_legal(run):
    """Whether its settings are: a plateau that is shorter than a sample is not."""
    try:
        return bool(run.experiment)
    except InputError:
        return False


def tried(number):
    """So many random examples, the same each time."""
    off = dict(deadline=None, database=None, suppress_health_check=list(HealthCheck))
    off["phases"] = [Phase.generate]
    return lambda test: seed(1)(profile(max_examples=number, **off)(test))


@tried(20)
@given(runs(["gas"]))
def test_a_cooling_gas_has_made_the_collisions_that_it_says(run):
    """As many as all its replicas have been counted to make, the smooth elastic ones left out."""
    found, recorder = run.measured()
    number, replicas = run.particles, run.schedule["replicas"]
    before = math.ceil(number / 2 * run.schedule["thermalise"])
    passed = found["collisions_per_particle"]
    assert passed[-1] * number / 2 == pytest.approx(recorder.collisions / replicas - before)
    asked = run.schedule["plateau"] + cooling.transient_length(*_theory(run))
    assert asked <= passed[-1] * (1 + 1e-12) and passed[-1] - asked <= passed[0]
    inside = (passed >= found["measured_from"]) & (passed <= found["plateau_end"])
    assert found["measured_collisions"] == pytest.approx(inside.sum() * passed[0])


def _theory(run):
    scene, _ = begin(run.experiment, run.r, run.beta)
    return scene, run.schedule["relaxation_times"]


@tried(20)
@given(runs(["sheared", "heated"]))
def test_a_driven_gas_has_made_the_collisions_that_it_says(run):
    """As many as are counted when it is stopped where the measurement begins and goes on."""
    found, recorder = run.measured()
    (gas,) = recorder.gases
    scene, _ = begin(run.experiment, run.r, run.beta)
    other, every = steady.start(scene, run.experiment, 1), run.schedule["sample_every"]
    other.in_time(every, round(found["measured_from"] / every))
    assert other.time == pytest.approx(found["measured_from"])
    counted = 2 * (recorder.collisions - other.collisions) / run.particles
    assert found["measured_collisions"] == pytest.approx(counted)
    assert gas.time == pytest.approx(found["time"][-1])


@tried(20)
@given(runs(["gas", "sheared", "heated"], shortest=0.05))
def test_nothing_is_known_without_evidence(run):
    """Whatever has fewer collisions, samples or replicas than the least is neither yes nor no."""
    found, _ = run.measured()
    every = run.schedule["sample_every"]
    few = run.schedule.get("replicas", math.inf) < LEAST.runs
    few |= run.schedule.get("measure", math.inf) / every < LEAST.samples - 1
    if found["measured_collisions"] < LEAST.collisions or few:
        assert found["equilibrated"] == found["R_ci95_trusted"] == UNKNOWN
    if found["R_ci95_trusted"] == YES:
        assert found["equilibrated"] == YES and found["R_stderr"] > 0


@pytest.mark.slow
def test_what_is_trusted_is_right():
    """Within 5 errors of a run ten times as long with another seed, in random scenes.

    Errors have their degrees of freedom. None of the 300 may fail: by chance one does in
    some thousand runs of this test.
    """
    verdicts, wrong = [], []

    @tried(TRIED)
    @given(runs(["gas", "sheared", "heated", "bed"], 200.0, 1e4, thinnest=0.01, replicas=40))
    def look(run):
        found, _ = run.measured(1)
        verdicts.append(found["R_ci95_trusted"])
        if verdicts[-1] == YES:
            key = "plateau" if run.kernel == "gas" else "measure"
            other, _ = run.measured(2, **{key: LONGER * run.schedule[key]})
            off = sigmas(found, other)
            if not abs(off) < FAR:
                wrong.append((round(off, 1), run, found["R"], other["R"]))

    look()
    assert verdicts.count(YES) > SHARE * len(verdicts)
    assert {NO, UNKNOWN} <= set(verdicts)
    assert not wrong, "\n".join(map(str, wrong))


def sigmas(one, other):
    """By how many sigma R of two points differs, with the degrees of freedom of Welch."""
    squares = np.array([one["R_stderr"], other["R_stderr"]]) ** 2
    dof = squares.sum() ** 2 / (squares**2 / [one["R_dof"], other["R_dof"]]).sum()
    return float(gaussian_sigmas((one["R"] - other["R"]) / math.sqrt(squares.sum()), dof))


# ------------------------------------------------------------------------ what ends early


@pytest.mark.slow
def test_collisions_that_do_not_come_end_a_run_in_one_line():
    """Two disks side by side never meet: no sample is handed over in place of the one wanted."""
    gas = beside_each_other()
    with pytest.raises(SilentError, match=r"do not meet any longer at t = .* after 0 collisions"):
        gas.in_collisions(1, 3)


def test_a_time_is_waited_for_however_long():
    """A sample of a hundred thousand crossings of the box has its whole length."""
    gas = beside_each_other()
    times = gas.in_time(1e6, 2)["time"]
    assert np.array_equal(times, [1e6, 2e6])
    assert loop.SILENCE[1] * 20.0 < 1e6


def beside_each_other():
    experiment = settings("gas", 2, [20, 20])
    scene, state = begin(experiment, 0.9, 0.0)
    state.trajectory[:, :4] = [[5.0, 5.0, 1.0, 0.0], [5.0, 15.0, 1.0, 0.0]]
    return Gas(scene, state)


@pytest.mark.parametrize(("particles", "packing"), [(40, 1e-8), (5, 1e-6)])
def test_a_dilute_gas_makes_all_its_collisions(particles, packing):
    """Thousands of crossings of the box lie between two collisions."""
    run = Run("gas", particles, packing, 0.9, 0.5, COOLING | {"replicas": 2, "plateau": 5.0})
    found, recorder = run.measured()
    made = 2 * recorder.collisions / 2 / particles - run.schedule["thermalise"]
    assert found["collisions_per_particle"][-1] == pytest.approx(made, abs=2 / particles)


def test_a_gas_in_which_nothing_collides_is_not_trusted():
    run = Run("sheared", 40, 1e-7, 0.9, 0.0, STEADY | {"measure": 100.0})
    found, recorder = run.measured()
    assert recorder.collisions < LEAST.collisions * 20
    assert found["equilibrated"] == found["R_ci95_trusted"] == UNKNOWN


def test_a_bed_seen_at_few_phases_of_its_floor_is_not_trusted():
    """The same bed, seen at one phase and at twenty."""
    whole = {**STEADY, "equilibrate": 300.0, "measure": 2000.0, "period": 1.0}
    bed = Run("bed", 40, 0.2, 0.8, 0.0, whole)
    once = bed.measured()[0]
    bed.schedule = whole | {"sample_every": 0.05}
    often = bed.measured()[0]
    assert often["R_ci95_trusted"] == YES
    assert (once["R_ci95_trusted"], once["equilibrated"]) == (UNKNOWN, YES)
    assert abs(once["R"] - often["R"]) > 5 * math.hypot(once["R_stderr"], often["R_stderr"])


# ------------------------------------------------------------------------ schedules


def test_a_period_of_several_strokes_and_the_phases_that_it_shows():
    """Three strokes in four samples: four phases; four strokes in four: one."""
    for period, every, phases in ((3.0, 0.75, 4), (4.0, 1.0, 1), (2.0, 0.05, 20)):
        run = Run("bed", 10, 0.2, 0.9, 0.0, STEADY | {"period": period, "sample_every": every})
        scene, _ = begin(run.experiment, 0.9, 0.0)
        assert steady.phases(scene, run.schedule) == phases


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
    """A period of samples that is no multiple of its own would see some of its phases alone."""
    experiment = settings("sheared", 10, [20, 20]) | {"schedule": STEADY | {"period": 3.0}}
    experiment["effects"] = {"bottom_wall": {}, "lid": wall}
    with nullcontext() if legal else pytest.raises(InputError, match="that of lid, 2 T"):
        schedule.check(experiment)
