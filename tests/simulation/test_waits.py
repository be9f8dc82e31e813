"""Waits for relaxation times of theory: their lengths, and runs that wait."""

import math

import numpy as np
import pytest
from brute_force import begin, settings
from raw import build, run_point

from roughgas import config
from roughgas.base import merged
from roughgas.data.variables import POINT
from roughgas.simulation import steady
from roughgas.simulation.experiment_reader import read_experiment
from roughgas.simulation.gas_memory import ThermalState, gas_memory
from roughgas.theory import collision_frequency, number_density, thermal_conductivity
from roughgas.theory.relaxation import FIRST_ZERO_OF_J0, conduction_time

WAITING = {"kind": "steady", "equilibrate": 30, "measure": 60, "sample_every": 0.5}
SHEARED = settings("sheared", 40, [25, 25]) | {"schedule": WAITING}
BED = settings("bed", 40, [12.5, "open"])
BED |= {"schedule": WAITING | {"equilibrate": 2.5, "sample_every": 0.25, "period": 1}}
WAIT_VARIABLES = {"wait", "wait_relaxations"}
DILUTE = 1e-4
"""Packing fraction at which formulae for dilute gases are compared."""
SLOW_BEDS = {
    (0.99, 1.0): (979.5, 0.501, 0.25, 1760.0),
    (0.99, -0.95): (284.4, 0.00873, 0.445, 480.0),
    (0.99, -0.9): (135.2, 0.0173, 0.64, 215.0),
}
"""E_trans, R, contacts of a particle per T and the e-fold (T) of the transient of E_trans, as
measured in beds of the paper by r and beta: means over 12 to 24 runs, the e-folds to 7 %."""
LEAN_WAITS = {(0.99, 1.0): (19_000, 21_500), (0.9, 0.0): (500, 500), (0.6, 0.0): (500, 500)}
"""Least and largest waits (T) of the vibrated bed at the scale `lean`, by r and beta."""


def variables_of(experiment, **schedule):
    """The variables of a point with changes of its schedule."""
    changed = merged(experiment, {"schedule": schedule})
    return run_point(begin(changed, 0.9, 0.0)[0], changed, 1).variables


@pytest.mark.parametrize("experiment", [SHEARED, BED], ids=["sheared", "bed"])
def test_a_run_waits_and_has_the_bits_of_a_run_with_that_wait(experiment):
    waiting = variables_of(experiment, relaxation_times=3)
    wait, unit = waiting["wait"], experiment["schedule"].get("period", 0.5)
    assert wait > experiment["schedule"]["equilibrate"] and wait % unit == 0.0
    assert waiting["measured_from"] >= wait
    assert waiting["wait_relaxations"] >= 3.0
    planned = variables_of(experiment, equilibrate=wait)
    assert waiting.keys() - planned.keys() == WAIT_VARIABLES <= POINT.keys()
    for name in planned.keys() - {"kernel_seconds"}:
        np.testing.assert_array_equal(waiting[name], planned[name], name)


def test_a_wait_is_never_shorter_than_the_schedule_and_says_where_it_is_cut(monkeypatch):
    short = variables_of(SHEARED, relaxation_times=0.1)
    assert short["wait"] == 30.0 and short["wait_relaxations"] > 0.1
    monkeypatch.setattr(steady, "WAIT_LIMIT", 2)
    cut = variables_of(SHEARED, relaxation_times=1e6)
    assert cut["wait"] == 60.0 and cut["wait_relaxations"] < 5.0


def wait_by(settling_time, **changes):
    """The wait for five e-folds, and the waits after which theory was asked for one."""
    asked = []

    def settling(wait):
        asked.append(wait)
        return settling_time(wait)

    schedule = read_experiment(merged(SHEARED, {"schedule": {"relaxation_times": 5} | changes}))
    waiting, variables = steady._with_relaxed_start(schedule.schedule, settling)
    assert waiting.equilibrate == variables["wait"] == asked[-1]
    assert variables["wait_relaxations"] == variables["wait"] / settling_time(variables["wait"])
    return variables["wait"], asked


def test_theory_is_asked_again_while_the_gas_still_changes():
    """An e-fold that grows from 1 T to 40 T as the gas is heated, and one that falls."""
    assert wait_by(lambda wait: 5.0) == (30.0, [30.0])
    assert wait_by(lambda wait: 7.7) == (38.5, [30.0, 38.5])
    assert wait_by(lambda wait: 40.0 * (1.0 - math.exp(-wait / 40.0)))[0] == pytest.approx(200, 0.02)
    assert wait_by(lambda wait: 3000.0 / wait) == (60.0, [30.0, 60.0])
    assert wait_by(lambda wait: math.inf)[0] == 3000.0  # a hundred times
    assert wait_by(lambda wait: 7.3, sample_every=1.0, period=4.0) == (40.0, [30.0, 40.0])


def test_a_wait_has_no_more_samples_than_a_run_may_have(monkeypatch):
    monkeypatch.setattr(steady, "SAMPLE_LIMIT", 400)
    assert wait_by(lambda wait: math.inf) == (140.0, [30.0, 60.0, 120.0, 140.0])
    monkeypatch.setattr(steady, "SAMPLE_LIMIT", 1)
    assert wait_by(lambda wait: math.inf) == (30.0, [30.0])


def settling_of_bed(r, beta, E_trans, R, frequency):
    """The e-fold (T) of the transient of a bed of the paper, by theory in a measured state."""
    bed = config.load_experiment(config.SHIPPED, "vibrated", "paper").raw
    T_tr = 2.0 * E_trans
    state = ThermalState(
        np.array([T_tr]), np.array([T_tr * R / (1.0 - R)]), frequency, 160, (50.0, math.inf)
    )
    return gas_memory(build(bed, r, beta), state).settling


@pytest.mark.parametrize("point", SLOW_BEDS)
def test_slow_beds_settle_as_theory_says(point):
    """To a fourth; with a constant height, or under a constant power, theory would be far off."""
    *state, measured = SLOW_BEDS[point]
    assert settling_of_bed(*point, *state) / measured == pytest.approx(1.0, abs=0.25)


def test_the_height_of_an_elastic_bed_slows_it_down_by_ten_thirds():
    """The heat capacity rises from 3/2 to 5/2; the losses grow as T^(1/2) and not as T."""
    E_trans, frequency, loss = 1e4, 0.1, 2e-4 * frequency_share()
    bed = config.load_experiment(config.SHIPPED, "vibrated", "paper").raw
