"""Displacements through periodic boundaries, and rotations, against the brute force."""

import numpy as np
import pytest
from brute_force import begin, run, scene_of, settings, snapshot
from brute_force.comparison import brute_force_from
from raw import build, run_point, start_gas, state_from
from schedules import STEADY
from slow_cases import slow_but

from roughgas.data.point import as_dataset
from roughgas.effects import EFFECTS
from roughgas.effects.paths import Paths
from roughgas.kernel.state import EXPONENT
from roughgas.simulation.free_flight import in_starting_order, rotations, unwrapped_positions
from roughgas.simulation.saved_states import initial_states_of
from roughgas.simulation.scene_switch import switch_scene

TOLERANCE = 1e-9
MIXTURE = {
    "species": [
        {"name": "small", "number": 4, "radius": 1.0},
        {"name": "large", "number": 2, "radius": 1.5, "mass": 2.0},
    ]
}
GASES = {
    "shaken": (settings("shaken", 6, [12, 12]), 0.3),
    "heated": (settings("heated", 6, [12, 12]), 0.3),
    "sheared": (settings("sheared", 6, [12, 12]), 0.3),
    "bed": (settings("bed", 6, [10, "open"]), 0.3),
    "bath": (settings("bath", 6, [12, 12]), 0.3),
    "spheres": (settings("spheres", 6, [6, 7, 8]), 0.3),
    "mixture": (settings("heated", 6, [14, 12]) | MIXTURE, 0.3),
}


def with_paths(experiment):
    """The experiment with the effect `paths`."""
    return experiment | {"effects": experiment["effects"] | {"paths": {}}}


def permute_labels(state):
    """Give the particles labels in random order; on a lattice labels follow the order of memory."""
    state.label[:] = np.random.default_rng(4).permutation(len(state.label))


class BruteForcePath:
    """Sums of displacements and rotations over the flights of a brute-force simulation."""

    def __init__(self, brute):
        self.brute, self.move = brute, brute._move
        self.displacement = np.zeros_like(brute.x)
        self.rotation = np.zeros(brute.number)
        brute._move = self

    def __call__(self, duration):
        self.displacement += self.brute.v * duration
        self.displacement += 0.5 * self.brute.world.fall(duration) * duration
        self.rotation += self.brute.w[:, 2] / self.brute.radius * duration
        self.move(duration)


QUICK_GASES = {"heated", "bath", "spheres"}


@pytest.mark.parametrize("name", slow_but(QUICK_GASES, GASES))
def test_displacements_and_rotations_are_those_of_the_brute_force(name):
    """Particles cross the box between two instants."""
    experiment, beta = GASES[name]
    experiment = with_paths(experiment) | {"schedule": STEADY}
    scene, world = scene_of(experiment, 0.9, beta)
    scene, state = begin(experiment, 0.9, beta, 7)
    permute_labels(state)
    state.trajectory[:, len(scene.box) : -1] *= 8.0  # fast: many crossings before chaos grows
    first = unwrapped_positions(state, scene)
    brute = brute_force_from(world, snapshot(state, scene))
    path = BruteForcePath(brute)
    axes = slice(1 if scene.effects.shear else 0, None)
    for time in (0.7, 1.5):
        run(state, scene, 1, interval=time - brute.time)
        brute.run_until(time)
        displacement = (unwrapped_positions(state, scene) - first)[:, axes]
        assert displacement == pytest.approx(path.displacement[:, axes], abs=TOLERANCE)
        if len(scene.box) == 2:
            assert rotations(state) == pytest.approx(path.rotation, abs=TOLERANCE)
    assert np.any(state.paths.crossings[:, axes])
    assert rotations(state) is None or np.abs(rotations(state)).max() > 0.5


def dense_path(gas, advance, samples):
    """Displacements (N, D), summed over steps so short that the nearest image is the true one.

    Along the flow of a sheared gas it is not.
    """
    before = gas.positions_and_velocities()[0][np.argsort(gas.state.label)]
    lengths = [length or np.inf for length in gas.scene.box]
    total = np.zeros_like(before)
    for _ in range(samples):
        advance()
        position = gas.positions_and_velocities()[0][np.argsort(gas.state.label)]
        step = position - before
        for axis, length in enumerate(lengths):
            if np.isfinite(length):
                step[:, axis] -= length * np.rint(step[:, axis] / length)
        steps = step[:, 1:] if gas.scene.effects.shear else step
        assert np.all(np.abs(steps) < 0.4 * np.array(lengths)[-steps.shape[1] :])
        total, before = total + step, position
    return total


@pytest.mark.slow
@pytest.mark.parametrize(("number", "box"), [(16, [12, 12]), (900, [80, 80])])
def test_paths_are_those_of_dense_observations_even_if_particles_are_sorted_anew(number, box):
    """Paths of 30 T; 900 particles are in cells, and their order in memory changes."""
    experiment = with_paths(settings("shaken" if number < 500 else "sheared", number, box))
    gas = start_gas(build(experiment, 0.9, 0.3), experiment, np.random.default_rng(1))
    first, order = unwrapped_positions(gas.state, gas.scene), gas.state.label.copy()
    total = dense_path(gas, lambda: gas.in_time(0.5, 1), 60)
    displacement = unwrapped_positions(gas.state, gas.scene) - first
    assert displacement[:, 1] == pytest.approx(total[:, 1], abs=TOLERANCE)
    assert np.count_nonzero(gas.state.paths.crossings[:, 1]) > number / 40
    assert number < 500 or not np.array_equal(gas.state.label, order)


def test_paths_continue_through_refreshes_of_a_cooling_gas():
    """Each refresh brings all particles into the box, and changes the units of time and spin."""
    experiment = with_paths(settings("spheres", 40, [12, 12, 12]))
    gas = start_gas(build(experiment, 0.6, 0.3), experiment, np.random.default_rng(1))
    gas.cool(40)
    gas.sample_now()
    first = unwrapped_positions(gas.state, gas.scene)
    total = dense_path(gas, lambda: gas.step(np.inf, 5), 160)
    displacement = unwrapped_positions(gas.state, gas.scene) - first
    assert gas.state.counts[EXPONENT] < -2
    assert np.any(gas.state.paths.crossings, axis=1).sum() > 10
    assert displacement == pytest.approx(total, abs=TOLERANCE)


@pytest.mark.slow
def test_paths_continue_through_thermal_walls():
    """Thermal walls change velocities along a periodic axis of the box as well."""
    walled = settings("container", 16, [14, 14])
    walled["effects"] = {"spin": {"inertia": 0.5}, "bottom_wall": {"temperature": 2.0}, "lid": {}}
    experiment = with_paths(walled)
    gas = start_gas(build(experiment, 0.9, 0.3), experiment, np.random.default_rng(1))
    first = unwrapped_positions(gas.state, gas.scene)
    total = dense_path(gas, lambda: gas.in_time(0.25, 1), 400)
    displacement = unwrapped_positions(gas.state, gas.scene) - first
    assert displacement == pytest.approx(total, abs=TOLERANCE)
    assert np.any(gas.state.paths.crossings[:, 0])


def test_paths_continue_through_a_change_of_the_scene():
    """The change folds all particles into the box, some of them from other images."""
    experiment = with_paths(settings("heated", 40, [30, 30]))
    gas = start_gas(build(experiment, 0.9, 0.3), experiment, np.random.default_rng(1))
    permute_labels(gas.state)
    crossed = np.zeros(40, bool)
    for power in 20 * (3.0, 1.0):
        gas.in_time(1.0, 1)
        path, angles = unwrapped_positions(gas.state, gas.scene), rotations(gas.state)
        counted = gas.state.paths.crossings.copy()
        changed = with_paths(settings("heated", 40, [30, 30], thermostat={"power": power}))
        switch_scene(gas, build(changed, 0.9, 0.3), gas.time)
        assert unwrapped_positions(gas.state, gas.scene) == pytest.approx(path, abs=TOLERANCE)
        assert rotations(gas.state) == pytest.approx(angles, abs=TOLERANCE)
        crossed |= np.any(counted != gas.state.paths.crossings, axis=1)
    assert np.count_nonzero(crossed) > 4


@pytest.mark.slow  # compiles a kernel of its own
def test_a_run_that_counts_paths_has_the_bits_of_one_that_does_not():
    states = []
    bare = settings("sheared", 40, [20, 20])
    for experiment in (bare, with_paths(bare)):
        scene, state = begin(experiment, 0.9, 0.3, 5)
        run(state, scene, 4, interval=10.0)
        states.append(state)
    assert states[0].paths is None and states[1].paths is not None
    assert states[0].trajectory.tobytes() == states[1].trajectory.tobytes()
    assert states[0].ledger.tobytes() == states[1].ledger.tobytes()
    assert EFFECTS["paths"] is Paths


def test_rotations_of_a_continued_run_begin_at_zero():
    """Flights that began before the continuation count from its start."""
    experiment = settings("sheared", 16, [20, 20]) | {"schedule": STEADY, "keep_state": True}
    point = run_point(build(experiment, 0.9, 0.3), experiment, 5)
    attributes = {"experiment": "x", "scale": "small"} | point.attributes
    (initial,) = initial_states_of(as_dataset(point._replace(attributes=attributes)))
    scene = build(with_paths(experiment), 0.9, 0.3)
    state, begun, _ = state_from(initial, scene, experiment, np.random.default_rng(0))
    assert begun is not None  # the memory is used, though that run counted no paths
    assert np.all(rotations(state) == 0.0)
    spin = in_starting_order(state, state.spin[:, 0])
    run(state, scene, 1, interval=1e-6)
    assert rotations(state) == pytest.approx(spin * 1e-6, rel=1e-6)
