"""Many soft spheres: the list of neighbours, conservation, the collision frequency."""

import numpy as np
import pytest
from brute_force import begin, settings
from tests.study_modules import module_of_study

from roughgas.statistics.errors import blocking_stderr
from roughgas.theory import collision_frequency

soft_spheres = module_of_study("accuracy", "soft_spheres")
BUILDS, COLUMNS, PAIRS = soft_spheres.BUILDS, soft_spheres.COLUMNS, soft_spheres.PAIRS
new_gas, springs, step = soft_spheres.new_gas, soft_spheres.springs, soft_spheres.step
PACKING = 0.1


def gas_of(r, beta, duration, kernel="gas", number=160, packing=PACKING, skin=1.0, seed=1):
    dimension = 3 if kernel == "spheres" else 2
    volume = np.pi if dimension == 2 else 4.0 * np.pi / 3.0
    side = (number * volume / packing) ** (1.0 / dimension)
    scene, state = begin(settings(kernel, number, [side] * dimension), r, beta, seed)
    position, velocity = np.split(state.trajectory[:, :-1], 2, axis=1)
    velocity = velocity / np.sqrt((velocity**2).mean())
    spin = np.random.default_rng(seed).standard_normal((number, 2 * dimension - 3))
    forces = springs(r, beta, scene.effects.spin.inertia, duration)
    return new_gas(position, velocity, spin, scene.box, forces, skin)


def run(gas, spheres, dt, steps, samples=1, temperature=0.0):
    rows = np.empty((samples, len(COLUMNS)))
    assert step(gas, spheres, dt, steps, temperature, rows) == samples
    return rows


@pytest.mark.parametrize("kernel", ["gas", pytest.param("spheres", marks=pytest.mark.slow)])
def test_the_list_of_neighbours_changes_nothing(kernel):
    """Narrow and wide skins list other pairs at other times: the same motion to rounding.

    Contacts are short, so that no particle has two at a time, whose order would matter a little.
    """
    ends = []
    for skin in (0.3, 1.5):
        gas, spheres = gas_of(0.8, 0.2, 1e-3, kernel, 64, 0.15, skin)
        rows = run(gas, spheres, 1e-4, 30000)
        moved = gas.position - np.floor(gas.position / spheres.box) * spheres.box
        ends.append((moved, gas.velocity, gas.spin, rows[0, 2], gas.counts[BUILDS]))
    first, second = ends
    for narrow, wide in zip(first[:3], second[:3], strict=True):
        assert narrow == pytest.approx(wide, abs=1e-6)
    assert first[3] == second[3] > 20 and first[4] > 3 * second[4]


def test_the_list_holds_every_pair_that_overlaps():
    gas, spheres = gas_of(0.8, 0.2, 0.1, packing=0.4)
    run(gas, spheres, 0.01, 200)
    for _ in range(20):
        run(gas, spheres, 0.01, 10)
        listed = {tuple(pair) for pair in gas.pair[: gas.counts[PAIRS]]}
        x = gas.position[:, None] - gas.position
        x -= np.array(spheres.box) * np.round(x / spheres.box)
        near = np.argwhere(np.triu((x**2).sum(axis=2) < 4.0, 1))
        assert len(near) > 0 and {tuple(pair) for pair in near} <= listed


def test_rescaling_keeps_the_ratio_and_sets_the_temperature():
    gas, spheres = gas_of(0.8, 0.2, 0.05)
    rows = run(gas, spheres, 0.005, 100, 1, temperature=2.0)
    assert (gas.velocity**2).mean() == pytest.approx(2.0, rel=1e-12)
    assert (gas.spin**2).sum() / (gas.velocity**2).sum() == pytest.approx(rows[0, 1] / rows[0, 0])


def test_too_many_neighbours_are_noticed():
    gas, spheres = gas_of(0.9, 0.0, 0.05, packing=0.4)
    cramped = gas._replace(touching=gas.touching[:20])
    assert step(cramped, spheres, 0.005, 10, 0.0, np.empty((1, 3))) == 0


def test_the_collision_frequency_follows_enskog():
    """Elastic and smooth, at t_c nu = 0.02 and 0.01, extrapolated to 0; within 3.5 standard errors
    (once in 2000 seeds). Finite contacts make collisions rarer by about their share of time."""
    nu = collision_frequency(1.0, PACKING)
    frequencies, errors = [], []
    for share in (0.02, 0.01):
        duration = share / nu
        gas, spheres = gas_of(1.0, -1.0, duration)
        dt, per_unit = duration / 10, round(10 / share)
        run(gas, spheres, dt, per_unit, 20)
        contacts = run(gas, spheres, dt, per_unit, 600)[:, 2]
        rates = np.diff(contacts) * 2.0 / 160 / (per_unit * dt) / nu
        frequencies.append(rates.mean())
        errors.append(blocking_stderr(rates))
    assert frequencies[0] < frequencies[1] < 1.0
    limit, error = 2.0 * frequencies[1] - frequencies[0], np.hypot(2.0 * errors[1], errors[0])
    assert error < 0.012
    assert limit == pytest.approx(1.0, abs=3.5 * error)
