"""The same physics once more, in fifty digits and plain Python: all pairs, all images, all events.

Written from docs/physics.md. Positions, velocities and spins have three components each, in the
plane, too. Positions are never wrapped into the box: an event names the image involved. So another
simulation that differs very little can be led through the same events (`follow`), at the times on
its own paths.
"""

import decimal
import itertools
import math
from decimal import Decimal
from typing import NamedTuple

from brute_force.bodies import Bodies

from exact.falling import NEVER, ZERO, exact_side, fall, fall_or_drift
from exact.laws import restitution

DIGITS = 50
decimal.getcontext().prec = DIGITS
HALF = Decimal("0.5")


class Event(NamedTuple):
    kind: str  # pair, floor, left, right
    i: int
    j: int = -1
    image: tuple[int, int, int] = (0, 0, 0)  # of j: its shift along each axis in periods
    stroke: int = 0  # of the floor


class Exact:
    """A simulation in progress: `step` finds the next event and carries it out."""

    def __init__(self, world, time, x, v, w, last=None, first_image_shift=ZERO, company=None):
        """Start from `world` as in brute_force; all numbers are Decimals, and vectors have three
        components. `first_image_shift` is the shift at time 0 of the image above a sheared box.
        `company` is as in brute_force where particles differ, with lists of Decimals."""
        self.world = world
        self.time, self.x, self.v, self.w = time, list(x), list(v), list(w)
        self.last = [-NEVER] * len(x) if last is None else list(last)
        self.top = len(world.box) - 1  # the axis along which things fall
        self.box = tuple(_exact(side) for side in world.box) + (None,) * (2 - self.top)
        self.periods = [length for length in self.box if length is not None]
        self.r, self.beta, self.q = map(_exact, (world.r, world.beta, world.q))
        self.gravity, self.shear = Decimal(world.gravity), Decimal(world.shear)
        self.first_image_shift = first_image_shift
        self.floor, self.walls = (
            tuple(map(Decimal, wall)) if wall else None for wall in (world.floor, world.walls)
        )
        units = [Decimal(1)] * len(x)
        self.company = company or Bodies(units, units, [self.q] * len(x), [0] * len(x))
        self.sides = {side.name: exact_side(side) for side in world.sides}
        self.contact_time = Decimal(world.contact_time)
        self.stroke = math.floor(time / self.floor[1]) if self.floor else 0

    def copy(self):
        return Exact(
            self.world,
            self.time,
            self.x,
            self.v,
            self.w,
            self.last,
            self.first_image_shift,
            self.company,
        )

    def run(self, collisions):
        """Return the events up to and including the pair collision of this number."""
        events = []
        while collisions > 0:
            events.append(self.step())
            collisions -= events[-1].kind == "pair"
        return events

    def step(self):
        """Carry out the next event and return it."""
        while True:
            interval = self._safe_interval()
            wait, event = min(self._ahead(), key=lambda pair: pair[0])
            if wait <= interval:
                self.move(wait)
                self._resolve(event)
                return event
            self.move(interval)
            if self.floor and self.time >= self._stroke_end() * (1 - Decimal(10) ** (8 - DIGITS)):
                self.time = self._stroke_end()
                self.stroke += 1

    def follow(self, event):
        """Carry out the event, which is the next one on these paths, too."""
        self.move(self._wait(event))
        self._resolve(event)

    def _safe_interval(self):
        """Return an interval in which no pair moves by more than half a box, and the floor's stroke
        does not end."""
        interval = self._stroke_end() - self.time if self.floor else NEVER
        if self.periods:
            speeds = [dot(v, v).sqrt() for v in map(self._velocity_in_box, self.x, self.v)]
            fastest = 2 * max(speeds) + abs(self.shear)
            interval = min(interval, HALF * min(self.periods) / fastest)
        return interval

    def _stroke_end(self):
        return (self.stroke + 1) * self.floor[1]

    def _velocity_in_box(self, x, v):
        crossed = math.floor(x[1] / self.box[1]) if self.shear else 0
        return (v[0] - crossed * self.shear, v[1], v[2])

    def _ahead(self):
        """Yield (wait, event) of all possible next events."""
        number = len(self.x)
        for i, j in itertools.combinations(range(number), 2):
            for image in self._images(i, j):
                yield self._until_contact(i, j, image), Event("pair", i, j, image)
        kinds = ("floor",) * bool(self.floor) + ("left", "right") * bool(self.walls)
        kinds += tuple(self.sides)
        for kind, i in itertools.product(kinds, range(number)):
            event = Event(kind, i, stroke=self.stroke)
            yield self._wait(event), event

    def _images(self, i, j):
        """Yield the images of j that i may touch after half a box of relative motion."""
        d = minus(self.x[i], self.x[j])
        for up in self._numbers(d[1], 1):
            for along in self._numbers(d[0] + up * self.image_shift(), 0):
                for out in self._numbers(d[2], 2):
                    yield along, up, out

    def _numbers(self, distance, axis):
        length = self.box[axis]
        if length is None:
            return (0,)
        nearest = -round(distance / length)
        reach = 2 * max(self.company.radius) + HALF * min(self.periods)
        near = range(nearest - 1, nearest + 2)
        return [k for k in near if abs(distance + k * length) <= reach]

    def image_shift(self):
        """Return the shift of the image above."""
        return self.first_image_shift + self.shear * self.time

    def relative_motion(self, i, j, image):
        """Return position and velocity of i relative to an image of j."""
        x, v = minus(self.x[i], self.x[j]), minus(self.v[i], self.v[j])
        x = tuple(a + k * (length or 0) for a, k, length in zip(x, image, self.box, strict=True))
        up = image[1]
        return (x[0] + up * self.image_shift(), *x[1:]), (v[0] + up * self.shear, *v[1:])

    def _wait(self, event):
        """Return the time until an event on the present paths."""
        if event.kind == "pair":
            return self._until_contact(event.i, event.j, event.image)
        x, v, radius = self.x[event.i], self.v[event.i], self.company.radius[event.i]
        if event.kind == "floor":
            rise = self.floor[0] / self.floor[1]
            gap = x[self.top] - radius - rise * (self.time - event.stroke * self.floor[1])
            return fall(gap, v[self.top] - rise, self.gravity)
        if event.kind in self.sides:
            side = self.sides[event.kind]
            weight = side.inwards * self.gravity if side.axis == self.top else ZERO
            gap = side.inwards * (x[side.axis] - side.at) - radius
            return fall_or_drift(gap, side.inwards * v[side.axis], weight)
        gap, speed = x[0] - radius, -v[0]
        if event.kind == "right":
            gap, speed = self.walls[0] - radius - x[0], v[0]
        return max(gap, ZERO) / speed if speed > 0 else NEVER

    def _until_contact(self, i, j, image):
        """Return the first root of |x + v t| = a_i + a_j if they approach; 0 for overlapping
        particles."""
        x, v = self.relative_motion(i, j, image)
        b = dot(x, v)
        if b >= 0:
            return NEVER
        vv = dot(v, v)
        reach = self.company.radius[i] + self.company.radius[j]
        discriminant = b * b - vv * (dot(x, x) - reach**2)
        if discriminant < 0:
            return NEVER
        return max(ZERO, (-b - discriminant.sqrt()) / vv)

    def move(self, wait):
        """Move all particles in free flight."""
        drop = [ZERO] * 3
        drop[self.top] = self.gravity * wait
        fallen = times(drop, HALF * wait)
        paths = zip(self.x, self.v, strict=True)
        self.x = [minus(plus(x, times(v, wait)), fallen) for x, v in paths]
        self.v = [minus(v, drop) for v in self.v]
        self.time += wait

    def _resolve(self, event):
        if event.kind == "pair":
            self._collide(event.i, event.j, event.image)
        elif event.kind == "floor":
            rise = [ZERO] * 3
            rise[self.top] = self.floor[0] / self.floor[1]
            self._bounce(event.i, times(rise, 1 / rise[self.top]), rise, *self.floor[2:])
        elif event.kind in self.sides:
            self._meet_side(event.i, self.sides[event.kind])
        else:
            n = (Decimal(1 if event.kind == "left" else -1), ZERO, ZERO)
            self._bounce(event.i, n, (ZERO,) * 3, *self.walls[1:])

    def _meet_side(self, i, side):
        n, moving = [ZERO] * 3, [ZERO] * 3
        n[side.axis] = side.inwards
        moving[side.along] = Decimal(side.settings["velocity"])
        material = (Decimal(side.settings[name]) for name in ("restitution", "roughness"))
        self._bounce(i, n, moving, *material)

    def _collide(self, i, j, image):
        x, v = self.relative_motion(i, j, image)
        n = times(x, 1 / dot(x, x).sqrt())
        r, beta = self._material(i, j)
        r = self._restitution(r, abs(dot(v, n)), i, j)
        push, twist = self._impulse(n, v, plus(self.w[i], self.w[j]), r, beta, i, j)
        self._kick(i, times(push, Decimal(-1)), twist)
        self._kick(j, push, twist)

    def _material(self, i, j):
        if self.world.mixture is None:
            return self.r, self.beta
        common = {"restitution": self.world.r, "roughness": self.world.beta, "mu": None}
        species = self.company.species
        material = self.world.mixture.between(species[i], species[j], common)
        return Decimal(material["restitution"]), Decimal(material["roughness"])

    def _bounce(self, i, n, wall_velocity, r, beta):
        v = minus(self.v[i], wall_velocity)
        r = self._restitution(r, abs(dot(v, n)), i)
        push, twist = self._impulse(n, v, self.w[i], r, beta, i)
        self._kick(i, times(push, Decimal(-1)), twist)

    def _impulse(self, n, v, w, r, beta, *partners):
        """Return the exchanged momentum, and n times its tangential component. A wall, which is not
        among the partners, takes any momentum without moving."""
        mass, q = self.company.mass, self.company.q
        normal = times(n, dot(v, n))
        push = times(normal, (1 + r) / sum(1 / mass[k] for k in partners))
        if self.q is None:
            return push, (ZERO,) * 3
        slip = minus(minus(v, cross(w, n)), normal)
        ease = sum(1 / mass[k] + 1 / (mass[k] * q[k]) for k in partners)
        along = times(slip, (1 + beta) / ease)
        return plus(push, along), cross(n, along)

    def _kick(self, i, push, twist):
        mass = self.company.mass[i]
        self.v[i] = plus(self.v[i], times(push, 1 / mass))
        if self.q is not None:
            self.w[i] = plus(self.w[i], times(twist, 1 / (mass * self.company.q[i])))

    def _restitution(self, r, speed, *particles):
        """Return the restitution; contacts soon after the previous one lose nothing along the
        normal."""
        r = restitution(self.world, r, speed)
        previous = max(self.last[k] for k in particles)
        for k in particles:
            self.last[k] = self.time
        return Decimal(1) if self.time - previous < self.contact_time else r


def _exact(number):
    return None if number is None else Decimal(number)


def plus(a, b):
    return (a[0] + b[0], a[1] + b[1], a[2] + b[2])


def minus(a, b):
    return (a[0] - b[0], a[1] - b[1], a[2] - b[2])


def times(a, s):
    return (a[0] * s, a[1] * s, a[2] * s)


def dot(a, b):
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])
