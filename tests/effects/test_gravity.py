"""Gravity in any direction: falls through the box, its work, drift in a bath, and flow in channels.

Rounding errors are relative to the largest positions and velocities of a test.
"""

import math

import numpy as np
import pytest
from brute_force import begin, run, settings, snapshot
from raw import build, start_gas

from roughgas import theory
from roughgas.kernel.state import COLLISIONS
from roughgas.scene import conserves_momentum
from roughgas.simulation.energy_balance import balance, imbalance
from roughgas.simulation.free_flight import positions_and_velocities
from roughgas.simulation.scene_switch import switch_scene

DOWN_RIGHT = np.array([0.5, -1.0]) / math.hypot(0.5, 1.0)
"""The acceleration of the kernel `chute`, in a/T^2."""
GRAVITY, CONTACTS = 1, -1  # accounts of the ledger of a chute


def chute_above_its_floor(particles, side, height, seed=0):
    """(scene, state) of particles that fall along a periodic axis, far above the floor."""
    scene, state = begin(settings("chute", particles, [side, "open"]), 0.9, 0.3, seed)
    state.trajectory[:, 1] += height
    return scene, state


def test_a_particle_flies_along_a_parabola_across_the_period():
    """Positions in the box and velocities, to rounding; the particles never meet."""
    scene, state = chute_above_its_floor(2, 12.0, 0.0)
    start = np.array([[3.0, 2000.0], [7.0, 3000.0]])
    velocity = np.array([[-2.0, 1.0], [5.0, -3.0]])
    state.trajectory[:, :2], state.trajectory[:, 2:4] = start, velocity
    for k in range(1, 20):
        run(state, scene, 1, interval=2.5)
        time = 2.5 * k
        position, speed = positions_and_velocities(state, scene, time)
        expected = start + velocity * time + 0.5 * DOWN_RIGHT * time**2
        expected[:, 0] %= 12.0
        assert position == pytest.approx(expected, abs=1e-11)
        assert speed == pytest.approx(velocity + DOWN_RIGHT * time, abs=1e-12)
    assert state.counts[COLLISIONS] == 0


def test_momentum_grows_by_the_force_and_the_work_closes_the_balance():
    """P grows by N g t, whatever the contacts; they lose what the force has not left in the gas."""
    number, time = 40, 20.0
    scene, state = chute_above_its_floor(number, 25.0, 1000.0)
    assert not conserves_momentum(scene)
    run(state, scene, 1, interval=1.0)
    before, shot = balance(state, scene), snapshot(state, scene)
    run(state, scene, 1, interval=time)
    after, now = balance(state, scene), snapshot(state, scene)
    gained = (now.velocity - shot.velocity).sum(axis=0)
    assert gained == pytest.approx(number * time * DOWN_RIGHT, rel=1e-12)
    booked = after.ledger - before.ledger
    assert imbalance(booked, after.energy - before.energy) < 1e-12
    assert booked[GRAVITY, 0] > 0.0 and booked[GRAVITY, 1] == 0.0
    assert booked[CONTACTS].sum() < 0.0
    assert np.all(booked[2:CONTACTS] == 0.0)  # no particle has met the floor


def test_the_work_is_the_force_times_the_displacement():
    """Kinetic energy + height above the start of the flights = work along x + loss of contacts."""
    scene, state = chute_above_its_floor(40, 25.0, 1000.0)
    start = snapshot(state, scene)
    run(state, scene, 1, interval=15.0)
    now, ledger = snapshot(state, scene), state.ledger.sum(axis=0)
    kinetic = 0.5 * ((now.velocity**2).sum() - (start.velocity**2).sum())
    rotational = 0.25 * (now.spin**2).sum()
    # the centre of mass falls as a body, contacts do not displace it
    time = now.time - start.time
    displaced = start.velocity.sum(axis=0) * time + 40 * 0.5 * DOWN_RIGHT * time**2
    lost = ledger[CONTACTS].sum()
    assert kinetic + rotational - lost == pytest.approx(DOWN_RIGHT @ displaced, rel=1e-11)


def test_a_switch_of_other_settings_supplies_no_energy():
    """Flights end at the switch: the work until then is the force's, not the switch's."""
    experiment = settings("chute", 20, [12.5, "open"])
    other = settings("chute", 20, [12.5, "open"], floor={"restitution": 0.5})
    gas = start_gas(build(experiment, 0.9, 0.2), experiment, np.random.default_rng(3))
    gas.in_time(0.5, 10)
    before = gas.balance()
    supplied = switch_scene(gas, build(other, 0.9, 0.2), 5.0)
    assert np.abs(supplied).max() < 1e-10 * before.energy.sum()
    assert gas.balance().ledger[GRAVITY, 0] > before.ledger[GRAVITY, 0]


def periodic(effects, particles=100, box=(60, 60)):
    """Settings of disks that fall through a periodic box."""
    return {"particles": particles, "box": [*box], "effects": {"spin": {"inertia": 0.5}} | effects}


@pytest.mark.slow  # compiles a kernel
def test_a_periodic_gas_falls_like_one_body():
    """In both directions, also upwards: momentum N g t; relative velocities as without gravity."""
    force = {"gravity": {"acceleration": 0.3, "direction": [2.0, 1.0]}}
    velocities = []
    for effects in (force, {}):
        scene, state = begin(periodic(effects), 0.9, 0.3, 5)
        shot = snapshot(state, scene)
        run(state, scene, 1, interval=4.0)
        velocities.append(snapshot(state, scene).velocity)
    gained = (velocities[0] - shot.velocity).sum(axis=0)
    fallen = 0.3 * 4.0 * np.array([2.0, 1.0]) / math.sqrt(5.0)
    assert gained == pytest.approx(100 * fallen, rel=1e-12)
    assert velocities[0] - fallen == pytest.approx(velocities[1], abs=1e-9)


@pytest.mark.slow  # compiles a kernel
def test_in_a_bath_the_gas_drifts_at_its_terminal_velocity():
    """g/gamma (gamma h/2) coth(gamma h/2) with steps h; the centre of mass takes exact OU steps.

    Its velocity has the variance T/(N m) and the correlation time 1/gamma. Within 4 sigma.
    """
    drag, interval, number, time = 0.5, 1.0, 100, 4000.0
    bath = {"drag": drag, "temperature": 1.0, "interval": interval}
    force = {"acceleration": 0.4, "direction": [1.0, 0.0]}
    scene, state = begin(periodic({"langevin": bath, "gravity": force}), 1.0, -1.0, 6)
    run(state, scene, 1, interval=30.0)
    rows = run(state, scene, 8000, interval=time / 8000)
    error = math.sqrt(2.0 / (number * drag * time))
    terminal = 0.4 * interval / 2.0 / math.tanh(drag * interval / 2.0)
    assert abs(rows["p_x"].mean() / number - terminal) < 4.0 * error < 0.02 * terminal
    assert abs(rows["p_y"].mean() / number) < 4.0 * error
    before = balance(state, scene)
    run(state, scene, 1, interval=20.0)
    after = balance(state, scene)
    assert imbalance(after.ledger - before.ledger, after.energy - before.energy) < 1e-12


LENGTH, WIDTH, BULK = 60.0, 40.0, 15.0
FORCE, PACKING = 0.008, 0.2


def bulk_flow(blocks, snapshots):
    """Flow u = top - bend (y - W/2)^2 and T in the middle of a channel, each (blocks,).

    Elastic disks between thermal walls; each block has `snapshots` 4 T apart.
    """
    walls = {"bottom_wall": {"temperature": 1.0}, "lid": {"temperature": 1.0}}
    force = {"gravity": {"acceleration": FORCE, "direction": [1.0, 0.0]}}
    number = round(PACKING * LENGTH * WIDTH / math.pi)
    scene, state = begin(periodic(walls | force, number, (LENGTH, WIDTH)), 1.0, -1.0, 7)
    run(state, scene, 1, interval=600.0)
    fits = []
    for _ in range(blocks):
        heights, velocities = [], []
        for _ in range(snapshots):
            run(state, scene, 1, interval=4.0)
            shot = snapshot(state, scene)
            height = shot.position[:, 1] - WIDTH / 2.0
            heights.append(height[abs(height) < BULK])
            velocities.append(shot.velocity[abs(height) < BULK])
        height, velocity = np.concatenate(heights), np.concatenate(velocities)
        minus_bend, top = np.polyfit(height**2, velocity[:, 0], 1)
        fits.append((top, -minus_bend, velocity[:, 1].var(), len(height) / snapshots))
    return np.transpose(fits)


@pytest.mark.slow  # a minute
def test_flow_in_a_channel_is_the_parabola_of_the_viscosity():
    """u_max - u = rho g (y - W/2)^2/(2 eta) far from the walls, and so rho g W^2/(8 eta) across.

    To 4 % for the Enskog viscosity, slip and heating, and 4 sigma over blocks.
    """
    _, bend, T, particles = bulk_flow(20, 1000)
    density = particles.mean() / (2.0 * BULK * LENGTH)
    viscosity = theory.shear_viscosity(T.mean(), 0.0, density * math.pi)
    expected = density * FORCE / (2.0 * viscosity)
    error = bend.std(ddof=1) / math.sqrt(len(bend))
    assert error < 0.03 * expected
    assert abs(bend.mean() - expected) < 4.0 * error + 0.04 * expected


TIME, POSITION, BEFORE, AFTER = 0, 6, 7, 11  # columns of the log: of y and of v_x
LAYER = 2.0


def collisional_stress(contacts, box, middle):
    """P_xy due to logged contacts of pairs in a layer of LAYER about the height `middle`."""
    high = contacts[:, POSITION] + np.maximum(0.0, -2.0 * contacts[:, 4])
    low = contacts[:, POSITION] - np.maximum(0.0, 2.0 * contacts[:, 4])
    top, bottom = middle + LAYER / 2.0, middle - LAYER / 2.0
    inside = np.maximum(0.0, np.minimum(high, top) - np.maximum(low, bottom))
    pushes = (contacts[:, AFTER] - contacts[:, BEFORE]) * np.sign(contacts[:, 4])
    return (pushes * inside).sum() / (box[0] * LAYER * np.ptp(contacts[:, TIME]))


@pytest.mark.slow  # compiles a kernel
def test_the_stress_across_a_channel_balances_the_force():
    """P_xy(W) = -P_xy(0) = rho g W/2 at the walls, which take up all momentum, exactly; in between
    P_xy is g times the particles below, less their half, per length; to 5 % of rho g W/2."""
    number, g, box = 60, 0.05, (30.0, 20.0)
    rough = {"restitution": 0.9, "roughness": 0.5}
    effects = {"bottom_wall": rough, "lid": rough, "contact_log": {"most": 1_000_000}}
    force = {"gravity": {"acceleration": g, "direction": [1.0, 0.0]}}
    scene, state = begin(periodic(effects | force, number, box), 0.9, 0.3, 8)
    run(state, scene, 1, interval=300.0)
    first, shots = int(state.log.made[0]), []
    for _ in range(4000):
        run(state, scene, 1, interval=1.0)
        shots.append(snapshot(state, scene))
    assert state.log.made[0] < len(state.log.rows)
    rows = state.log.rows[first : int(state.log.made[0])]
    at_walls = rows[:, 2] == -1.0
    pushes = rows[at_walls, AFTER] - rows[at_walls, BEFORE]
    supplied, wall_stress = number * g * 4000.0, number * g / 2.0 / box[0]
    gained = shots[-1].velocity[:, 0].sum() - shots[0].velocity[:, 0].sum()
    since = rows[at_walls, TIME] > shots[0].time
    assert gained == pytest.approx(number * g * 3999.0 + pushes[since].sum(), abs=1e-9 * supplied)
    of_lid = pushes[rows[at_walls, 4] < 0.0].sum()
    assert of_lid == pytest.approx(-supplied / 2.0, rel=0.05)
    height, velocity = (
        np.concatenate([getattr(shot, name) for shot in shots]) for name in ("position", "velocity")
    )
    for middle in (4.0, 7.0, 10.0, 13.0, 16.0):
        layer = abs(height[:, 1] - middle) < LAYER / 2.0
        kinetic = velocity[layer].prod(axis=1).sum() / len(shots) / (box[0] * LAYER)
        stress = kinetic + collisional_stress(rows[~at_walls], box, middle)
        below = np.count_nonzero(height[:, 1] < middle) / len(shots)
        expected = g * (below - number / 2.0) / box[0]
        assert stress == pytest.approx(expected, abs=0.05 * wall_stress)


@pytest.mark.slow  # compiles a kernel
def test_a_particle_that_falls_onto_walls_at_rest_comes_to_rest():
    """In the corner of a tilted box, without an infinite number of bounces."""
    corner = {"restitution": 0.5, "roughness": 0.0}
    sides = {"walls": corner, "floor": corner | {"amplitude": 0.0, "period": 1.0}}
    force = {"gravity": {"acceleration": 1.0, "direction": [1.0, -1.0]}}
    scene, state = begin(periodic(sides | force, 1, (12.0, "open")), 0.5, 0.0, 9)
    run(state, scene, 1, interval=40.0)
    shot = snapshot(state, scene)
    assert np.abs(shot.velocity).max() < 0.002
    assert shot.position[0] == pytest.approx([11.0, 1.0], abs=1e-5)
