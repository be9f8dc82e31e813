"""Plans: the law of large numbers, and how long a gas needs."""

import math
from pathlib import Path

import numpy as np
import pytest

from roughgas import config
from roughgas.planning.cooling import REPLICAS
from roughgas.planning.lengths import BIAS, CARE, RESERVE, relaxation
from roughgas.planning.pilot import Pilot
from roughgas.planning.plan import added, plan_point, share_of_pilots
from roughgas.planning.steady import TWICE
from roughgas.scene import build
from roughgas.theory import cooling_ratio, lun_ratio, relax

PILOT = Pilot(
    transient=40.0,
    autocorrelation_time=10.0,
    variance=0.081,
    dof=50.0,
    pace=0.5,
    seconds_per_length=1e-3,
    settled=True,
    length=5000.0,
    seconds=5.0,
)


def planned(experiment, beta, pilot):
    return plan_point(build(experiment, 0.9, beta), experiment, pilot)


def with_target(experiment, target):
    return experiment | {"target_stderr": target}


def test_seeds_are_as_many_as_the_error_calls_for_and_no_more(sheared):
    plan = planned(with_target(sheared, 0.004), 0.0, PILOT)
    length = plan.schedule["measure"]
    assert math.sqrt(PILOT.variance / (plan.seeds * length)) == pytest.approx(plan.stderr)
    aim = RESERVE * 0.004
    assert plan.stderr <= aim < math.sqrt(PILOT.variance / ((plan.seeds - 1) * length))


@pytest.mark.parametrize("name", ["sheared", "cooling"])
def test_half_the_error_costs_four_times_as_much(name, request):
    """But for whole seeds, and for one more half-life of what is left of the transient."""
    experiment = request.getfixturevalue(name)
    pilot = PILOT._replace(variance=2.0)
    one, two = (planned(with_target(experiment, target), 0.0, pilot) for target in (0.004, 0.002))
    assert two.seconds / one.seconds == pytest.approx(4, rel=0.1)
    assert two.seeds / one.seeds == pytest.approx(4, rel=0.1)


def test_a_run_waits_for_the_slower_of_energies_and_spin(sheared):
    slow, fast = (planned(sheared, beta, PILOT).schedule["equilibrate"] for beta in (-0.95, 0.5))
    scene = build(sheared, 0.9, -0.95)
    assert fast == TWICE * PILOT.transient
    assert (
        slow
        == math.ceil(relaxation(scene, BIAS * 0.01, lun_ratio(-0.95, 0.5), 0.0) / PILOT.pace)
        > fast
    )


def test_a_run_is_measured_for_many_times_what_it_remembers(sheared):
    assert planned(sheared, 0.5, PILOT).schedule["measure"] == 200
    forgetful = PILOT._replace(autocorrelation_time=0.1)
    plan = planned(sheared, 0.5, forgetful)
    assert plan.schedule["measure"] == plan.schedule["equilibrate"]


def test_a_run_is_no_longer_than_it_need_be(sheared):
    still = PILOT._replace(variance=1e-5, autocorrelation_time=0.1)
    plan = planned(sheared, 0.5, still)
    assert plan.schedule["measure"] == 20 and plan.seeds == 1
    assert plan.stderr < sheared["target_stderr"] / 2


@pytest.mark.parametrize(("needed", "dof"), [(0.7, 10), (1.0, 10), (0.95, 60)])
def test_added_seeds_are_those_of_gaussian_noise(needed, dof):
    """By a sum over a million draws: 4 sigma."""
    noise = np.random.default_rng(1).standard_normal(1_000_000)
    lacking = np.maximum(needed * (1 + math.sqrt(2 / dof) * noise) - 1, 0)
    assert abs(added(needed, dof) - lacking.mean()) < 4 * lacking.std() / 1000
    assert added(0.0, dof) == 0


@pytest.mark.parametrize("beta", [-0.5, 0.0, 1.0])
@pytest.mark.parametrize("cooling", [True, False])
def test_after_the_relaxation_theory_is_within_what_is_tolerated(sheared, beta, cooling):
    scene, tolerated = build(sheared, 0.9, beta), 0.001
    final = cooling_ratio(0.9, beta) if cooling else lun_ratio(beta, 0.5)
    share = None if cooling else 0.0
    needed = relaxation(scene, tolerated, final, share) / CARE
    theta = relax(0.0, 0.9, beta, needed, spin_share=share).theta
    assert abs(theta / (1 + theta) - final) == pytest.approx(tolerated, rel=1e-6)


def test_lengths_that_are_set_are_taken_as_they_are(sheared):
    schedule = sheared["schedule"] | {"equilibrate": 100, "measure": 400}
    experiment = {key: value for key, value in sheared.items() if key != "target_stderr"}
    experiment |= {"schedule": schedule, "sweep": {"seeds": 3}}
    plan = planned(experiment, 0.0, PILOT)
    assert plan.schedule == schedule and plan.seeds == 3
    assert plan.stderr == pytest.approx(math.sqrt(PILOT.variance / 1200))
    assert plan.seconds == pytest.approx(1.5)
    assert plan.collisions == pytest.approx(1500 * PILOT.pace * sheared["particles"] / 2)


def test_a_cooling_seed_is_several_replicas(cooling):
    plan = planned(cooling, 0.0, PILOT)
    assert plan.schedule["replicas"] == REPLICAS
    assert plan.stderr == pytest.approx(
        math.sqrt(PILOT.variance / (plan.seeds * REPLICAS * plan.schedule["plateau"]))
    )


def test_pilots_are_dear_where_runs_are_short():
    """At the scale `small` they cost as much as the run, at that of the paper a part of it."""
    whole = config.load(Path(__file__).parents[2] / "config.yaml")

    def share(scale):
        return share_of_pilots([config.experiment(whole, "vibrated", scale)])

    assert share("paper") < 0.3 < 1.0 < share("small") < 3.0 and share("fine") == 0.0
