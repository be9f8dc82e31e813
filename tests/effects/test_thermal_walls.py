"""Thermal walls: what leaves them, and the heat that flows between two."""

import math

import numpy as np
import pytest
from brute_force import begin, run

from roughgas import theory
from roughgas.effects import thermal_wall
from roughgas.kernel.mathematics import logarithm
from roughgas.kernel.memory import new_state
from roughgas.scene import build
from roughgas.simulation.books import books

DISKS = {"spin": {"inertia": 0.5}}


def closed(effects, box, particles):
    return {"particles": particles, "box": box, "effects": effects}


def test_logarithms():
    for x in (1e-300, 1e-3, 0.3, 0.7071, 0.70711, 0.999999, 1.0, 1.0 + 1e-9, 2.0, 3.7, 1e200):
        assert logarithm(x) == pytest.approx(math.log(x), rel=1e-15, abs=1e-16)


def left(number, dimension, temperature, inertia):
    """(velocities, spins, energy booked) of particles that have left a thermal wall on the left."""
    effects = {"spin": {"inertia": inertia}, "right_wall": {}}
    effects["left_wall"] = {"temperature": temperature, "velocity": 0.5}
    scene = build(closed(effects, [20] * dimension, 1 + number), 0.9, 0.0)
    position = np.full((1, dimension), 10.0)
    spin = np.zeros((1, 2 * dimension - 3))
    state = new_state(scene, position, np.full((1, dimension), -1.0), spin)
    velocities, spins = [], []
    for _ in range(number):
        with np.errstate(over="ignore"):  # of the generator's words, which wrap around
            thermal_wall.resolve(scene.effects.left_wall, 1, 0, state, scene, 0, 0.0)
        velocities.append(state.trajectory[0, dimension:-1].copy())
        spins.append(state.spin[0].copy())
    return np.array(velocities), np.array(spins), state.ledger[0, 1]


@pytest.mark.parametrize("dimension", [2, 3])
def test_particles_leave_a_thermal_wall_as_they_would_leave_a_gas(dimension):
    """Means, variances and fourth moments within four standard errors, and the energy booked."""
    T, q, number = 1.7, 0.4, 8000
    velocity, spin, booked = left(number, dimension, T, q)
    v, along, others = velocity[:, 0], velocity[:, -1] - 0.5, velocity[:, 1:-1]
    expected = [
        (v, math.sqrt(math.pi * T / 2)),
        (v**2, 2 * T),
        (v**4, 8 * T**2),
        *((x, 0.0) for x in (along, *others.T, *spin.T)),
        *((x**2, T) for x in (along, *others.T)),
        *((x**4, 3 * T**2) for x in (along, *others.T)),
        *((x**2, T / q) for x in spin.T),
        *((x**4, 3 * (T / q) ** 2) for x in spin.T),
    ]
    for sample, mean in expected:
        assert abs(sample.mean() - mean) < 4.0 * sample.std() / math.sqrt(number)
    assert v.min() > 0.0
    gained = 0.5 * (velocity[-1] @ velocity[-1] - dimension), 0.5 * q * spin[-1] @ spin[-1]
    assert booked == pytest.approx(gained, rel=1e-9)


def flux(experiment, r, beta, seed, warm, measured):
    """(energy per time that flows from the left wall to the right one, its error), per length."""
    scene, state = begin(experiment, r, beta, seed)
    time = run(state, scene, 1, interval=warm)["time"][0]
    pieces = 40
    before, seen = books(state, scene).ledger, []
    for _ in range(pieces):  # in steps that are short: a sample waits for a limited time only
        until = run(state, scene, 20, interval=measured / pieces / 20)["time"][-1]
        now = books(state, scene).ledger
        seen.append((now - before).sum(axis=1) / (until - time))
        before, time = now, until
    accounts = [name for name in ("spin", "left_wall", "right_wall") if name in names(scene)]
    seen = np.array(seen)[:, : len(accounts)]
    through = (seen[:, -2] - seen[:, -1]) / 2
    return through.mean(), through.std(ddof=1) / math.sqrt(pieces)


def names(scene):
    return [name for name, one in scene.effects._asdict().items() if one is not None]


def between(hot, cold, box, particles, **effects):
    walls = {"left_wall": {"temperature": hot}, "right_wall": {"temperature": cold}}
    return closed(effects | walls, box, particles)


@pytest.mark.slow
@pytest.mark.parametrize(("effects", "beta"), [({}, -1.0), (DISKS, 0.3)])
def test_heat_flux_without_collisions(effects, beta):
    """Knudsen's limit: eight disks of which each flies hundreds of times between meetings."""
    experiment = between(4.0, 1.0, [12.0, 20_000.0], 8, **effects)
    found, error = flux(experiment, 1.0, beta, 1, 1e3, 4e5)
    expected = theory.free_molecular_flux(4.0, 1.0, 8.0, 10.0, 2, bool(effects))
    assert abs(found - expected) < 4.0 * error + 0.005 * expected and error < 0.01 * expected


@pytest.mark.slow
def test_heat_flux_through_many_mean_free_paths():
    """Smooth elastic disks, 3 % of the room filled: Fourier's law, between both limits."""
    number, box = 600, [250.0, 250.0]
    found, error = flux(between(2.0, 1.0, box, number), 1.0, -1.0, 1, 2e3, 2e4)
    expected = theory.heat_flux(2.0, 1.0, number / box[1], 248.0)
    assert error / box[1] < 0.04 * expected
    assert found / box[1] == pytest.approx(expected, rel=0.1)


def test_limits_of_the_heat_flux():
    """A dense gas conducts as Fourier has it, a dilute one as free particles."""
    assert theory.heat_flux(2, 1, 1e9, 1e6) == pytest.approx(theory.fourier_flux(2, 1, 1e6), 1e-6)
    free = theory.free_molecular_flux(2.0, 1.0, 1e-9, 10.0)
    assert theory.heat_flux(2.0, 1.0, 1e-9, 10.0) == pytest.approx(free, rel=1e-6)
    assert theory.thermal_conductivity(1.0, 2) == pytest.approx(1 / math.sqrt(math.pi))
    assert theory.thermal_conductivity(1.0, 3) == pytest.approx(75 / 256 / math.sqrt(math.pi))
