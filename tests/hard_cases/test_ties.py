"""Ties: events at the same instant."""

import numpy as np
from brute_force import begin, run, scene_of, settings, snapshot

from roughgas.kernel.layout import new_state
from roughgas.kernel.state import COLLISIONS

ROOT_3 = np.sqrt(3.0)
TRIANGLE = np.array([[0.0, 0.0], [2.0, 0.0], [1.0, ROOT_3]])
CENTRE = np.array([20.0, 20.0])


def hit_triangle(rng):
    """Three disks in contact at rest; a fourth hits two of them at once."""
    position = np.vstack([TRIANGLE, [1.0, -4.0]]) + CENTRE
    return position, np.array([[0, 0], [0, 0], [0, 0], [0, 1.0]])


def imploding_triangle(rng):
    """Three disks in contact that move towards their centre."""
    return TRIANGLE + CENTRE, TRIANGLE.mean(axis=0) - TRIANGLE


def square_lattice(rng):
    """Columns of a perfect lattice that alternately move left and right."""
    sites = np.stack(np.meshgrid(*[np.arange(8)] * 2, indexing="ij"), axis=-1).reshape(-1, 2)
    velocity = np.zeros((64, 2))
    velocity[:, 0] = np.where(sites[:, 0] % 2, -1.0, 1.0)
    return 5.0 * sites + 2.5, velocity


def touching_cluster(rng):
    """A piece of a perfect lattice, all neighbours in contact, with random velocities."""
    sites = np.stack(np.meshgrid(*[np.arange(6)] * 2, indexing="ij"), axis=-1).reshape(-1, 2)
    return 2.0 * sites + 14.0, rng.integers(-4, 5, (36, 2)) / 4.0


def cradle(rng):
    """A row of disks in contact, hit from both sides at the same speed."""
    position = np.zeros((7, 2)) + CENTRE
    position[:, 0] += [-10, -4, -2, 0, 2, 4, 10]
    velocity = np.zeros((7, 2))
    velocity[0, 0], velocity[-1, 0] = 1.0, -1.0
    return position, velocity


def lattice_gas(rng):
    """The initial state of a gas, on a lattice."""
    scene, state = begin(settings("gas", 40, [40, 40]), 0.9, 0.3, int(rng.integers(100)))
    shot = snapshot(state, scene)
    return shot.position, shot.velocity


SCENES = (hit_triangle, imploding_triangle, square_lattice, touching_cluster, cradle, lattice_gas)


def test_ties_do_not_depend_on_the_numbering(margins):
    """The same bits after 20 T under any numbering, at r = 1 and r = 0.9."""
    numberings = margins.size(quick=4, full=60)
    different = contacts = 0
    for start in SCENES:
        for r in (1.0, 0.9):
            rng = np.random.default_rng(5)
            position, velocity = start(rng)
            ends = [outcome(position, velocity, r, rng) for _ in range(numberings)]
            different += sum(end != ends[0] for end in ends)
            contacts = max(contacts, ends[0][1] / len(position))
    tried = {"tried": numberings * 2 * len(SCENES), "unit": "runs"}
    margins.at_most("runs that end differently", different, 0, **tried)
    margins.at_most("contacts a particle", contacts, 50, **tried)


def outcome(position, velocity, r, rng):
    """(bytes of the final state in the original order, collisions) of a run in random order."""
    scene, _ = scene_of(settings("gas", len(position), [40, 40]), r, 0.3)
    order = rng.permutation(len(position))
    state = new_state(scene, position[order], velocity[order], np.zeros((len(position), 1)))
    run(state, scene, 1, interval=20.0)
    original_order = np.argsort(order)
    shot = snapshot(state, scene)
    arrays = (
        array[original_order].tobytes() for array in (shot.position, shot.velocity, shot.spin)
    )
    return b"".join(arrays), int(state.counts[COLLISIONS])
