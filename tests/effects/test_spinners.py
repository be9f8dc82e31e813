"""Spinners: a bath whose medium rotates leads spins to its angular velocity."""

import math

import numpy as np
import pytest
from brute_force import PLAIN, begin, run, snapshot
from raw import build, run_point
from schedules import SPIN

from roughgas import theory
from roughgas.simulation.energy_balance import balance, imbalance
from roughgas.statistics.sample_sizes import YES

STEADY = {"kind": "steady", "equilibrate": 100, "measure": 4000, "sample_every": 1.0}
NOISY = {
    "interval": 0.5,
    "drag": 0.1,
    "temperature": 1.0,
    "spin_drag": 0.2,
    "spin_temperature": 0.5,
}
SPINNERS = NOISY | {"spin_velocity": 2.0}


def gas(particles, box, langevin=SPINNERS, **further):
    """Settings of disks in a bath."""
    experiment = {
        "particles": particles,
        "box": list(box),
        "effects": SPIN | {"langevin": langevin},
    }
    return experiment | {"schedule": STEADY} | further


def measured(experiment, r, beta, seed=1):
    """The variables of a point."""
    return run_point(build(experiment, r, beta), experiment, seed).variables


@pytest.mark.parametrize("box", [(100, 100), (100, 100, 100)])
def test_a_spin_decays_to_the_medium_exponentially(box):
    """To rounding, of two particles that never meet; the energy balance closes."""
    interval, steps, axis = 0.5, 7, {} if len(box) == 2 else {"spin_axis": "y"}
    bath = {"interval": interval, "spin_drag": 0.3, "spin_velocity": 2.0} | axis
    scene, state = begin(gas(2, box, bath), 0.9, 0.2, 4)
    state.spin[0] = 0.5
    before, balance_before = snapshot(state, scene), balance(state, scene)
    run(state, scene, 1, interval=interval * steps, kernel=PLAIN)  # the last step is at the end
    after, balance_after = snapshot(state, scene), balance(state, scene)
    medium = np.array([2.0] if len(box) == 2 else [0.0, 2.0, 0.0])
    decayed = medium + (before.spin - medium) * math.exp(-0.3 * interval * steps)
    assert after.spin == pytest.approx(decayed, rel=1e-14)
    assert np.array_equal(after.velocity, before.velocity)
    gained = balance_after.energy - balance_before.energy
    assert imbalance(balance_after.ledger - balance_before.ledger, gained) < 1e-14
    assert gained[1] > 0.1


@pytest.mark.slow  # compiles a kernel, as the tests below, which share it
def test_smooth_spinners_have_the_spin_of_the_medium():
    """And its temperature about the mean spin, within 4 errors."""
    point = measured(gas(100, (50, 50)), 0.9, -1.0)
    assert abs(point["mean_spin"] - 2.0) < 4.0 * point["mean_spin_stderr"] < 0.05
    assert point["mean_spin_trusted"] == YES
    assert abs(2.0 * point["E_rot"] - 0.5 * 0.99) < 4.0 * 2.0 * point["E_rot_stderr"] < 0.02
    rotation = 0.5 * 0.5 * 2.0**2  # q Omega^2/2
    error = 4.0 * point["E_rot_stderr"] + 4.0 * 0.5 * 2.0 * point["mean_spin_stderr"]
    assert abs(point["E_rot_unsubtracted"] - 0.5 * 0.5 - rotation) < error
    assert point["R"] < point["R_unsubtracted"]
    assert point["energy_imbalance"] < 1e-12


@pytest.mark.slow
def test_contacts_slow_spinners_by_the_rate_of_theory():
    """A dilute gas with weak drag; partners that meet again raise the mean spin by 1 % or so."""
    point = measured(gas(160, (100, 100)), 0.9, 0.0)
    frequency = point["measured_collisions"] / 4000.0
    expected = 2.0 * theory.mean_spin_of_spinners(0.0, frequency, 0.2)
    error = point["mean_spin_stderr"]
    assert error < 0.01 * expected < 0.015
    assert abs(point["mean_spin"] - expected) < 4.0 * error + 0.02 * expected
    assert point["E_rot"] < point["E_rot_unsubtracted"]


@pytest.mark.slow
def test_the_measurement_begins_once_the_mean_spin_has_risen():
    """Smooth elastic contacts leave both energies, about the mean spin, as they are."""
    slow = SPINNERS | {"spin_drag": 0.02, "spin_temperature": 0.0}
    at_once = {"kind": "steady", "equilibrate": 0, "measure": 4000, "sample_every": 1.0}
    point = measured(gas(100, (50, 50), slow, schedule=at_once), 1.0, -1.0)
    assert 3.0 / 0.02 < point["measured_from"] < 2000.0
    assert point["mean_spin"] == pytest.approx(2.0, rel=1e-3)


@pytest.mark.slow  # compiles a kernel
def test_species_may_rotate_in_opposite_directions():
    """Smooth particles without noise have exactly the spins of their media, whatever their size."""
    species = [
        {"name": "left", "number": 60, "spin_velocity": 3.0, "radius": 1.5},
        {"name": "right", "number": 40, "spin_velocity": -2.0},
        {"name": "common", "number": 20},
    ]
    bath = {
        "interval": 0.5,
        "drag": 0.1,
        "temperature": 1.0,
        "spin_drag": 0.4,
        "spin_velocity": 1.0,
    }
    point = measured(gas(120, (60, 60), bath, species=species), 0.9, -1.0)
    assert point["mean_spin_species"] == pytest.approx([3.0, -2.0, 1.0], rel=1e-9)
    assert max(point["E_rot_species"]) < 1e-12
    assert point["E_rot"] < 1e-12
    moments = np.array([60, 40, 20]) * np.array([1.5, 1.0, 1.0]) ** 4
    assert point["mean_spin"] == pytest.approx(moments @ [3.0, -2.0, 1.0] / moments.sum(), rel=1e-9)
    assert point["E_rot_unsubtracted"] > 1.0
    assert np.shape(point["mean_spin_species_trusted"]) == (3,)


@pytest.mark.slow  # compiles a kernel
@pytest.mark.parametrize("uneven", [False, True])
def test_the_mean_spin_follows_the_medium_through_stages(uneven):
    """Smooth particles without noise: exactly, from rest to the first medium and to the second.

    Averages are over time, in the second stage, or in both, whose intervals then differ.
    """
    bath = {"interval": 0.5, "drag": 0.1, "temperature": 1.0, "spin_drag": 0.2}
    second = {"duration": 20.0, "effects": {"langevin": {"spin_velocity": -1.0}}}
    second |= {"sample_every": 1.0} if uneven else {}
    stages = [{"duration": 10.0, "measure": uneven}, second]
    schedule = {"kind": "stages", "sample_every": 0.5, "stages": stages}
    experiment = gas(40, (30, 30), bath | {"spin_velocity": 2.0}, schedule=schedule)
    point = measured(experiment, 0.9, -1.0)
    first, time = 2.0 * (1.0 - math.exp(-2.0)), np.asarray(point["time"])
    expected = np.where(
        time <= 10.0,
        2.0 * (1.0 - np.exp(-0.2 * time)),
        -1.0 + (first + 1.0) * np.exp(-0.2 * (time - 10.0)),
    )
    assert point["mean_spin_series"] == pytest.approx(expected, rel=1e-9)
    weights = np.diff(time, prepend=0.0) * (uneven | (time > 10.0))
    assert point["mean_spin"] == pytest.approx(np.average(expected, weights=weights), rel=1e-9)
    assert math.isnan(point["mean_spin_stderr"]) == uneven
