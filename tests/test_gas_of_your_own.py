"""`roughgas.gas`: the gas that a study's code sees, and its file."""

import math

import numpy as np
import pytest
from brute_force import settings
from raw import build, start_gas

from roughgas.gas import InputError, UnusableCheckpoint, ratio

GAS = settings("gas", 20, [25, 25])
BED = settings("bed", 20, [12.5, "open"])


def started(experiment, seed=1):
    return start_gas(build(experiment, 0.9, 0.2), experiment, np.random.default_rng(seed))


def test_positions_velocities_and_spins_are_copies_of_the_present():
    gas = started(BED)
    rows = gas.in_time(0.1, 30)
    position, velocity = gas.positions_and_velocities()
    spin, before = gas.spins(), gas.state.trajectory.copy()
    assert np.sum(velocity**2, axis=0) == pytest.approx([rows[f"vv_{k}"][-1] for k in "xy"])
    assert np.sum(spin**2) == pytest.approx(rows["ww"][-1])
    assert np.all((position[:, 0] >= 0) & (position[:, 0] < 12.5)) and position[:, 1].min() > -4.0
    for values in (position, velocity, spin):
        values[:] = 7.0
    assert np.array_equal(gas.state.trajectory, before) and not np.any(gas.state.spin == 7.0)


def test_the_last_contact_names_partners_that_touch():
    gas = started(BED)
    gas.in_time(1.0, 1)
    for _ in range(5):
        before = gas.contact_sums()
        assert gas.step(math.inf, 1)
        i, j, where = gas.last_contact()
        apart = where[0] - where[1]
        apart[0] -= 12.5 * round(apart[0] / 12.5)
        assert i < j and math.hypot(*apart) == pytest.approx(2.0, rel=1e-9)
        assert gas.contact_sums()[0] > before[0]


def test_what_a_gas_lacks_is_named():
    gas = started(GAS)
    gas.in_time(0.1, 1)
    with pytest.raises(InputError, match=r"contact sums needs effects\.contact_averages"):
        gas.contact_sums()


def test_a_restored_gas_goes_on_with_the_same_bits(tmp_path):
    def go_on(gas):
        gas.cool(gas.count(4))
        return ratio(gas.energies(gas.in_collisions(gas.count(1), 40)))

    uninterrupted, saved = started(GAS), tmp_path / "gas.npz"
    uninterrupted.thermalise(5)
    uninterrupted.save(saved, "mine", {"seen": np.arange(3.0)})
    costs = uninterrupted.costs.collisions
    expected = go_on(uninterrupted)
    with pytest.raises(UnusableCheckpoint, match="other settings"):
        started(GAS).restore(saved, "another")
    with pytest.raises(FileNotFoundError):
        started(GAS).restore(tmp_path / "none.npz", "mine")
    another_seed = started(GAS, seed=2)
    assert np.array_equal(another_seed.restore(saved, "mine")["seen"], np.arange(3.0))
    assert another_seed.costs.collisions == costs
    assert np.array_equal(go_on(another_seed), expected)
