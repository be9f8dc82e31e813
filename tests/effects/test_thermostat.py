"""Kicks of a thermostat, and thermal walls."""

import math

import numpy as np
import pytest
from brute_force import Beside, begin, kernels, run, scene_of, settings, snapshot

from roughgas import theory
from roughgas.effects import thermal_wall
from roughgas.kernel.mathematics import STEP, logarithm
from roughgas.kernel.memory import new_state
from roughgas.kernel.state import BASE, COLLISIONS, NOW
from roughgas.scene import build
from roughgas.simulation.energies import energies, ratio
from roughgas.simulation.energy_balance import balance, imbalance
from roughgas.statistics.errors import blocking_stderr

INTERVAL = 0.5
DRAWS = {"heated": 5, "heated, smooth": 3, "heated spheres": 10}
"""Random numbers of a kick: a partner, a velocity, and two spins."""


def heated(kernel="heated", particles=40, box=(25, 25), **thermostat):
    return settings(kernel, particles, list(box), thermostat=thermostat)


CASES = {
    # experiment, r, beta, seed
    "both": (heated(particles=8, box=(12, 12)), 0.9, 0.4, 1),
    "translation": (heated(particles=8, box=(12, 12), spin_share=0.0), 0.98, -0.5, 2),
    "spins": (heated(particles=8, box=(12, 12), spin_share=1.0, interval=0.1), 0.9, 1.0, 3),
    "hard kicks": (heated(particles=6, box=(9, 11), power=1e4, interval=2.0), 0.8, 0.2, 4),
    "a pair": (heated(particles=2, box=(9, 9)), 0.9, 0.2, 5),
    "no spin": (heated("heated, smooth", 8, (12, 12)), 0.95, -1.0, 6),
    "spheres": (heated("heated spheres", 8, (7, 7, 7), spin_share=0.3), 0.9, 0.5, 7),
}
RARE = {"no spin", "spheres"}  # kernels that no other test compiles


@pytest.mark.parametrize(
    "case", [pytest.param(case, marks=[pytest.mark.slow] * (case in RARE)) for case in CASES]
)
def test_the_kernel_makes_the_same_kicks_and_collisions_as_brute_force(case):
    """The same 200 pairs in the same order, and the same random numbers between them."""
    *point, seed = CASES[case]
    scene, world = scene_of(*point)
    _, state = begin(*point, seed)
    beside = Beside(state, scene, world)
    # chaos is the faster the fewer particles there are
    beside.assert_same(segments=20, collisions=min(10, 2 * len(state.changes) - 2))
    assert beside.events["kick"] > 10


@pytest.mark.parametrize("kernel", kernels(*DRAWS))
def test_a_particle_starts_one_kick_an_interval(kernel):
    box = (12, 12, 12) if "spheres" in kernel else (25, 25)
    scene, state = begin(heated(kernel, 40, box, interval=INTERVAL), 0.9, -1.0, 1)
    first, word = state.moments.thermostat.copy(), int(state.random[0])
    assert np.sort(first) == pytest.approx(INTERVAL * np.arange(1, 41) / 40)
    assert not np.all(np.diff(first) > 0.0)  # in a random order
    run(state, scene, 30, interval=INTERVAL)
    due = state.clock[BASE] + state.moments.thermostat
    assert due == pytest.approx(first + 30 * INTERVAL, abs=1e-11)
    draws = (int(state.random[0]) - word) * pow(int(STEP), -1, 2**64) % 2**64
    assert draws == 30 * 40 * DRAWS[kernel]


@pytest.mark.parametrize("share", [0.0, 0.3, 1.0])
@pytest.mark.parametrize("interval", [0.1, 2.0])
def test_the_power_and_its_share_are_what_was_asked_for(share, interval):
    """Within 4 sigma (chance of failure 1e-4 each): kicks are independent of what they are given

    to, so that the energy of one scatters by <(v.k)^2> = 2 T_tr <k^2>/D in translation, and
    likewise by q^2 <w^2> <k_w^2> for each of two spins, besides by that of k^2 itself.
    """
    number, time, power, q = 40, 500.0, 2.0, 0.5
    scene, state = begin(heated(power=power, spin_share=share, interval=interval), 0.9, 0.2, 3)
    run(state, scene, 1, interval=20.0)
    before = balance(state, scene)
    E = energies(run(state, scene, 1000, interval=time / 1000), number, q)
    put_in = (balance(state, scene).ledger - before.ledger)[1]
    kicks = number * time / interval
    T_tr, T_rot = 2.0 * E.translational.mean(), 2.0 * E.rotational.mean()
    k, turn = scene.effects.thermostat[:2]
    # the variance of x^2 is 4 k^4/45 where x is uniform in [-k, k]; of energies: 2 x^2/2, twice
    # q x^2/2
    scatter = [
        2 * (2 * T_tr * k**2 / 3 + 4 * k**4 / 45),
        2 * (q * T_rot * turn**2 / 3 + (q / 2) ** 2 * 4 * turn**4 / 45),
    ]
    expected = number * time * power * np.array([1.0 - share, share])
    assert np.all(np.abs(put_in - expected) <= 4.0 * np.sqrt(kicks * np.array(scatter)))
    assert np.all(np.sqrt(kicks * np.array(scatter)) < 0.05 * number * time * power)


@pytest.mark.slow
def test_kicks_do_not_depend_on_how_particles_are_found():
    """1000 particles are sorted into cells, and anew now and then: momentum, books and kicks."""
    scene, state = begin(heated(particles=1000, box=(150, 150), interval=INTERVAL), 0.9, 0.2, 5)
    assert state.cells is not None
    before, due = balance(state, scene), np.sort(state.moments.thermostat)
    run(state, scene, 20, interval=INTERVAL)
    after = balance(state, scene)
    assert imbalance(after.ledger - before.ledger, after.energy - before.energy) < 1e-12
    assert np.abs(snapshot(state, scene).velocity.sum(axis=0)).max() < 1e-10
    assert np.sort(state.clock[BASE] + state.moments.thermostat) == pytest.approx(
        due + 20 * INTERVAL, abs=1e-11
    )
    assert state.counts[COLLISIONS] > 1000 and state.clock[BASE] + state.clock[NOW] == 10.0


@pytest.mark.parametrize("share", [0.0, 0.5, 1.0])
@pytest.mark.parametrize(("r", "beta"), [(0.95, 0.2), (0.99, -0.5)])
def test_a_dilute_heated_gas_settles_where_the_rate_equations_say(share, r, beta):
    """R within 2 % of theory's and 4 standard errors of a run of 2000 T, some 900 collisions per
    particle. At share 0 that is Lun's formula."""
    scene, state = begin(heated(particles=160, box=(100, 100), spin_share=share), r, beta, 1)
    run(state, scene, 1, interval=200.0)
    R = ratio(energies(run(state, scene, 4000, interval=INTERVAL), 160, 0.5))
    error = blocking_stderr(R)
    expected = theory.stationary_ratio(r, beta, 2, 0.5, share)
    assert error < 0.005
    assert abs(R.mean() - expected) < 4.0 * error + 0.02 * expected
    if share == 0.0:
        assert expected == pytest.approx(theory.lun_ratio(beta, 0.5))


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
    before, seen = balance(state, scene).ledger, []
    for _ in range(pieces):  # in steps that are short: a sample waits for a limited time only
        until = run(state, scene, 20, interval=measured / pieces / 20)["time"][-1]
        now = balance(state, scene).ledger
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
