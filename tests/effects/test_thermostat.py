"""Kicks of a thermostat, and thermal walls."""

import math

import numpy as np
import pytest
from brute_force import begin, run, settings, snapshot
from raw import build
from slow_cases import slow_but

from roughgas import theory
from roughgas.effects import walls
from roughgas.kernel.layout import new_state
from roughgas.kernel.mathematics import logarithm
from roughgas.kernel.state import BASE, COLLISIONS, NOW, TYPICAL_SPEED
from roughgas.simulation.energies import energies, ratio
from roughgas.simulation.energy_balance import balance, imbalance
from roughgas.statistics.errors import blocking_stderr


def heated(kernel="heated", particles=40, box=(25, 25), **thermostat):
    """Settings of a heated gas with these parameters of its thermostat."""
    return settings(kernel, particles, list(box), thermostat=thermostat)


@pytest.mark.parametrize("share", [0.0, 0.3, 1.0])
@pytest.mark.parametrize("interval", [0.1, 2.0])
def test_kicks_supply_the_stated_power_and_share(share, interval):
    """Within 4 sigma (chance of failure 1e-4 each).

    Kicks are independent of velocities, so that the energy of a kick scatters in translation by
    <(v.k)^2> = 2 T_tr <k^2>/D, for each of two spins by q^2 <w^2> <k_w^2>, and by the variance of
    k^2.
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


def test_a_gas_that_heats_up_within_a_span_predicts_no_contacts_of_many_crossings():
    """The typical speed of the clock is of the cold gas, in which horizons are 20 times longer."""
    hot = heated(box=(200, 200), power=1000.0, spin_share=0.0, interval=0.02)
    scene, state = begin(hot, 0.9, 0.2, 5)
    run(state, scene, 1, interval=2.0)
    assert state.sweep is not None and state.clock[BASE] == 0.0
    speed = math.sqrt(np.mean(np.sum(state.trajectory[:, 2:4] ** 2, axis=1)))
    assert speed > 20.0 * state.clock[TYPICAL_SPEED]
    horizons = state.agenda.complete_until - state.clock[NOW]
    assert np.max(horizons) * speed < 2.0 * scene.extent


@pytest.mark.slow
def test_kicks_are_the_same_with_cells():
    """1000 particles in cells, sorted anew at times: momentum, energy balance, times of kicks."""
    scene, state = begin(heated(particles=1000, box=(150, 150), interval=0.5), 0.9, 0.2, 5)
    assert state.cells is not None
    before, due = balance(state, scene), np.sort(state.particle_times.thermostat)
    run(state, scene, 20, interval=0.5)
    after = balance(state, scene)
    assert imbalance(after.ledger - before.ledger, after.energy - before.energy) < 1e-12
    assert np.abs(snapshot(state, scene).velocity.sum(axis=0)).max() < 1e-10
    assert np.sort(state.clock[BASE] + state.particle_times.thermostat) == pytest.approx(
        due + 20 * 0.5, abs=1e-11
    )
    assert state.counts[COLLISIONS] > 1000 and state.clock[BASE] + state.clock[NOW] == 10.0


@pytest.mark.parametrize("share", [0.0, 0.5, 1.0])
@pytest.mark.parametrize(("r", "beta"), slow_but([(0.95, 0.2)], [(0.95, 0.2), (0.99, -0.5)]))
def test_a_dilute_heated_gas_settles_at_R_of_the_rate_equations(share, r, beta):
    """R agrees with theory to 2 % and 4 standard errors; at share 0 theory is Lun's formula.

    In a run of 2000 T, some 900 collisions per particle.
    """
    scene, state = begin(heated(particles=160, box=(100, 100), spin_share=share), r, beta, 1)
    run(state, scene, 1, interval=200.0)
    R = ratio(energies(run(state, scene, 4000, interval=0.5), 160, 0.5))
    error = blocking_stderr(R)
    expected = theory.stationary_ratio(r, beta, 2, 0.5, share)
    assert error < 0.005
    assert abs(R.mean() - expected) < 4.0 * error + 0.02 * expected
    if share == 0.0:
        assert expected == pytest.approx(theory.lun_ratio(beta, 0.5))


def test_logarithms_are_accurate():
    for x in (1e-300, 1e-3, 0.3, 0.7071, 0.70711, 0.999999, 1.0, 1.0 + 1e-9, 2.0, 3.7, 1e200):
        assert logarithm(x) == pytest.approx(math.log(x), rel=1e-15, abs=1e-16)


def particles_leaving_wall(number, dimension, temperature, inertia):
    """(velocities, spins, energy booked) of particles that leave a thermal wall on the left."""
    effects = {"spin": {"inertia": inertia}, "right_wall": {}}
    effects["left_wall"] = {"temperature": temperature, "velocity": 0.5}
    experiment = {"particles": 1 + number, "box": [20] * dimension, "effects": effects}
    scene = build(experiment, 0.9, 0.0)
    position = np.full((1, dimension), 10.0)
    spin = np.zeros((1, 2 * dimension - 3))
    state = new_state(scene, position, np.full((1, dimension), -1.0), spin)
    velocities, spins = [], []
    for _ in range(number):
        with np.errstate(over="ignore"):  # of the generator's words, which wrap around
            walls.resolve_wall(scene.effects.left_wall, 1, 0, state, scene, 0, 0.0)
        velocities.append(state.trajectory[0, dimension:-1].copy())
        spins.append(state.spin[0].copy())
    return np.array(velocities), np.array(spins), state.ledger[0, 1]


@pytest.mark.parametrize("dimension", [2, 3])
def test_particles_leave_a_thermal_wall_as_they_would_leave_a_gas(dimension):
    """Means, variances and fourth moments within 4 standard errors; the energy booked."""
    T, q, number = 1.7, 0.4, 4000
    velocity, spin, booked = particles_leaving_wall(number, dimension, T, q)
    v, tangential, transverse = velocity[:, 0], velocity[:, -1] - 0.5, velocity[:, 1:-1]
    expected = [
        (v, math.sqrt(math.pi * T / 2)),
        (v**2, 2 * T),
        (v**4, 8 * T**2),
        *((x, 0.0) for x in (tangential, *transverse.T, *spin.T)),
        *((x**2, T) for x in (tangential, *transverse.T)),
        *((x**4, 3 * T**2) for x in (tangential, *transverse.T)),
        *((x**2, T / q) for x in spin.T),
        *((x**4, 3 * (T / q) ** 2) for x in spin.T),
    ]
    for sample, mean in expected:
        assert abs(sample.mean() - mean) < 4.0 * sample.std() / math.sqrt(number)
    assert v.min() > 0.0
    gained = 0.5 * (velocity[-1] @ velocity[-1] - dimension), 0.5 * q * spin[-1] @ spin[-1]
    assert booked == pytest.approx(gained, rel=1e-9)


def test_the_heat_flux_has_its_dense_and_dilute_limits():
    """A dense gas conducts by Fourier's law, a dilute gas like free particles."""
    assert theory.heat_flux(2, 1, 1e9, 1e6) == pytest.approx(theory.fourier_flux(2, 1, 1e6), 1e-6)
    free = theory.free_molecular_flux(2.0, 1.0, 1e-9, 10.0)
    assert theory.heat_flux(2.0, 1.0, 1e-9, 10.0) == pytest.approx(free, rel=1e-6)
    assert theory.thermal_conductivity(1.0, 2) == pytest.approx(1 / math.sqrt(math.pi))
    assert theory.thermal_conductivity(1.0, 3) == pytest.approx(75 / 256 / math.sqrt(math.pi))
