"""Collisions of two soft spheres: their initial states, and the measured restitution and
roughness."""

from typing import NamedTuple

import numpy as np
from study_modules import module_of_study

soft_spheres = module_of_study("accuracy", "soft_spheres")
COLUMNS, new_gas = soft_spheres.COLUMNS, soft_spheres.new_gas
springs, step = soft_spheres.springs, soft_spheres.step
INERTIA = {2: 0.5, 3: 0.4}
BOX = 8.0


class Shot(NamedTuple):
    """A pair: positions (2, D), velocities (2, D), spins (2, 2 D - 3)."""

    position: np.ndarray
    velocity: np.ndarray
    spin: np.ndarray


class Outcome(NamedTuple):
    """The measured restitution and roughness, and the pair before and after."""

    r: float
    beta: float
    before: Shot
    after: Shot


def shot(offset, dimension=2, phase=0.0):
    """Return a pair that touches at `phase` (T), with a relative velocity of 1 along the first
    axis.

    `offset` is the offset of the paths, in a: 0 for a central contact.
    """
    position = np.full((2, dimension), 2.0)
    position[1, 0] += np.sqrt(4.0 - offset**2) + phase
    position[1, 1] += offset
    velocity = np.zeros((2, dimension))
    velocity[0, 0] = 1.0
    spin = np.array([[0.3, -0.2, 0.4], [0.1, 0.5, 0.2]])[:, -(2 * dimension - 3) :]
    return Shot(position, velocity, spin)


def collide(r, beta, duration, steps, pair):
    """Simulate one contact of `duration` (T) in `steps` steps."""
    dimension = pair.position.shape[1]
    forces = springs(r, beta, INERTIA[dimension], duration)
    gas, spheres = new_gas(*pair, (BOX,) * dimension, forces)
    rows = np.empty((1, len(COLUMNS)))
    assert step(gas, spheres, duration / steps, 3 * steps, 0.0, rows) == 1
    assert rows[0, 2] == 1 and not gas.touching.any()
    after = Shot(gas.position, gas.velocity, gas.spin)
    return Outcome(*_measured_r_and_beta(pair, after), pair, after)


def _measured_r_and_beta(before, after):
    """Return r and beta, by the direction at first touch."""
    n = direction_of_contact(before)
    speeds, slips = zip(*(_contact_velocity(pair, n) for pair in (before, after)), strict=True)
    r = -speeds[1] / speeds[0]
    return r, -(slips[1] @ slips[0]) / (slips[0] @ slips[0])


def direction_of_contact(pair):
    """Return the unit vector from the second to the first particle at first touch, on straight
    paths."""
    x, u = (array[0] - array[1] for array in pair[:2])
    b, c, uu = x @ u, x @ x - 4.0, u @ u
    time = (-b - np.sqrt(b * b - uu * c)) / uu
    return (x + u * time) / 2.0


def _contact_velocity(pair, n):
    u, w = pair.velocity[0] - pair.velocity[1], pair.spin.sum(axis=0)
    speed = u @ n
    surface = w[0] * np.array([-n[1], n[0]]) if len(n) == 2 else np.cross(w, n)
    return speed, u - speed * n - surface


def momentum(pair):
    return pair.velocity.sum(axis=0)


def angular_momentum(pair):
    q = INERTIA[pair.position.shape[1]]
    positions, velocities = (
        np.pad(array, ((0, 0), (0, 3 - array.shape[1]))) for array in (pair.position, pair.velocity)
    )
    orbital = np.cross(positions, velocities).sum(axis=0)
    return orbital[-pair.spin.shape[1] :] + q * pair.spin.sum(axis=0)


def energy(pair):
    q = INERTIA[pair.position.shape[1]]
    return 0.5 * (pair.velocity**2).sum() + 0.5 * q * (pair.spin**2).sum()
