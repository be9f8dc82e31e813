"""Waits for relaxation times of theory: their lengths, and runs that wait."""

import json
import math

import numpy as np
import pytest
import xarray as xr
from brute_force import begin, settings
from raw import build, run_point
from tests.entry import main

from roughgas import config
from roughgas.base import merged
from roughgas.data.variables import POINT
from roughgas.simulation import steady
from roughgas.simulation.experiment_reader import read_experiment
from roughgas.simulation.gas_memory import ThermalState, gas_memory

WAITING = {"kind": "steady", "equilibrate": 30, "measure": 60, "sample_every": 0.5}
SHEARED = settings("sheared", 40, [25, 25]) | {"schedule": WAITING}
BED = settings("bed", 40, [12.5, "open"])
BED |= {"schedule": WAITING | {"equilibrate": 2.5, "sample_every": 0.25, "period": 1}}
WAIT_VARIABLES = {"wait", "wait_relaxations"}
WAIT_KEYS = "equilibrate", "relaxation_times"
PAPER_EXPERIMENTS = config.load(config.SHIPPED).studies["paper"].experiments
PAPER_BED = config.load_experiment(config.SHIPPED, "vibrated", "paper").raw
SLOW_BEDS = {
    (0.99, 1.0): (980.7, 0.501, 0.2466, 2030.0),
    (0.99, -0.95): (284.4, 0.0087, 0.445, 458.0),
    (0.99, -0.9): (135.2, 0.0173, 0.64, 215.0),
}
"""E_trans, R, contacts of a particle per T and the e-fold (T) of the transient of E_trans, as
measured in beds of the paper by r and beta: means over 12 to 48 runs, the e-folds to 7 %."""
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


def test_a_point_shows_its_wait(tmp_path, capsys):
    """Its dataset has the wait as variables, its attributes the settings."""
    output = tmp_path / "point.nc"
    waiting = merged(SHEARED, {"schedule": {"relaxation_times": 3}})
    point = ["gas", "--r=0.9", "--beta=0", "--settings", json.dumps(waiting)]
    assert main(["run", *point, "-o", str(output)]) == 0
    assert main(["show", str(output)]) == 0
    with xr.open_dataset(output) as dataset:
        assert json.loads(dataset.attrs["experiment_json"])["schedule"]["relaxation_times"] == 3
        wait, e_folds = float(dataset.wait), float(dataset.wait_relaxations)
    assert f"wait           {wait:g} T, {e_folds:.3g} e-folds of theory" in capsys.readouterr().out


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
    heated = wait_by(lambda wait: 40.0 * (1.0 - math.exp(-wait / 40.0)))
    assert heated[0] == pytest.approx(200, rel=0.02)
    assert wait_by(lambda wait: 3000.0 / wait) == (125.0, [30.0, 60.0, 120.0, 125.0])
    assert wait_by(lambda wait: math.inf)[0] == 3000.0  # a hundred times
    assert wait_by(lambda wait: 7.3, sample_every=1.0, period=4.0) == (40.0, [30.0, 40.0])


def test_a_wait_has_no_more_samples_than_a_run_may_have(monkeypatch):
    monkeypatch.setattr(steady, "SAMPLE_LIMIT", 400)
    assert wait_by(lambda wait: math.inf) == (140.0, [30.0, 60.0, 120.0, 140.0])
    monkeypatch.setattr(steady, "SAMPLE_LIMIT", 1)
    assert wait_by(lambda wait: math.inf) == (30.0, [30.0])


def state_of(E_trans, R, frequency, dimension=2):
    """The thermal state of a bed: temperatures of motions, and contacts of a particle per T."""
    T_tr = 2.0 * E_trans
    T_rot = None if R == 0.0 else np.array([T_tr * R / (1.0 - R)])
    lengths = (50.0,) * (dimension - 1) + (math.inf,)
    return ThermalState(np.array([T_tr]), T_rot, frequency, 160, lengths)


@pytest.mark.parametrize("point", SLOW_BEDS)
def test_slow_beds_settle_as_theory_says(point):
    """To a fourth; at constant height and density the energies would settle three times faster."""
    *state, measured = SLOW_BEDS[point]
    memory_times = gas_memory(build(PAPER_BED, *point), state_of(*state))
    assert memory_times.settling / measured == pytest.approx(1.0, abs=0.25)
    assert 2.5 < measured / memory_times.energies < 4.1


def test_a_smooth_bed_settles_as_in_a_numerical_integration():
    """The energy (D/2 + 1) T of a dilute bed grows by the weight times the speed of the floor, and
    contacts take (1 - r^2)/2 nu T, with nu ~ T^(-1/2): the e-fold is 4 times (disks) or 10/3 times
    (spheres) that at constant height and frequency."""
    for dimension, ratio in ((2, 4.0), (3, 10.0 / 3.0)):
        sides = [50] * (dimension - 1) + ["open"]
        bed = merged(PAPER_BED, {"particles": 40, "box": sides})
        nu, T = 0.3, 1.0  # stationary, in any unit
        memory_times = gas_memory(build(bed, 0.9, -1.0), state_of(T / 2.0, 0.0, nu, dimension))
        assert memory_times.settling / memory_times.energies == pytest.approx(ratio)
        loss, step = (1.0 - 0.9**2) / 2.0 * nu, memory_times.settling / 4000
        disturbed = 1.001
        for _ in range(4000):
            heating = loss - loss * math.sqrt(disturbed)  # nu T grows as T^(1/2)
            disturbed += step * heating / (dimension / 2.0 + 1.0)
        assert (disturbed - 1.0) / 0.001 == pytest.approx(math.exp(-1.0), rel=2e-3)


def test_a_gas_without_an_open_side_settles_with_its_energies():
    sheared = config.load_experiment(config.SHIPPED, "sheared", "paper").raw
    state = state_of(0.1, 0.2, 0.5)._replace(lengths=(50.0, 50.0))
    memory_times = gas_memory(build(sheared, 0.9, 0.0), state)
    assert memory_times.settling == memory_times.energies


def test_a_sawtooth_supplies_the_weight_times_its_speed():
    """Each hit meets the rising floor, and hits bear the weight: 5 m a^2/T^3 per particle."""
    bed = variables_of(BED, equilibrate=300, measure=1700)
    supplied = bed["energy_input"].sum(axis=1).max() / bed["time"][-1]  # per particle and T
    assert supplied == pytest.approx(5.0, rel=0.01)


@pytest.mark.slow  # some 10 s
@pytest.mark.parametrize("point", LEAN_WAITS)
def test_beds_of_the_scale_lean_wait_as_long_as_stated(point):
    lean = config.load_experiment(config.SHIPPED, "vibrated", "lean").raw
    lean["schedule"] |= {"measure": 20}
    low, high = LEAN_WAITS[point]
    measured = run_point(build(lean, *point), lean, 1).variables
    assert low <= measured["wait"] <= high
    assert measured["measured_from"] == measured["wait"]


def test_the_scale_lean_differs_from_the_paper_in_its_waits():
    for name in PAPER_EXPERIMENTS:
        lean, paper = (
            config.load_experiment(config.SHIPPED, name, scale).raw for scale in ("lean", "paper")
        )
        waits = {
            key: lean["schedule"].pop(key, None) for key in ("equilibrate", "relaxation_times")
        }
        for key in waits:
            paper["schedule"].pop(key, None)
        assert lean == paper
        if lean["schedule"]["kind"] == "steady":
            assert waits == {"equilibrate": 500, "relaxation_times": 10}
