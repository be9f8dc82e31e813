"""A homogeneous gas that white noise drives: supplied power, conserved momentum, and R against a
scheme that shares no code with it."""

import numpy as np
import pytest

from roughgas import theory
from roughgas.base import InputError
from roughgas.tasks import driven_dsmc, dsmc

STATE = (0.7, 0.0, 0.25)
"""r, beta, share of rotation in the drive."""


def test_kicks_keep_the_momentum_and_supply_the_prescribed_energy():
    """Kicks in plain Python: momenta to rounding, the variance of 60 000 components within 4
    standard errors (once in 16 000 times by chance; the seed is fixed)."""
    rng, size, number = np.random.default_rng(1), 0.3, 20_000
    for conserves_mean in (True, False):
        vectors = np.zeros((number, 3))
        driven_dsmc.kick(vectors, size, rng, conserves_mean)
        assert (np.abs(vectors.sum(axis=0)).max() < 1e-9) == conserves_mean
        square = np.mean(vectors**2) / size**2
        assert square == pytest.approx(1.0, abs=4 * np.sqrt(2 / vectors.size))


def test_few_particles_are_supplied_with_the_same_mean_energy():
    """Two particles, whose kicks are opposite: 4 standard errors of 4000 kicks."""
    rng, kicks = np.random.default_rng(2), 4000
    vectors, total = np.zeros((2, 1)), np.empty(kicks)
    for k in range(kicks):
        vectors[:] = 0.0
        driven_dsmc.kick(vectors, 1.0, rng, True)
        total[k] = np.sum(vectors**2)
    assert total.mean() == pytest.approx(2.0, abs=4 * total.std() / np.sqrt(kicks))


def test_fewer_steps_than_a_sample_needs_are_refused():
    model, noise, theta = driven_dsmc.disks_at_unit_temperature(*STATE, 0.2)
    rng = np.random.default_rng(3)
    gas = dsmc.new_gas(10, theta, rng)
    with pytest.raises(InputError, match="steps = 3"):
        driven_dsmc.run(gas, model, noise, rng, 3, every=4)


@pytest.mark.slow
def test_an_elastic_gas_gains_the_supplied_energy():
    """Perfectly rough disks conserve energy at contacts: the rate of gain is exact. 4 standard
    errors of 30 gases."""
    noise = driven_dsmc.WhiteNoise(0.05, 0.08, 0.1)
    steps, number, inertia = 200, 1000, 0.5
    gains = []
    for seed in range(30):
        rng = np.random.default_rng([4, seed])
        gas = dsmc.new_gas(number, 1.0, rng)
        model = dsmc.material(1.0, 1.0, crowding=driven_dsmc.UNIT_CROWDING)
        before = energy(gas, inertia)
        driven_dsmc.run(gas, model, noise, rng, steps)
        gains.append((energy(gas, inertia) - before) / steps)
        assert np.abs(gas.velocity.sum(axis=0)).max() < 1e-10
    expected = noise.velocity**2 + 0.5 * inertia * noise.spin**2
    error = np.std(gains, ddof=1) / np.sqrt(len(gains))
    assert error < 0.015 * expected
    assert np.mean(gains) == pytest.approx(expected, abs=4 * error)


def energy(gas, inertia):
    """Return the kinetic energy per particle of mass 1."""
    squares = np.sum(gas.velocity**2) + inertia * np.sum(gas.spin**2)
    return 0.5 * squares / len(gas.velocity)


@pytest.mark.slow
def test_the_same_seed_gives_the_same_bits_compiled_and_in_plain_python():
    model, noise, theta = driven_dsmc.disks_at_unit_temperature(*STATE, 0.2)
    spins = []
    for drive in (driven_dsmc.drive, driven_dsmc.drive.py_func):
        rng = np.random.default_rng(5)
        gas = dsmc.new_gas(20, theta, rng)
        drive(gas, model, noise, rng, 2, np.empty((3, len(dsmc.ROW_COLUMNS))))
        spins.append(gas.spin.copy())
    assert np.array_equal(*spins)


@pytest.mark.slow
def test_the_gas_collides_once_per_unit_of_time_and_has_R_of_the_sonine_approximation():
    """Megias & Santos (2023): R to some 0.0005 at this state, here with 4 standard errors of 8
    gases; T_tr and the frequency are 1 in the rate equations, to a few per cent."""
    values, expected = runs(8), float(theory.sonine_state(*STATE[:2], spin_share=STATE[2]).R)
    error = values.std(ddof=1) / np.sqrt(len(values))
    assert error < 0.0015
    assert values.mean() == pytest.approx(expected, abs=0.0005 + 4 * error)


def runs(number):
    """Return R of a number of gases."""
    model, noise, theta = driven_dsmc.disks_at_unit_temperature(*STATE, 0.2)
    R = []
    for seed in range(number):
        rng = np.random.default_rng([6, seed])
        gas = dsmc.new_gas(500, theta, rng)
        driven_dsmc.run(gas, model, noise, rng, 300)
        moments = driven_dsmc.run(gas, model, noise, rng, 3000)
        assert moments.T_tr == pytest.approx(1.0, abs=0.03)
        assert moments.collisions == pytest.approx(600.0, rel=0.03)
        R.append(moments.R)
    return np.array(R)


@pytest.mark.slow
def test_a_slow_scheme_finds_the_same_R():
    """Nanbu's scheme, written for whole arrays, with other kicks. Within 4 standard errors of both;
    its step of 0.02 collisions costs 0.002 at most."""
    ours, slow = runs(8), np.array([slow_R(seed) for seed in range(8)])
    errors = [values.std(ddof=1) / np.sqrt(8) for values in (ours, slow)]
    assert max(errors) < 0.003
    assert ours.mean() == pytest.approx(slow.mean(), abs=0.002 + 4 * np.hypot(*errors))


def slow_R(seed, number=2000, step=0.02, settle=40.0, length=120.0):
    """Return R of disks in the state: random pairs collide with the probability of a short step.

    The frequency of collisions does not matter for R where power and losses balance.
    """
    rng, (r, beta, share), q = np.random.default_rng([7, seed]), STATE, 0.5
    v, w = rng.standard_normal((number, 2)), rng.standard_normal(number)
    sums, power = np.zeros(2), 0.3
    for k in range(round((settle + length) / step)):
        order = rng.permutation(number)
        i, j = order[: number // 2], order[number // 2 :]
        angle = 2.0 * np.pi * rng.random(number // 2)
        n = np.stack([np.cos(angle), np.sin(angle)], axis=1)
        tangent = np.stack([-n[:, 1], n[:, 0]], axis=1)
        g = v[i] - v[j]
        normal = np.sum(g * n, axis=1)
        hit = (normal < 0.0) & (rng.random(number // 2) < -normal * step * 1.8)
        i, j, n, tangent, g, normal = i[hit], j[hit], n[hit], tangent[hit], g[hit], normal[hit]
        sliding = np.sum(g * tangent, axis=1) + w[i] + w[j]
        push = -0.5 * (1.0 + r) * normal
        shear = -0.5 * (1.0 + beta) * q / (1.0 + q) * sliding
        change = push[:, None] * n + shear[:, None] * tangent
        v[i] += change
        v[j] -= change
        w[i] += shear / q
        w[j] += shear / q
        if k % 5 == 4:
            v += np.sqrt(power * (1.0 - share) * 5 * step) * rng.standard_normal(v.shape)
            v -= v.mean(axis=0)
            w += np.sqrt(2.0 * power * share * 5 * step / q) * rng.standard_normal(number)
        elif k % 5 == 1 and k * step > settle:  # in the middle between kicks
            sums += np.sum(v**2) / (2 * (number - 1)), q * np.sum(w**2) / number
    return sums[1] / sums.sum()
