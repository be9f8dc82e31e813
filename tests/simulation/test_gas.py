"""Running a gas: sampling, refreshing, steps, and errors that end a run."""

import math
import re

import numpy as np
import pytest
from brute_force import begin, run, settings
from raw import build, compile_kernels, run_point, start_gas
from schedules import COOLING, STEADY

from roughgas.base import InputError, JammedError
from roughgas.kernel.record import Sampling
from roughgas.kernel.state import ALTERED_RESTITUTIONS, BOUNDARY_HITS, EXPONENT, NOW, SPAN
from roughgas.scene import elastic
from roughgas.simulation.energies import restored
from roughgas.simulation.run_failures import collapse_error

GAS = settings("gas", 20, [25, 25])


def gas_of(r, beta, seed, refresh_every=0):
    """A Gas at its start, refreshed at this interval."""
    gas = start_gas(build(GAS, r, beta), GAS, np.random.default_rng(seed))
    gas.cool(refresh_every)
    return gas


def test_columns_are_those_of_the_kernel():
    for interval, collisions in ((0.5, None), (None, 10)):
        gas, (scene, state) = gas_of(0.9, 0.2, 1), begin(GAS, 0.9, 0.2, 1)
        if interval:
            rows, plain = gas.in_time(interval, 130), run(state, scene, 130, interval=interval)
        else:
            rows = gas.in_collisions(collisions, 130)
            plain = run(state, scene, 130, collisions=collisions)
        for name in rows:
            assert np.array_equal(rows[name], plain[name]), name
        assert gas.time == gas.sample["time"][0] == plain["time"][-1]


def test_energies_of_a_refreshed_gas_can_be_restored():
    """The same energies with and without refreshing, before chaos amplifies roundings."""
    ends = []
    for refresh_every in (0, 20):
        gas = gas_of(0.5, 0.5, 2, refresh_every)
        rows = gas.in_collisions(10, 10)
        ends.append((rows, restored(gas.energies(rows), rows["exponent"])))
    (plain, expected), (refreshed, energies) = ends
    assert refreshed["exponent"][-1] < 0.0
    assert refreshed["time"] == pytest.approx(plain["time"], rel=1e-7)
    for restored_energy, expected_energy in zip(energies, expected, strict=True):
        assert restored_energy == pytest.approx(expected_energy, rel=1e-6)


@pytest.mark.parametrize("samples", [10, 130, 230])
def test_a_gas_is_refreshed_however_its_run_is_cut_into_calls(samples):
    gas, (scene, state) = gas_of(0.5, 0.5, 2, 40), begin(GAS, 0.5, 0.5, 2)
    rows = gas.in_collisions(10, samples)
    assert np.array_equal(
        rows["time"], run(state, scene, samples, collisions=10, refresh=4)["time"]
    )
    assert gas.state.counts[EXPONENT] == state.counts[EXPONENT] < 0


def test_steps_change_no_bit_of_a_run():
    """Steps of a few collisions change neither times nor refreshes."""
    uncut, cut = gas_of(0.5, 0.5, 2, 40), gas_of(0.5, 0.5, 2, 40)
    uncut.in_collisions(40, 10)
    while cut.collisions < 390:
        assert cut.step(math.inf, 7)
    assert not cut.step(cut.time, 7)
    while cut.collisions < 400:
        cut.step(math.inf, 1)
    assert cut.time == uncut.time
    assert np.array_equal(cut.state.trajectory, uncut.state.trajectory)


def test_thermalising_conserves_the_energy():
    gas = gas_of(0.5, 0.5, 2)
    gas.sample_now()
    before = gas.energies(gas.sample)
    gas.thermalise(10.0)
    assert gas.collisions == 100 == gas.count(10.0)
    after = gas.energies(gas.sample)
    assert after.translational == pytest.approx(before.translational, rel=1e-12)
    assert after.rotational == 0.0
    walls = elastic(build(settings("walled"), 0.5, 0.5)).effects.walls
    assert (walls.restitution, walls.roughness) == (1.0, -1.0)


def test_a_jammed_gas_is_given_up(monkeypatch):
    """Here with a low limit of collisions, instead of a jammed box."""
    gas = gas_of(0.9, 0.2, 1)
    gas.in_time(2.0, 10)
    monkeypatch.setattr("roughgas.simulation.run_failures.JAM_COLLISIONS", 0.02)
    with pytest.raises(JammedError) as caught:
        gas.in_time(30.0, 100)
    assert re.fullmatch(
        r"more than 0\.02 collisions of each particle within 30 T, at t = .* T: the gas is jammed: "
        "give it more room, raise r, or sample it more often",
        str(caught.value),
    )


@pytest.mark.parametrize(
    "go_on", [lambda gas: gas.in_time(30.0, 100), lambda gas: gas.step(gas.time + 30.0, 10**6)]
)
def test_particles_that_do_little_but_hit_walls_are_given_up(monkeypatch, go_on):
    bed = settings("bed")
    gas = start_gas(build(bed, 0.9, 0.2), bed, np.random.default_rng(1))
    gas.in_time(2.0, 10)
    before = gas.state.counts[BOUNDARY_HITS]
    monkeypatch.setattr("roughgas.simulation.run_failures.HIT_LIMIT", 0.002)
    with pytest.raises(JammedError, match=r"more than 0\.002 hits of walls and floor by each part"):
        go_on(gas)
    assert gas.state.counts[BOUNDARY_HITS] - before <= math.ceil(0.002 * 30 * gas.particles) + 1


@pytest.mark.parametrize("soon", [0.0, math.inf])
def test_no_bit_depends_on_how_long_the_calls_of_the_kernel_are(monkeypatch, soon):
    plain, refreshed = gas_of(0.5, 0.5, 2), gas_of(0.5, 0.5, 2, 40)
    expected = plain.in_time(1.0, 300), refreshed.in_collisions(10, 300)
    monkeypatch.setattr("roughgas.simulation.gas.LONGEST_CALL", soon)
    plain, refreshed = gas_of(0.5, 0.5, 2), gas_of(0.5, 0.5, 2, 40)
    measured = plain.in_time(1.0, 300), refreshed.in_collisions(10, 300)
    for expected_columns, columns in zip(expected, measured, strict=True):
        for name, column in expected_columns.items():
            assert np.array_equal(column, columns[name]), name


def test_a_leg_that_ends_within_a_call_leaves_later_calls_as_long(monkeypatch):
    """As in the next replica: only the last call of each replica is cut short."""
    gas, calls = gas_of(0.9, 0.2, 1), []
    monkeypatch.setattr("roughgas.simulation.gas.LONGEST_CALL", math.inf)
    monkeypatch.setattr("roughgas.simulation.gas.SHORTEST_CALL", math.inf)
    for _ in range(3):
        calls.append(sum(1 for _ in gas.batches(Sampling(1.0, 10**9, 0), 300)))
    assert calls[0] > 5 and calls[1] <= 3 and calls[2] <= 2


SWEEP = {"r": ["0.9"], "beta": ["0"], "seeds": 1}
POINTS = {
    "bed": settings("bed", 20, [10, "open"]) | {"schedule": STEADY, "sweep": SWEEP},
    "sheared": settings("sheared", 20, [18, 18]) | {"schedule": STEADY, "sweep": SWEEP},
    "gas": settings("gas", 20, [25, 25]) | {"schedule": COOLING, "sweep": SWEEP},
}


def point(experiment, r, beta, seed):
    """A point of an experiment."""
    return run_point(build(experiment, r, beta), experiment, seed)


def test_a_gas_that_comes_to_rest_on_its_floor_is_refused():
    """Its contacts would never end; an elastic gas does not come to rest."""
    bed = settings("bed", 20, [10, "open"], floor={"amplitude": 0, "roughness": -1})
    bed |= {"schedule": STEADY | {"equilibrate": 1, "measure": 2}}
    with pytest.raises(
        InputError, match=r"^effects\.floor\.amplitude = 0\.0: must be 0\.001 a/T t"
    ):
        point(bed, 0.9, 0.2, 1)
    assert point(bed, 1.0, -1.0, 1).variables["collisions"] > 0


def test_each_composition_is_compiled_once():
    assert compile_kernels([POINTS["gas"], POINTS["gas"], POINTS["bed"]], 0.9) == 2


def test_a_collapse_in_which_no_particle_was_last_names_none():
    """At so late a time no two instants differ."""
    scene, state = begin(settings("smooth", 20, [25, 25]), 1.0, -1.0)
    state.clock[[NOW, SPAN]] = 1e300, 1.0
    state.trajectory[:, ALTERED_RESTITUTIONS] = 0.0
    assert str(collapse_error(state, scene)).startswith(
        "inelastic collapse at t = 1e+300 T: add the"
    )
    state.trajectory[[3, 5], ALTERED_RESTITUTIONS] = 1e300
    labels = sorted(state.label[[3, 5]])
    expected = f"inelastic collapse at t = 1e+300 T of particles {labels[0]}, {labels[1]}: add the"
    assert str(collapse_error(state, scene)).startswith(expected)
