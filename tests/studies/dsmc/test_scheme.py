"""Direct simulation Monte Carlo against exact results: single collisions, rates of a Maxwellian
gas, conservation laws, equilibrium."""

import numpy as np
import pytest

from roughgas import theory
from roughgas.tasks import dsmc

PACKING = 0.2


def gas_and_generator(particles, theta, dimension, seed):
    rng = np.random.default_rng(seed)
    return dsmc.new_gas(particles, theta, rng, dimension), rng


def energy(gas):
    """Return the kinetic energy per mass, in the gas's unit of velocity."""
    q = theory.moment_of_inertia(len(gas.axes))
    return 0.5 * np.sum(gas.velocity**2) + 0.5 * q * np.sum(gas.spin**2)


@pytest.mark.parametrize("dimension", [2, 3])
def test_elastic_particles_collide_as_often_as_theory_says(dimension):
    """Within 4 standard errors: by chance once in 16 000 times. A collision takes a geometric
    number of draws, of a fixed time each: so n of them have the relative error sqrt((1 - p)/n), p
    being the share of draws that collide. 1/N from the number of particles is 2e-4."""
    crowding = theory.number_density(PACKING, dimension) * theory.contact_value(PACKING, dimension)
    gas, rng = gas_and_generator(5000, 0.0, dimension, 1)
    samples = dsmc.run(gas, dsmc.material(1, -1, dimension, crowding=crowding), rng, 100, 5)
    accepted = gas.counts[dsmc.COLLISIONS] / gas.counts[dsmc.DRAWS]
    error = np.sqrt((1 - accepted) / gas.counts[dsmc.COLLISIONS])
    frequency = samples.collisions_per_particle[-1] / samples.time[-1]
    expected = theory.collision_frequency(1.0, PACKING, dimension)
    assert error < 1e-3
    assert frequency == pytest.approx(expected, rel=4 * error + 2e-4)
    assert np.all(gas.spin == 0.0)


@pytest.mark.parametrize("dimension", [2, 3])
@pytest.mark.parametrize("beta", [-1.0, 1.0])
def test_elastic_particles_keep_energy_and_momentum(dimension, beta):
    gas, rng = gas_and_generator(500, 0.3, dimension, 2)
    before = energy(gas)
    samples = dsmc.run(gas, dsmc.material(1, beta, dimension), rng, 1, 200)
    unit = np.exp(gas.clock[dsmc.LOG_UNIT])
    assert energy(gas) * unit**2 == pytest.approx(before, rel=1e-12)
    assert np.abs(gas.velocity.sum(axis=0)).max() < 1e-11
    if beta == -1.0:
        assert samples.log_T_tr == pytest.approx(np.zeros(200), abs=1e-12)


@pytest.mark.parametrize("dimension", [2, 3])
def test_perfectly_rough_elastic_particles_reach_equipartition(dimension):
    """Within 4 standard errors; the temperature is corrected by 1/N for the fixed total
    momentum."""
    number = 2000
    gas, rng = gas_and_generator(number, 0.2, dimension, 4)
    material = dsmc.material(1, 1, dimension)
    dsmc.run(gas, material, rng, 1, 30)
    samples = dsmc.run(gas, material, rng, 10, 200)
    for series, expected in (
        (samples.theta * (1 - 1 / number), 1.0),
        (samples.a20, 0.0),
        (samples.a02, 0.0),
        (samples.a11, 0.0),
        (samples.alignment, 0.0),
    ):
        # a finite number has cumulants of order 1/N
        error = series.std(ddof=1) / np.sqrt(len(series))
        assert series.mean() == pytest.approx(expected, abs=4 * error + 3 / number)


@pytest.mark.slow
@pytest.mark.parametrize("mu, theta", [(0.05, 0.3), (0.15, 0.3), (0.3, 5.0)])
def test_a_gas_with_friction_starts_off_at_the_rates_of_theory(mu, theta):
    """Within 4 standard errors of 40 gases, to the second order in the collisions that passed."""
    passed, gases, r, beta = 0.01, 40, 0.9, 0.0
    changes = np.empty((gases, 2))
    for seed in range(gases):
        gas, rng = gas_and_generator(50_000, theta, 2, seed)
        samples = dsmc.run(gas, dsmc.material(r, beta, mu=mu), rng, passed, 1)
        T_tr = np.exp(samples.log_T_tr[0])
        changes[seed] = T_tr - 1.0, samples.theta[0] * T_tr - theta
    rates = np.array(theory.friction_changes(1.0, theta, r, beta, mu))
    later = theory.friction_changes(1.0 + rates[0] * passed, theta + rates[1] * passed, r, beta, mu)
    expected = passed * (rates + later) / 2
    errors = changes.std(axis=0, ddof=1) / np.sqrt(gases)
    assert np.all(np.abs(changes.mean(axis=0) - expected) < 4 * errors)
    assert np.all(errors < 0.05 * np.abs(expected))


@pytest.mark.parametrize("dimension", [2, 3])
@pytest.mark.parametrize(
    "r, beta, theta", [(0.6, 0.3, 0.2), (0.9, 1.0, 3.0), (0.8, -0.7, 1.0), (0.0, 0.0, 0.5)]
)
def test_a_maxwellian_gas_starts_off_at_the_rates_of_theory(dimension, r, beta, theta):
    """Within 4 standard errors of 40 gases, exceeded by chance in one of a thousand runs of these
    tests. The rates of theory hold at the start, and are exact there; during the hundredth of a
    collision per particle they change by 1 %, for which `relax` accounts."""
    passed, gases = 0.01, 40
    material = dsmc.material(r, beta, dimension)
    changes = np.empty((gases, 2))
    for seed in range(gases):
        gas, rng = gas_and_generator(100_000, theta, dimension, seed)
        samples = dsmc.run(gas, material, rng, passed, 1)
        T_tr = np.exp(samples.log_T_tr[0])
        changes[seed] = T_tr - 1.0, samples.theta[0] * T_tr - theta
    expected = theory.relax(theta, r, beta, passed, dimension)
    errors = changes.std(axis=0, ddof=1) / np.sqrt(gases)
    off = changes.mean(axis=0) - (expected.T_tr - 1.0, expected.T_rot - theta)
    assert np.all(np.abs(off) < 4 * errors)
    rates = theory.collision_rates(r, beta, dimension)
    lost_and_gained = rates.translational_loss + rates.translational_gain * theta
    assert errors[0] < 0.03 * lost_and_gained * passed


def test_a_gas_cools_below_the_smallest_number():
    """The logarithm of the temperature goes on."""
    gas, rng = gas_and_generator(50, 0.5, 2, 6)
    samples = dsmc.run(gas, dsmc.material(0.5, 0.0), rng, 1, 4000)
    assert samples.log_T_tr[-1] < -1000
    assert np.all(np.isfinite(samples.theta)) and np.all(samples.theta > 0)
    assert np.abs(gas.velocity.sum(axis=0)).max() < 1e-12


def test_seldom_samples_waste_no_draws():
    """The gas is rescaled in between, so that the majorant fits; it cools as with frequent samples.
    2 % of the rate are five times the scatter of a difference of two gases."""
    rates = []
    for every, samples in ((1, 60), (60, 1)):
        gas, rng = gas_and_generator(4000, 0.5, 2, 7)
        end = dsmc.run(gas, dsmc.material(0.5, 0.0), rng, every, samples)
        assert end.collisions_per_particle[-1] == 60.0
        assert gas.counts[dsmc.COLLISIONS] > 0.08 * gas.counts[dsmc.DRAWS]
        rates.append(-end.log_T_tr[-1] / 60.0)
    assert rates[0] == pytest.approx(rates[1], rel=0.02)
