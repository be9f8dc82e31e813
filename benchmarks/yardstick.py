"""The yardstick: rough disks by the plainest compiled loop.

At each collision all disks are moved; then the contacts of the two partners, and of disks about to
meet either, are predicted by a loop over all disks. The next collision is the minimum of an array.
It shares no code with the kernel: its rate measures the speed of a machine, and ratios to it can be
compared between machines.
"""

import math
import statistics
import time
from typing import NamedTuple

import numba
import numpy as np

REFERENCE = 160  # number of particles of the rate to which others are compared
NUMBERS = (40, REFERENCE, 1_000)
DENSITY = 160 / 100**2  # disks of radius 1 per area: the paper's cooling gas
PAIRS_PER_RUN = 10_000_000  # tested for contacts
RUNS = 5
INERTIA = 0.5


class Rate(NamedTuple):
    """Collisions per second of CPU in each of several runs."""

    number: int
    rates: list[float]

    @property
    def median(self) -> float:
        """Median of the runs."""
        return statistics.median(self.rates)


def measure(number: int, runs: int = RUNS) -> Rate:
    """Return the rate of a smooth elastic gas of `number` disks, like the kernel's cooling gas."""
    gas, length = _gas(number), math.sqrt(number / DENSITY)
    collisions = PAIRS_PER_RUN // (2 * number)
    run(*gas, length, 1.0, -1.0, 20 * number)  # compiles, and melts the lattice
    rates = []
    for _ in range(runs):
        begin = time.process_time()
        run(*gas, length, 1.0, -1.0, collisions)
        rates.append(collisions / (time.process_time() - begin))
    return Rate(number, rates)


def _gas(number):
    """Return positions on a lattice, Maxwellian velocities, and zero spins."""
    side = math.ceil(math.sqrt(number))
    sites = np.stack(np.divmod(np.arange(number), side), axis=-1)
    velocities = np.random.default_rng(1).standard_normal((number, 2))
    spacing = math.sqrt(number / DENSITY) / side
    return sites * spacing, velocities - velocities.mean(axis=0), np.zeros(number)


@numba.njit
def run(x, v, w, length, r, beta, collisions):
    """Make a number of collisions, changing positions, velocities and spins in place.

    Returns the elapsed time.
    """
    number, now = len(x), 0.0
    next_time, partner = np.full(number, np.inf), np.zeros(number, np.int64)
    for i in range(number):
        predict_events(x, v, i, length, now, next_time, partner)
    for _ in range(collisions):
        i = 0
        for k in range(number):
            if next_time[k] < next_time[i]:
                i = k
        j, step = partner[i], next_time[i] - now
        for k in range(number):
            for c in range(2):
                x[k, c] += v[k, c] * step
        now = next_time[i]
        collide(x, v, w, i, j, length, r, beta)
        for k in range(number):
            if k == i or k == j or partner[k] == i or partner[k] == j:
                predict_events(x, v, k, length, now, next_time, partner)
    return now


@numba.njit
def predict_events(x, v, i, length, now, next_time, partner):
    """Store the earliest contact of disk i with the nearest image of any other disk.

    After a flight of half the box another image may be first; such a contact is found late.
    """
    next_time[i] = np.inf
    for j in range(len(x)):
        dx, dy = x[j, 0] - x[i, 0], x[j, 1] - x[i, 1]
        ux, uy = v[j, 0] - v[i, 0], v[j, 1] - v[i, 1]
        dx -= length * round(dx / length)
        dy -= length * round(dy / length)
        time = now + contact(dx, dy, ux, uy)
        if j != i and time < next_time[i]:
            next_time[i], partner[i] = time, j


@numba.njit
def contact(dx, dy, ux, uy):
    """Return the time until two disks with this separation and relative velocity touch; inf if
    they do not."""
    b = dx * ux + dy * uy
    square = ux * ux + uy * uy
    c = dx * dx + dy * dy - 4.0
    discriminant = b * b - square * c
    if b >= 0.0 or discriminant < 0.0:
        return np.inf
    return max(c, 0.0) / (math.sqrt(discriminant) - b)


@numba.njit
def collide(x, v, w, i, j, length, r, beta):
    """Apply the collision rule, the paper's Eq. (collrule), to two disks in contact."""
    nx, ny = x[i, 0] - x[j, 0], x[i, 1] - x[j, 1]
    nx -= length * round(nx / length)
    ny -= length * round(ny / length)
    distance = math.sqrt(nx * nx + ny * ny)
    nx, ny = nx / distance, ny / distance
    ux, uy = v[i, 0] - v[j, 0], v[i, 1] - v[j, 1]
    normal = 0.5 * (1.0 + r) * (ux * nx + uy * ny)
    slip = uy * nx - ux * ny - (w[i] + w[j])
    turn = 0.5 * (1.0 + beta) / (1.0 + INERTIA) * slip
    px = normal * nx - INERTIA * turn * ny
    py = normal * ny + INERTIA * turn * nx
    v[i, 0], v[i, 1] = v[i, 0] - px, v[i, 1] - py
    v[j, 0], v[j, 1] = v[j, 0] + px, v[j, 1] + py
    w[i], w[j] = w[i] + turn, w[j] + turn
