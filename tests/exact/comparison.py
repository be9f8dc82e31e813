"""The kernel next to the simulation in fifty digits, and the growth of rounding errors."""

import math
import random
from decimal import Decimal
from typing import NamedTuple

import numpy as np
from brute_force import run
from brute_force.bodies import Bodies, bodies_of

from exact.simulation import ZERO, Exact, minus, plus, times
from roughgas.kernel.state import BASE, COLLISIONS, LAST_FIRST, LAST_SECOND, NOW, SPAN

EPSILON = Decimal(2) ** -52
NOISE = Decimal(10) ** -30  # stays small under any growth that takes EPSILON up to 1
FOLLOWERS = 8


class Segment(NamedTuple):
    """The pair collisions from a common start that the kernel and the exact simulation share."""

    separation: np.ndarray  # after each collision
    expected: np.ndarray  # root mean square separation by rounding
    parted: float  # separation before the first different pair; inf without one

    def ratio(self, up_to):
        """Return the largest ratio of the separation to its expectation, as long as this is below
        `up_to`."""
        small = self.expected < up_to
        return np.max(self.separation[small] / self.expected[small], initial=0.0)


def exactly(state, scene, world):
    """Return the exact simulation of the kernel's present state, to the last bit, with all
    particles at the present time."""
    dimension = len(scene.box)
    base, now = _decimals(state.clock[[BASE, NOW]])
    drop = [ZERO] * 3
    drop[dimension - 1] = Decimal(world.gravity)
    order = np.argsort(state.label)
    x, v, w = [], [], []
    for i in order:
        row = _decimals(state.trajectory[i])
        position, velocity = ((*row[k : k + dimension], ZERO)[:3] for k in (0, dimension))
        elapsed = now - row[-1]
        v.append(minus(velocity, times(drop, elapsed)))
        x.append(plus(position, times(plus(velocity, v[-1]), elapsed / 2)))
        spin = () if state.spin is None else _decimals(state.spin[i])
        w.append((ZERO, ZERO, ZERO, *spin)[-3:])
    last = state.particle_times.contact_time
    last = None if last is None else [base + time for time in _decimals(last[order])]
    image_shift = ZERO
    if world.shear:
        index = scene.effects.index(scene.effects.shear)
        rank = sum(effect is not None for effect in scene.effects[:index])
        (phase,) = _decimals(state.phase[[rank]])
        image_shift = phase - Decimal(world.shear) * base
    return Exact(world, base + now, x, v, w, last, image_shift, _company(bodies_of(state, order)))


def _company(company):
    if company is None:
        return None
    *numbers, species = company
    return Bodies(*map(_decimals, numbers), species.tolist())


def _decimals(numbers):
    return [Decimal(float(number)) for number in numbers]


def separation(first, second):
    """Return the largest difference in time, any position, velocity or spin, of nearest images."""
    largest = abs(first.time - second.time)
    for i in range(len(first.x)):
        x, v = minus(first.x[i], second.x[i]), minus(first.v[i], second.v[i])
        crossed = round(x[1] / first.box[1]) if first.shear else 0
        x, v = (
            (x[0] - crossed * first.image_shift(), *x[1:]),
            (v[0] - crossed * first.shear, *v[1:]),
        )
        x = (
            a - round(a / side) * side if side else a for a, side in zip(x, first.box, strict=True)
        )
        largest = max(largest, *map(abs, (*x, *v, *minus(first.w[i], second.w[i]))))
    return largest


class Rounded:
    """The growth of rounding errors around the exact simulation, to first order.

    Copies, the followers, are led through the same events. Whenever the kernel would round, they
    are displaced at random by NOISE, relative to the largest lengths and speeds in the kernel: all
    particles at the start, and in each event its particles. So each disturbance grows as in the
    gas: exponentially, by the Lyapunov exponent, and transiently.
    """

    def __init__(self, exact, frame, span):
        """`frame` is the same state in the kernel's frame, `span` the range of its times."""
        self.random = random.Random(0)
        self.speed = max(frame.shear, *(max(map(abs, vector)) for vector in frame.v + frame.w))
        extents = [max(map(abs, vector)) for vector in frame.x]
        self.length = max(*frame.periods, *extents, self.speed * Decimal(span))
        space = len(exact.world.box) == 3
        self.in_space, self.of_spin = (True, True, space), (space, space, exact.q is not None)
        self.followers = [exact.copy() for _ in range(FOLLOWERS)]
        for follower in self.followers:
            self._displace(follower, range(len(exact.x)))

    def follow(self, events):
        for follower in self.followers:
            for event in events:
                follower.follow(event)
                self._displace(follower, [event.i] if event.j < 0 else [event.i, event.j])

    def separation(self, exact, view):
        """Return the root mean square distance from the exact simulation, for EPSILON instead of
        NOISE."""
        distances = [
            separation(view(follower), view(exact)) / NOISE * EPSILON for follower in self.followers
        ]
        return math.sqrt(sum(x * x for x in distances) / FOLLOWERS)

    def _displace(self, follower, particles):
        for i in particles:
            follower.x[i] = plus(follower.x[i], self._vector(self.in_space, self.length))
            follower.v[i] = plus(follower.v[i], self._vector(self.in_space, self.speed))
            follower.w[i] = plus(follower.w[i], self._vector(self.of_spin, self.speed))

    def _vector(self, axes, size):
        """Return a random vector with components along some of the three axes."""
        largest = NOISE * size
        return [Decimal(self.random.uniform(-1.0, 1.0)) * largest if k else ZERO for k in axes]


def next_pair(state, scene, until):
    """Return the pair of the kernel's next collision; the empty set if there is none until shortly
    after `until`."""
    collisions_before = state.counts[COLLISIONS]
    while state.counts[COLLISIONS] == collisions_before:
        remaining = until - (state.clock[BASE] + state.clock[NOW])
        if remaining < 0.0:
            return set()
        run(state, scene, 1, interval=remaining + 1.0, collisions=1)
    return {int(state.counts[LAST_FIRST]), int(state.counts[LAST_SECOND])}


def segment(state, scene, world, max_collisions=10**6, exact=None, view=lambda exact: exact):
    """Run kernel and exact simulation from the kernel's state, until they differ in a colliding
    pair or have made `max_collisions`.

    The exact simulation has the same state, or a state whose `view` from another frame is the same.
    """
    run(state, scene, 0)  # predicts all events if none are predicted yet
    start = exactly(state, scene, world)
    exact = exact or start
    rounded = Rounded(exact, start, float(state.clock[SPAN]))
    columns, parted = [(0.0, math.inf)], math.inf
    while len(columns) <= max_collisions:
        events = exact.run(1)
        pair = next_pair(state, scene, float(view(exact).time) + 1.0)
        if {events[-1].i, events[-1].j} != pair:
            parted = columns[-1][0]
            break
        rounded.follow(events)
        distance = float(separation(exactly(state, scene, world), view(exact)))
        columns.append((distance, rounded.separation(exact, view)))
    return Segment(*np.array(columns[1:]).reshape(-1, 2).T, parted)
