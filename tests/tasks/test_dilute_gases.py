"""Transport coefficients of gases without positions: time integrals, limits, and conservation."""

import numpy as np
import pytest
from tests.theory.collisions import Dsmc

from roughgas import theory
from roughgas.tasks import transport
from roughgas.tasks.transport import GasProperties, autocorrelation, integrated, memory_time

SPHERES, DISKS = GasProperties(1.0, 1.0, 3, 0.4), GasProperties(1.0, 1.0, 2, 0.5)


def test_autocorrelation_is_the_mean_of_products():
    series = np.random.default_rng(1).standard_normal((50, 3))
    expected = [np.mean(series[k:] * series[: 50 - k], axis=0) for k in range(9)]
    assert autocorrelation(series, 9) == pytest.approx(np.array(expected), abs=1e-13)


@pytest.mark.parametrize("memory", [0.8, 2.0, 4.0])
def test_an_exponential_memory_is_integrated_with_its_tail(memory):
    """To 2e-4, the error of Simpson's rule at half of the shortest memory: of the longest memory
    the observed times, 12.8, hold 92 %."""
    correlation = 3.0 * np.exp(-0.4 * np.arange(33) / memory)
    assert memory_time(correlation, 0.4) == pytest.approx(memory, rel=4e-4)


def test_a_memory_of_noise_has_no_infinite_tail():
    """Where noise rises in the last quarter, the added tail is at most this rise."""
    correlation = np.ones(33)
    assert memory_time(correlation, 1.0) == pytest.approx(32.0 + 8.0)
    with pytest.raises(ValueError, match="32 delays"):
        memory_time(np.ones(32), 1.0)


def test_the_error_of_a_memory_is_the_scatter_of_blocks():
    """Against 80 repetitions of 40 blocks; the jackknife's error is within 30 %, by chance it is
    not in 1 of 5000 cases."""
    rng, delays = np.random.default_rng(2), 0.4 * np.arange(33)
    blocks = np.exp(-delays) * (1.0 + 0.1 * rng.standard_normal((80, 40, 1)))
    blocks += 0.05 * rng.standard_normal(blocks.shape)
    times = [integrated(repetition, 0.4)[0] for repetition in blocks]
    scatter = np.std([time.value for time in times], ddof=1)
    assert np.mean([time.stderr for time in times]) == pytest.approx(scatter, rel=0.3)


@pytest.mark.parametrize("properties", [SPHERES, DISKS])
def test_units_are_collisions_per_particle(properties):
    """nu = 1 at T_tr = 1: the mean time of a collision follows from density and cross section."""
    per_density = {2: 4.0, 3: 16.0}[properties.dimension] * np.sqrt(np.pi)
    assert properties.material.crowding == pytest.approx(1.0 / per_density)


def test_first_approximations_are_memory_times():
    """Smooth spheres: 5/4 of the free time for stress; 15/8 for heat, times c = 5/2 (Chapman &
    Cowling). Perfectly rough: Pidduck's factors."""
    smooth = GasProperties(1.0, -1.0, 3, 0.4)
    assert smooth.first_approximation("viscosity") == pytest.approx(1.25)
    assert smooth.first_approximation("conductivity") == pytest.approx(5 / 2 * 15 / 8)
    q = 0.4
    factor = 6 * (1 + q) ** 2 / (6 + 13 * q)
    assert SPHERES.first_approximation("viscosity") == pytest.approx(1.25 * factor)


@pytest.mark.slow  # compiles a kernel
@pytest.mark.parametrize("properties", [SPHERES, DISKS])
def test_forces_keep_energy_and_momentum(properties):
    """A gas in shear and under a heat force keeps momentum and energy to rounding errors."""
    rng = np.random.default_rng(3)
    gas, q = properties.new_gas(50, rng), properties.inertia
    before = transport.energy_of(gas, q)
    rows = np.empty((100, 3))
    transport.record_forced(gas, properties.material, rng, q, 0.2, 0.05, 5, rows)
    assert transport.energy_of(gas, q) == pytest.approx(before, rel=1e-12)
    assert np.abs(gas.velocity.sum(axis=0)).max() < 1e-10
    assert rows[20:, 0].mean() < 0.0 < rows[20:, 1].mean()  # momentum and heat flow down


@pytest.mark.slow  # compiles a kernel
def test_fluxes_are_sums_over_particles():
    """Components have the mean squares of a Maxwellian gas: N and c N, 5 sigma of 4000 gases."""
    rng, q = np.random.default_rng(4), SPHERES.inertia
    rows, energy = np.empty((4000, 8)), 0.0
    for row in rows:
        gas = SPHERES.new_gas(30, rng)
        transport.add_fluxes(gas, q, row)
        energy += transport.energy_of(gas, q) / 4000
    v, w = gas.velocity, gas.spin
    heat = (np.sum(v**2, axis=1) + q * np.sum(w**2, axis=1)) / 2 @ v
    assert rows[-1, 5:] == pytest.approx(heat)
    stress = np.array([v[:, 0] @ v[:, 1], v[:, 0] @ v[:, 2], v[:, 1] @ v[:, 2]])
    assert rows[-1, [0, 2, 3]] == pytest.approx(stress)
    squares = np.mean(rows**2, axis=0) / 30
    assert squares[:5].mean() == pytest.approx(1.0, rel=0.1)  # 1/N, and 1 % of chance
    assert squares[5:].mean() == pytest.approx(4.0, rel=0.1)
    assert energy == pytest.approx(30 * 6.0)


@pytest.mark.slow  # 15 s each
@pytest.mark.parametrize("properties", [SPHERES, GasProperties(1.0, -1.0, 3, 0.4)])
def test_viscosity_is_the_one_of_an_independent_simulation(properties):
    """A gas in shear by the slow DSMC of the tests, which shares no code: both within 4 combined
    errors, some 3 %; by chance they are not in 1 of 15 000 cases. There T_tr is 2/3, and all
    collisions of a step happen at once: the stress after it falls linearly, not exponentially."""
    rate = 0.1
    ours = transport.forced_coefficients(properties, 1000, rate, 2000.0, 6)["viscosity"]
    material = properties.r, properties.beta, 3
    gas = theory.mixture([{"fraction": 1, "inertia": properties.inertia}], *material)
    slow = Dsmc(gas, 4000, 7, T_rot=1.0 if properties.spins else 0.0)
    samples = []
    for step in range(4000):
        passed = slow.collide(0.1)
        slow.v[:, 0] -= rate * passed * slow.v[:, 1]
        if step >= 400:
            samples.append(-np.mean(slow.v[:, 0] * slow.v[:, 1]) / (2 / 3 * rate))
    blocks = np.reshape(samples, (40, -1)).mean(axis=1)
    first = properties.first_approximation("viscosity")
    error = blocks.std(ddof=1) / np.sqrt(40) / first
    assert abs(blocks.mean() / first - ours.value) < 4.0 * np.hypot(error, ours.stderr)
