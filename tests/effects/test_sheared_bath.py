"""A Langevin bath that flows: drag and noise relative to the flow of a sheared gas."""

import math

import numpy as np
import pytest
from brute_force import PLAIN, begin, run, snapshot
from raw import build, run_point
from schedules import SPIN

from roughgas import theory
from roughgas.kernel.state import COLLISIONS
from roughgas.simulation.energies import energies
from roughgas.simulation.energy_balance import balance, imbalance
from roughgas.statistics.errors import blocking_stderr

BATH = {"interval": 0.5, "drag": 0.3, "temperature": 1.0, "spin_drag": 0.2}


def sheared(particles, box, velocity, langevin, **further):
    """Settings of disks in a bath that flows; without a bath if `langevin` is None."""
    bath = {} if langevin is None else {"langevin": langevin}
    effects = SPIN | {"shear": {"velocity": velocity}} | bath
    return {"particles": particles, "box": list(box), "effects": effects} | further


def relative_velocities(state, scene):
    """Velocities relative to the flow, which are the same in all images of a particle."""
    shot, bath = snapshot(state, scene), scene.effects.langevin
    c = shot.velocity.copy()
    c[:, 0] -= bath.shear_rate * (shot.position[:, 1] - scene.middle)
    return c


def stderr_within(series):
    """The standard error of the mean of a series (samples,), by blocking."""
    return blocking_stderr(np.asarray(series))


def test_drag_and_flight_are_exact_across_the_boundary():
    """Two disks rise side by side, far from each other, and cross the boundary twice."""
    G, drag, interval, steps = 0.5, 0.002, 20.0, 12
    bath = {"interval": interval, "drag": drag, "spin_drag": drag}
    scene, state = begin(sheared(2, (100, 100), 50.0, bath), 0.9, 0.2, 3)
    state.trajectory[:, :4] = [[10.0, 20.0, -14.0, 0.9], [60.0, 70.0, 11.0, 0.95]]
    state.spin[:] = 0.3
    c, due = relative_velocities(state, scene), state.particle_times.langevin.copy()
    balance_before, risen = balance(state, scene), np.zeros(2)
    end, decay = interval * steps, math.exp(-drag * interval)
    run(state, scene, 1, interval=end, kernel=PLAIN)
    balance_after = balance(state, scene)
    assert state.counts[COLLISIONS] == 0
    for i in range(2):
        time, events = 0.0, [*np.arange(due[i], end * (1.0 + 1e-12), interval)]
        for event in events:
            risen[i] += c[i, 1] * (event - time)
            c[i, 0] -= G * (event - time) * c[i, 1]
            c[i], time = c[i] * decay, event
        risen[i] += c[i, 1] * (end - time)
        c[i, 0] -= G * (end - time) * c[i, 1]
        w = -G / 2.0 + (0.3 + G / 2.0) * decay ** len(events)
        assert state.spin[i, 0] == pytest.approx(w, rel=1e-13)
    assert risen.min() > 150.0
    assert relative_velocities(state, scene) == pytest.approx(c, rel=1e-10, abs=1e-10)
    booked = balance_after.ledger - balance_before.ledger
    assert imbalance(booked, balance_after.energy - balance_before.energy) < 1e-12
    assert np.abs(booked[1:3, 0]).min() > 1.0  # by shear and by the bath


@pytest.mark.slow  # compiles a kernel, as tests below, which share it
@pytest.mark.parametrize("interval", [0.5, 10.0])
def test_the_pressure_without_contacts_is_the_closed_form(interval):
    """At gamma h = 1, x coth x = 1.31 from the limit; 400 instants, within 4 standard errors."""
    G, drag = 0.2, 0.1
    bath = BATH | {"interval": interval, "drag": drag, "temperature": 1.7}
    scene, state = begin(sheared(100, (4000, 4000), 4000 * G, bath), 1.0, -1.0, 2)
    run(state, scene, 1, interval=200.0)
    products = []
    for _ in range(400):
        run(state, scene, 1, interval=25.0)
        c = relative_velocities(state, scene)
        products.append([np.mean(c[:, 0] ** 2), np.mean(c[:, 0] * c[:, 1]), np.mean(c[:, 1] ** 2)])
    expected = theory.pressure_in_sheared_bath(G, drag, 1.7, interval)
    for series, pressure in zip(np.transpose(products), expected, strict=True):
        error = stderr_within(series)
        assert error < 0.02 * abs(pressure)
        assert abs(series.mean() - pressure) < 4.0 * error
    assert state.counts[COLLISIONS] < 200  # of 100 particles in 10,000 T


@pytest.mark.slow
def test_hardly_sheared_gases_have_the_temperatures_of_their_bath():
    """G -> 0: both temperatures agree with theory to 2 % and 4 standard errors."""
    bath = BATH | {"drag": 0.05, "spin_drag": 0.02, "spin_temperature": 0.4}
    scene, state = begin(sheared(160, (100, 100), 0.01, bath), 0.9, 0.2, 1)
    run(state, scene, 1, interval=100.0)
    E = energies(run(state, scene, 4000, interval=1.0), 160, 0.5)
    packing = theory.packing_fraction(160, (100, 100))
    expected = theory.bath_temperatures(0.9, 0.2, packing, 0.05, 1.0, 0.02, 0.4)
    for energy, T in zip(E, expected, strict=True):
        error = 2.0 * stderr_within(energy)
        assert error < 0.02 * T
        assert abs(2.0 * energy.mean() - T) < 4.0 * error + 0.02 * T


@pytest.mark.slow  # compiles a kernel of drag alone
def test_a_vanishing_drag_leaves_a_sheared_gas_as_it_is():
    """g -> 0: the same 30 contacts, but for the growth of a relative change of 1e-14 by chaos."""
    shots = []
    for bath in (None, {"interval": 0.5, "drag": 1e-14, "spin_drag": 1e-14}):
        scene, state = begin(sheared(40, (40, 40), 20.0, bath), 0.9, 0.2, 3)
        run(state, scene, 1, collisions=30)
        shots.append(snapshot(state, scene))
    assert shots[1].time == pytest.approx(shots[0].time, rel=1e-9)
    assert np.sort(shots[1].spin, axis=0) == pytest.approx(np.sort(shots[0].spin, axis=0), abs=1e-6)
    assert (shots[1].velocity ** 2).sum(axis=0)[1] == pytest.approx(
        (shots[0].velocity ** 2).sum(axis=0)[1], rel=1e-6
    )


@pytest.mark.slow
@pytest.mark.parametrize("spin_velocity", [None, 0.0])
def test_a_medium_that_flows_holds_the_mean_velocity_and_rotates(spin_velocity):
    """Momentum is conserved in the mean; spins follow the vorticity unless the medium is at rest.

    All within 4 standard errors; the work of shear is the stress times the shear rate.
    """
    target = {} if spin_velocity is None else {"spin_velocity": spin_velocity}
    bath = BATH | {"spin_temperature": 0.5} | target
    schedule = {"kind": "steady", "equilibrate": 50, "measure": 4000, "sample_every": 1.0}
    experiment = sheared(100, (60, 60), 30.0, bath, schedule=schedule, observables={"stress": {}})
    point = run_point(build(experiment, 0.9, -1.0), experiment, 1).variables
    omega = -0.25 if spin_velocity is None else 0.0
    assert abs(point["mean_spin"] - omega) < 4.0 * point["mean_spin_stderr"] < 0.05
    assert abs(2.0 * point["E_rot"] - 0.99 * 0.5) < 8.0 * point["E_rot_stderr"] < 0.05
    assert point["energy_imbalance"] < 1e-12
    by_source = dict(zip(point["source"], point["energy_input"].sum(axis=1), strict=True))
    assert by_source["shear"] > 0.0 > by_source["contacts"]
    assert by_source["langevin"] < 0.0
    power, error = point["shear_power"], point["shear_power_stderr"]
    assert abs(by_source["shear"] / 4050.0 - power) < 4.0 * error + 0.02 * power
    scene, state = begin(experiment, 0.9, -1.0, 2)
    rows = run(state, scene, 2000, interval=1.0)
    for momentum in (rows["p_x"] - 0.5 * rows["y"], rows["p_y"]):
        assert abs(momentum.mean()) < 4.0 * stderr_within(momentum) < 0.1 * 100
    assert abs(rows["p_y"].var() / 100 - 1.0) < 0.2  # of a drag that noise balances
