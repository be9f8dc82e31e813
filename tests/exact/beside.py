"""The kernel beside the simulation in fifty digits, and what roundings make of themselves."""

import math
import random
from decimal import Decimal
from typing import NamedTuple

import numpy as np
from brute_force import run
from brute_force.company import Company, company_of

from exact.simulation import ZERO, Exact, minus, plus, times
from roughgas.kernel.state import BASE, COLLISIONS, LAST_FIRST, LAST_SECOND, NOW, SPAN

EPSILON = Decimal(2) ** -52
NOISE = Decimal(10) ** -30  # so small that it stays so, whatever multiplies EPSILON up to 1
FOLLOWERS = 8


class Segment(NamedTuple):
    """The pair collisions from a common start that the kernel and the exact simulation share."""

    separation: np.ndarray  # after each collision
    expected: np.ndarray  # what it is to be by roundings (root of its mean square)
    parted: float  # separation before they made different pairs collide; inf: they did not

    def ratio(self, up_to):
        """Largest ratio of the separation to what is expected, while that is below `up_to`."""
        small = self.expected < up_to
        return np.max(self.separation[small] / self.expected[small], initial=0.0)


def exactly(state, scene, world):
    """The kernel's present state to the last bit, every particle brought to the present."""
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
    last = state.moments.contact_time
    last = None if last is None else [base + time for time in _decimals(last[order])]
    slide = ZERO
    if world.shear:
        place = scene.effects.index(scene.effects.shear)
        rank = sum(effect is not None for effect in scene.effects[:place])
        (phase,) = _decimals(state.phase[[rank]])
        slide = phase - Decimal(world.shear) * base
    return Exact(world, base + now, x, v, w, last, slide, _company(company_of(state, order)))


def _company(company):
    if company is None:
        return None
    *numbers, species = company
    return Company(*map(_decimals, numbers), species.tolist())


def _decimals(numbers):
    return [Decimal(float(number)) for number in numbers]


def separation(one, other):
    """Largest difference in time, any place, velocity or spin, as the nearest image has them."""
    largest = abs(one.time - other.time)
    for i in range(len(one.x)):
        x, v = minus(one.x[i], other.x[i]), minus(one.v[i], other.v[i])
        up = round(x[1] / one.box[1]) if one.shear else 0
        x, v = (x[0] - up * one.slid(), *x[1:]), (v[0] - up * one.shear, *v[1:])
        x = (a - round(a / side) * side if side else a for a, side in zip(x, one.box, strict=True))
        largest = max(largest, *map(abs, (*x, *v, *minus(one.w[i], other.w[i]))))
    return largest


class Rounded:
    """What rounding does to the exact simulation `one`, in the small.

    Others, the followers, are led through the same events. Whenever the kernel would round, they
    are displaced at random by NOISE, relative to the largest lengths and speeds that the kernel
    has to do with: all at the start, and in each event its particles. So each disturbance is
    multiplied by what the gas makes of it, the exponential growth by the Lyapunov exponent as well
    as what passes.
    """

    def __init__(self, one, frame, span):
        """`frame` is the same state as the kernel has it, `span` how far its times may count."""
        self.random = random.Random(0)
        self.speed = max(frame.shear, *(max(map(abs, vector)) for vector in frame.v + frame.w))
        places = [max(map(abs, vector)) for vector in frame.x]
        self.length = max(*frame.periods, *places, self.speed * Decimal(span))
        space = len(one.world.box) == 3
        self.in_space, self.of_spin = (True, True, space), (space, space, one.q is not None)
        self.others = [one.copy() for _ in range(FOLLOWERS)]
        for other in self.others:
            self._displace(other, range(len(one.x)))

    def follow(self, events):
        for other in self.others:
            for event in events:
                other.follow(event)
                self._displace(other, [event.i] if event.j < 0 else [event.i, event.j])

    def separation(self, one, seen):
        """Root of the mean square of the distance from `one`, with EPSILON in NOISE's place."""
        away = [separation(seen(other), seen(one)) / NOISE * EPSILON for other in self.others]
        return math.sqrt(sum(x * x for x in away) / FOLLOWERS)

    def _displace(self, other, particles):
        for i in particles:
            other.x[i] = plus(other.x[i], self._vector(self.in_space, self.length))
            other.v[i] = plus(other.v[i], self._vector(self.in_space, self.speed))
            other.w[i] = plus(other.w[i], self._vector(self.of_spin, self.speed))

    def _vector(self, axes, size):
        """A random one, whose components are there along some of the three axes."""
        largest = NOISE * size
        return [Decimal(self.random.uniform(-1.0, 1.0)) * largest if k else ZERO for k in axes]


def next_pair(state, scene, until):
    """The kernel's next collision; none if there is none up to some time after `until`."""
    made = state.counts[COLLISIONS]
    while state.counts[COLLISIONS] == made:
        left = until - (state.clock[BASE] + state.clock[NOW])
        if left < 0.0:
            return set()
        run(state, scene, 1, interval=left + 1.0, collisions=1)
    return {int(state.counts[LAST_FIRST]), int(state.counts[LAST_SECOND])}


def segment(state, scene, world, most=10**6, exact=None, seen=lambda one: one):
    """Run both from where the kernel stands, until they make different pairs collide or `most`
    collisions are made.

    The exact simulation is one of the same state, or of one that is the same once it is `seen` from
    another frame.
    """
    run(state, scene, 0)  # foresees everything if nothing has been yet
    begun = exactly(state, scene, world)
    exact = exact or begun
    rounded = Rounded(exact, begun, float(state.clock[SPAN]))
    columns, parted = [(0.0, math.inf)], math.inf
    while len(columns) <= most:
        events = exact.run(1)
        pair = next_pair(state, scene, float(seen(exact).time) + 1.0)
        if {events[-1].i, events[-1].j} != pair:
            parted = columns[-1][0]
            break
        rounded.follow(events)
        apart = float(separation(exactly(state, scene, world), seen(exact)))
        columns.append((apart, rounded.separation(exact, seen)))
    return Segment(*np.array(columns[1:]).reshape(-1, 2).T, parted)
