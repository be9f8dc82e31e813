"""Ties: events at the same instant."""

import numpy as np
from brute_force import begin, run, scene_of, settings, snapshot

from roughgas.kernel.memory import new_state
from roughgas.kernel.state import COLLISIONS

ROOT_3 = np.sqrt(3.0)
TRIANGLE = np.array([[0.0, 0.0], [2.0, 0.0], [1.0, ROOT_3]])
MIDDLE = np.array([20.0, 20.0])


def hit_triangle(rng):
    """Three disks in contact at rest; a fourth hits two of them at once."""
    position = np.vstack([TRIANGLE, [1.0, -4.0]]) + MIDDLE
    return position, np.array([[0, 0], [0, 0], [0, 0], [0, 1.0]])


def imploding_triangle(rng):
    """Three disks in contact that all move to their centre."""
    return TRIANGLE + MIDDLE, TRIANGLE.mean(axis=0) - TRIANGLE


def square_lattice(rng):
    """Columns of a perfect lattice that alternately move left and right."""
    place = np.stack(np.meshgrid(*[np.arange(8)] * 2, indexing="ij"), axis=-1).reshape(-1, 2)
    velocity = np.zeros((64, 2))
    velocity[:, 0] = np.where(place[:, 0] % 2, -1.0, 1.0)
    return 5.0 * place + 2.5, velocity


def touching_cluster(rng):
    """A piece of a perfect lattice, all neighbours in contact, with random velocities."""
    place = np.stack(np.meshgrid(*[np.arange(6)] * 2, indexing="ij"), axis=-1).reshape(-1, 2)
    return 2.0 * place + 14.0, rng.integers(-4, 5, (36, 2)) / 4.0


def cradle(rng):
    """Disks in a row, in contact; one comes flying from each side at the same speed."""
    position = np.zeros((7, 2)) + MIDDLE
    position[:, 0] += [-10, -4, -2, 0, 2, 4, 10]
    velocity = np.zeros((7, 2))
    velocity[0, 0], velocity[-1, 0] = 1.0, -1.0
    return position, velocity


def lattice_gas(rng):
    """The start of a gas, whose sites are a lattice."""
    scene, state = begin(settings("gas", 40, [40, 40]), 0.9, 0.3, int(rng.integers(100)))
    shot = snapshot(state, scene)
    return shot.position, shot.velocity


SCENES = (hit_triangle, imploding_triangle, square_lattice, touching_cluster, cradle, lattice_gas)


def test_ties_do_not_depend_on_the_numbering(margins):
    """Bitwise the same but for the numbers, at r = 1 and r = 0.9, until 20 T later."""
    numberings = margins.size(quick=4, full=60)
    different = contacts = 0
    for place in SCENES:
        for r in (1.0, 0.9):
            rng = np.random.default_rng(5)
            position, velocity = place(rng)
            ends = [outcome(position, velocity, r, rng) for _ in range(numberings)]
            different += sum(end != ends[0] for end in ends)
            contacts = max(contacts, ends[0][1] / len(position))
    tried = {"tried": numberings * 2 * len(SCENES), "unit": "runs"}
    margins.at_most("runs that end differently", different, 0, **tried)
    margins.at_most("contacts a particle", contacts, 50, **tried)


def outcome(position, velocity, r, rng):
    """(all bits, collisions) of a run, as if the particles had not been numbered at random."""
    scene, _ = scene_of(settings("gas", len(position), [40, 40]), r, 0.3)
    order = rng.permutation(len(position))
    state = new_state(scene, position[order], velocity[order], np.zeros((len(position), 1)))
    run(state, scene, 1, interval=20.0)
    back = np.argsort(order)
    shot = snapshot(state, scene)
    parts = (part[back].tobytes() for part in (shot.position, shot.velocity, shot.spin))
    return b"".join(parts), int(state.counts[COLLISIONS])
