"""The kernel and the brute force side by side: what they agree on, and how well."""

from collections import Counter

import numpy as np

from brute_force.company import company_of
from brute_force.kicks import Drive
from brute_force.scenes import run
from brute_force.simulation import BruteForce
from brute_force.world import Snapshot
from roughgas.kernel.state import BASE, BOUNDARY_HITS, LAST_FIRST, LAST_SECOND, NOW

ROUNDINGS = 1e-15
DISTURBED = 2  # copies: one may happen to be displaced where chaos hardly grows


def snapshot(state, scene):
    """All particles of a kernel's state at the present instant, each in free flight.

    They stand in the order of the start, whatever order the kernel has them in.
    """
    dimension, now = len(scene.box), state.clock[NOW]
    order = np.argsort(state.label)
    trajectory = state.trajectory[order]
    position, velocity = trajectory[:, :dimension], trajectory[:, dimension:-1]
    elapsed = now - trajectory[:, -1]
    position += velocity * elapsed[:, None]
    if scene.effects.gravity is not None:
        g = scene.effects.gravity.acceleration
        position[:, -1] -= 0.5 * g * elapsed**2
        velocity[:, -1] -= g * elapsed
    spin = None if state.spin is None else state.spin[order]
    time, drive = state.clock[BASE] + now, drive_of(state, order)
    word = 0 if state.random is None else int(state.random[0])
    return Snapshot(time, position, velocity, spin, drive, company_of(state, order), word)


def drive_of(state, order):
    """Where the kicks or steps of a kernel's state stand."""
    moments = state.moments
    due = moments.langevin if moments.thermostat is None else moments.thermostat
    if due is None:
        return None
    word = 0 if state.random is None else state.random[0]
    return Drive(list(state.clock[BASE] + due[order]), word, list(state.label))


def brute_force_from(world, shot, last_contact=None):
    """A brute-force simulation that starts where the kernel stands."""
    *particles, drive, company, word = shot[1:]
    return BruteForce(world, *particles, shot.time, last_contact, drive, company, word)


def largest_overlap(state, scene, world):
    """By how much the closest pair of the kernel's particles is closer than in contact."""
    one = brute_force_from(world, snapshot(state, scene))
    i, j = one.pairs.T
    x = one.x[i] - one.x[j]
    squares = np.min([((x + shift) ** 2).sum(axis=1) for shift in one.images()[0]], axis=0)
    return float(np.max(one.radius[i] + one.radius[j] - np.sqrt(squares)))


def compare(shot, brute):
    """Largest difference of a snapshot from a brute force in time, any place, velocity or spin."""
    own = brute_force_from(brute.world, shot._replace(time=brute.time))
    x, v = own.x - brute.x, own.v - brute.v
    # a particle on the edge of the box may be folded either way
    near = [
        np.abs(x + s).max(axis=1) + np.abs(v + d).max(axis=1)
        for s, d in zip(*brute.images(), strict=True)
    ]
    spins = np.abs(own.w - brute.w)
    return float(max(abs(shot.time - brute.time), np.min(near, axis=0).max(), spins.max()))


class Beside:
    """Runs both from the same state, collision by collision, and compares.

    Chaos multiplies any difference: each `segment` starts the brute force anew where the kernel is,
    and others from places some roundings off, which tell what difference is to be expected.
    """

    def __init__(self, state, scene, world):
        self.state, self.scene, self.world = state, scene, world
        self.last_contact = np.full(len(state.changes), -np.inf)
        self.rng = np.random.default_rng(0)
        self.events = Counter()

    def segment(self, collisions):
        """(difference, difference to be expected) after so many pair collisions."""
        run(self.state, self.scene, 0)  # foresees everything if nothing has been yet
        shot = snapshot(self.state, self.scene)
        brute = brute_force_from(self.world, shot, self.last_contact)
        others = [
            brute_force_from(self.world, self._disturbed(shot), self.last_contact)
            for _ in range(DISTURBED)
        ]
        counts = self.state.counts
        hits = int(counts[BOUNDARY_HITS])
        events = Counter()
        for _ in range(collisions):
            step = brute.run(1)
            run(self.state, self.scene, 1, collisions=1)
            pair = {int(counts[LAST_FIRST]), int(counts[LAST_SECOND])}
            assert {step[-1].i, step[-1].j} == pair, (step[-1], pair)
            events.update(event.kind for event in step)
        assert counts[BOUNDARY_HITS] - hits == events.total() - collisions - events["kick"]
        assert self.state.random is None or brute.random.word == self.state.random[0]
        for other in others:
            other.run(collisions)
        self.last_contact = brute.last
        self.events += events
        expected = max(compare(other.snapshot(), brute) for other in others)
        return compare(snapshot(self.state, self.scene), brute), expected

    def assert_same(self, segments, collisions):
        """The same pairs in the same order, from the same state every `collisions` of them.

        The tolerance is what a displacement of the start by a few roundings makes of itself.
        """
        measured = np.array([self.segment(collisions) for _ in range(segments)])
        difference, expected = measured.T
        time = snapshot(self.state, self.scene).time
        assert np.all(difference < 1e-12 + 300.0 * expected + 1e-15 * time)
        assert np.median(difference) < 1e-7
        assert largest_overlap(self.state, self.scene, self.world) < 1e-11

    def _disturbed(self, shot):
        position, velocity = (
            x * (1.0 + ROUNDINGS * self.rng.standard_normal(x.shape))
            for x in (shot.position, shot.velocity)
        )
        return shot._replace(position=position, velocity=velocity)
