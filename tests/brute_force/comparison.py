"""Comparison of the kernel with the brute force: collision by collision from a common state."""

from collections import Counter

import numpy as np

from brute_force.bodies import bodies_of
from brute_force.kicks import Drive
from brute_force.scenes import run
from brute_force.simulation import BruteForce
from brute_force.world import Snapshot
from roughgas.kernel.state import BASE, BOUNDARY_HITS, LAST_FIRST, LAST_SECOND, NOW

RELATIVE_DISPLACEMENT = 1e-15
DISPLACED_COPIES = 2  # a single copy may happen to be displaced where chaos hardly grows


def snapshot(state, scene):
    """The Snapshot of a kernel's state: all particles moved in free flight to the present.

    The particles are in the order of the start, whatever their order in the kernel's memory.
    """
    dimension, present = len(scene.box), state.clock[NOW]
    order = np.argsort(state.label)
    trajectory = state.trajectory[order]
    position, velocity = trajectory[:, :dimension], trajectory[:, dimension:-1]
    elapsed = present - trajectory[:, -1]
    position += velocity * elapsed[:, None]
    if scene.effects.gravity is not None:
        for axis, g in scene.effects.gravity.along.items():
            position[:, axis] += 0.5 * g * elapsed**2
            velocity[:, axis] += g * elapsed
    spin = None if state.spin is None else state.spin[order]
    time, drive = state.clock[BASE] + present, drive_of(state, order)
    word = 0 if state.random is None else int(state.random[0])
    return Snapshot(time, position, velocity, spin, drive, bodies_of(state, order), word)


def drive_of(state, order):
    """The Drive of a kernel's state: its next kicks or bath steps; None without either."""
    drives = ("thermostat", "langevin", "speed_kicks")
    times = [getattr(state.particle_times, name, None) for name in drives]
    next_steps = next((steps for steps in times if steps is not None), None)
    if next_steps is None:
        return None
    word = 0 if state.random is None else state.random[0]
    return Drive(list(state.clock[BASE] + next_steps[order]), word, list(state.label))


def brute_force_from(world, shot, last_contact=None):
    """A brute-force simulation that starts from a snapshot of the kernel."""
    *particles, drive, bodies, word = shot[1:]
    return BruteForce(world, *particles, shot.time, last_contact, drive, bodies, word)


def largest_overlap(state, scene, world):
    """The largest overlap of two of the kernel's particles, in a; negative if none touch."""
    brute = brute_force_from(world, snapshot(state, scene))
    i, j = brute.pairs.T
    separations = brute.x[i] - brute.x[j]
    squared_distances = np.min(
        [((separations + shift) ** 2).sum(axis=1) for shift in brute.images()[0]], axis=0
    )
    return float(np.max(brute.radius[i] + brute.radius[j] - np.sqrt(squared_distances)))


def compare(shot, brute):
    """The largest difference from a brute force, of times, positions, velocities or spins."""
    kernel = brute_force_from(brute.world, shot._replace(time=brute.time))
    position_differences, velocity_differences = kernel.x - brute.x, kernel.v - brute.v
    # a particle on the edge of the box may be folded either way
    distances = [
        np.abs(position_differences + shift).max(axis=1)
        + np.abs(velocity_differences + drift).max(axis=1)
        for shift, drift in zip(*brute.images(), strict=True)
    ]
    spin_differences = np.abs(kernel.w - brute.w)
    return float(
        max(abs(shot.time - brute.time), np.min(distances, axis=0).max(), spin_differences.max())
    )


class Comparison:
    """A comparison of both simulations from the same state, collision by collision.

    Chaos multiplies any difference: each `segment` starts the brute force anew from the kernel's
    state, and copies of it from positions displaced by some roundings, whose divergence is the
    difference to be expected.
    """

    def __init__(self, state, scene, world):
        self.state, self.scene, self.world = state, scene, world
        self.last_contact = np.full(len(state.changes), -np.inf)
        self.rng = np.random.default_rng(0)
        self.events = Counter()

    def segment(self, collisions):
        """(difference, difference to be expected) after this number of pair collisions."""
        run(self.state, self.scene, 0)  # predicts the first events of a state that has not run yet
        start = snapshot(self.state, self.scene)
        brute = brute_force_from(self.world, start, self.last_contact)
        displaced_copies = [
            brute_force_from(self.world, self._displaced(start), self.last_contact)
            for _ in range(DISPLACED_COPIES)
        ]
        counts = self.state.counts
        hits_before = int(counts[BOUNDARY_HITS])
        events = Counter()
        for _ in range(collisions):
            steps = brute.run(1)
            run(self.state, self.scene, 1, collisions=1)
            pair = {int(counts[LAST_FIRST]), int(counts[LAST_SECOND])}
            assert {steps[-1].i, steps[-1].j} == pair, (steps[-1], pair)
            events.update(event.kind for event in steps)
        assert counts[BOUNDARY_HITS] - hits_before == events.total() - collisions - events["kick"]
        assert self.state.random is None or brute.random.word == self.state.random[0]
        for displaced in displaced_copies:
            displaced.run(collisions)
        self.last_contact = brute.last_contacts
        self.events += events
        expected = max(compare(displaced.snapshot(), brute) for displaced in displaced_copies)
        return compare(snapshot(self.state, self.scene), brute), expected

    def assert_same(self, segments, collisions):
        """Assert that both simulations make the same collisions, in segments of `collisions` each.

        The tolerance is the growth by chaos of a displacement of the start by a few roundings.
        """
        measured = np.array([self.segment(collisions) for _ in range(segments)])
        difference, expected = measured.T
        time = snapshot(self.state, self.scene).time
        assert np.all(difference < 1e-12 + 300.0 * expected + 1e-15 * time)
        assert np.median(difference) < 1e-7
        assert largest_overlap(self.state, self.scene, self.world) < 1e-11

    def _displaced(self, shot):
        """The snapshot with positions and velocities displaced by roundings."""
        position, velocity = (
            values * (1.0 + RELATIVE_DISPLACEMENT * self.rng.standard_normal(values.shape))
            for values in (shot.position, shot.velocity)
        )
        return shot._replace(position=position, velocity=velocity)
