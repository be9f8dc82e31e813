"""Event-driven simulation as one would write it first: everything is predicted after each event.

Written from the paper's text and equations, not from the kernel: all particles are kept at the same
time, every pair is tried over all periodic images within reach, nothing is remembered from one
event to the next. Absolute times, textbook roots. Units: a = m = T = 1.
"""

import itertools
import math
from typing import NamedTuple

import numpy as np

from brute_force.kicks import Drive, Kicks


class World(NamedTuple):
    """What is simulated; None and 0 stand for what is absent."""

    box: tuple[float | None, ...]  # periods; None is open, or closed by walls
    r: float
    beta: float
    q: float | None  # None: particles do not spin
    mu: float | None = None  # coefficient of friction; None: contacts never slide
    thermostat: tuple[float, float, float] | None = None  # power, share of spin, interval
    gravity: float = 0.0  # along the last axis
    floor: tuple[float, float, float, float] | None = None  # amplitude, period, r, beta
    walls: tuple[float, float, float] | None = None  # width, r, beta; along the first axis
    shear: float = 0.0  # U: velocity, along the first axis, of the image above along the second
    contact_time: float = 0.0


class Snapshot(NamedTuple):
    """All particles at one instant."""

    time: float  # absolute
    position: np.ndarray  # (N, D), in any image
    velocity: np.ndarray
    spin: np.ndarray | None  # (N, 2D - 3)
    drive: Drive | None = None


class Event(NamedTuple):
    time: float
    kind: str  # pair, floor, left, right, kick
    i: int
    j: int  # -1: none


class BruteForce:
    """A simulation under way; `step` carries out one event, `run` so many pair collisions."""

    def __init__(self, world, position, velocity, spin, time=0.0, last_contact=None, drive=None):
        self.world = world
        self.x, self.v = np.array(position, float), np.array(velocity, float)
        self.number, self.dimension = self.x.shape
        self.w = np.zeros((self.number, 3))  # a times the angular velocity, always in space
        if spin is not None:
            self.w[:, 3 - np.shape(spin)[1] :] = spin
        self.time = float(time)
        # the floor's stroke that is under way; at its very end the next one
        self.stroke = math.floor(time / world.floor[1]) if world.floor else 0
        self.last = np.full(self.number, -np.inf) if last_contact is None else last_contact.copy()
        self.pairs = np.array(list(itertools.combinations(range(self.number), 2))).reshape(-1, 2)
        drawn = drive and world.thermostat
        self.kicks = Kicks(drawn, world.q, self.dimension, drive) if drawn else None
        self._fold()

    def run(self, collisions):
        """The events up to and with the so-manieth pair collision."""
        events = []
        while collisions > 0:
            events.append(self.step())
            collisions -= events[-1].kind == "pair"
        return events

    def run_until(self, end):
        """The events up to the absolute time `end`, at which everything is left."""
        events = []
        while (event := self.step(end)) is not None:
            events.append(event)
        return events

    def snapshot(self):
        spin = self.w[:, 6 - 2 * self.dimension :]
        return Snapshot(self.time, self.x.copy(), self.v.copy(), spin.copy())

    def step(self, end=math.inf):
        """Carry out the next event and return it, or stop at `end` and return None."""
        while True:
            limit = self._longest_look()
            wait, kind, i, j = min(self._candidates(limit), default=(math.inf, "", 0, 0))
            if min(wait, limit) > end - self.time:
                self._move(end - self.time)
                return None
            if wait <= limit:
                self._move(wait)
                self._resolve(kind, i, j)
                return Event(self.time, kind, i, j)
            self._move(limit)
            if self.world.floor and self.time >= self._stroke_end() - 1e-12:
                self.time = self._stroke_end()
                self.stroke += 1

    # ------------------------------------------------------------------ what comes next

    def _longest_look(self):
        """No pair moves by more than half a box within it, and the floor's stroke does not end."""
        periods = [length for length in self.world.box if length is not None]
        fastest = 2.0 * np.sqrt((self.v**2).sum(axis=1).max()) + abs(self.world.shear) + 1e-12
        limit = 0.5 * min(periods) / fastest if periods else math.inf
        return min(limit, self._stroke_end() - self.time) if self.world.floor else limit

    def _stroke_end(self):
        return (self.stroke + 1) * self.world.floor[1]

    def _candidates(self, limit):
        """(wait, kind, i, j) of the earliest pair and of what each particle does at boundaries."""
        found = list(self._boundary_events())
        if len(self.pairs):
            waits = self._pair_waits()
            first = int(np.argmin(waits))
            found.append((waits[first], "pair", *map(int, self.pairs[first])))
        if self.kicks:
            found.append(self.kicks.next(self.time))
        return [event for event in found if event[0] <= limit]

    def _pair_waits(self):
        """Time until each pair touches, over all images that half a box of motion can reach."""
        i, j = self.pairs.T
        x, v = self.x[i] - self.x[j], self.v[i] - self.v[j]
        best = np.full(len(x), np.inf)
        for shift, drift in self.images():
            best = np.minimum(best, _waits(x + shift, v + drift))
        return best

    def images(self):
        """(shift, velocity) of every image of a particle that another could reach."""
        world = self.world
        reach = 3 if world.shear else 1
        ranges = [range(0, 1) if side is None else range(-1, 2) for side in world.box]
        if world.box[0] is not None:
            ranges[0] = range(-reach, reach + 1)
        lengths = np.array([side or 0.0 for side in world.box])
        offset = (world.shear * self.time) % world.box[0] if world.shear else 0.0
        for numbers in itertools.product(*ranges):
            shift, drift = lengths * numbers, np.zeros(self.dimension)
            shift[0] += numbers[1] * offset
            drift[0] += numbers[1] * world.shear
            yield shift, drift

    def _boundary_events(self):
        world = self.world
        for i in range(self.number):
            if world.floor:
                speed = world.floor[0] / world.floor[1]
                gap = self.x[i, -1] - 1.0 - speed * (self.time - self.stroke * world.floor[1])
                yield _fall(gap, self.v[i, -1] - speed, world.gravity), "floor", i, -1
            if world.walls:
                x, v = self.x[i, 0], self.v[i, 0]
                if v < 0.0:
                    yield max(0.0, (1.0 - x) / v), "left", i, -1
                if v > 0.0:
                    yield max(0.0, (world.walls[0] - 1.0 - x) / v), "right", i, -1

    # ------------------------------------------------------------------ what happens

    def _move(self, wait):
        self.x += self.v * wait
        self.x[:, -1] -= 0.5 * self.world.gravity * wait * wait
        self.v[:, -1] -= self.world.gravity * wait
        self.time += wait
        self._fold()

    def _fold(self):
        """Particles that have left a periodic box enter it on the other side."""
        world = self.world
        offset = world.shear * self.time
        for axis in reversed(range(self.dimension)):
            length = world.box[axis]
            if length is None:
                continue
            number = np.floor(self.x[:, axis] / length)
            self.x[:, axis] -= number * length
            if axis == 1 and world.shear:
                self.x[:, 0] -= number * offset
                self.v[:, 0] -= number * world.shear

    def _resolve(self, kind, i, j):
        world = self.world
        if kind == "kick":
            self.kicks.give(i, self.v, self.w)
        elif kind == "pair":
            self._collide(i, j)
        elif kind == "floor":
            amplitude, period, r, beta = world.floor
            self._bounce(i, self.dimension - 1, 1.0, amplitude / period, r, beta)
        else:
            self._bounce(i, 0, 1.0 if kind == "left" else -1.0, 0.0, *world.walls[1:])

    def _restitution(self, r, *particles):
        recent = max(self.last[k] for k in particles)
        quick = self.world.contact_time > 0.0 and self.time - recent < self.world.contact_time
        for k in particles:
            self.last[k] = self.time
        return 1.0 if quick else r

    def _collide(self, i, j):
        """Eq. (collrule) of the paper, term by term."""
        world = self.world
        x, v = self.x[i] - self.x[j], self.v[i] - self.v[j]
        shift, drift = min(self.images(), key=lambda image: ((x + image[0]) ** 2).sum())
        n, v = _in_space(x + shift), _in_space(v + drift)
        n /= math.sqrt(n @ n)
        r = self._restitution(world.r, i, j)
        v_n = (v @ n) * n
        push = 0.5 * (1.0 + r) * v_n
        if world.q is not None:
            q, beta = world.q, world.beta
            v_t, v_r = v - v_n, -np.cross(self.w[i] + self.w[j], n)
            along = self._rubbed(push, q * (1.0 + beta) / (2.0 * q + 2.0) * (v_t + v_r))
            push = push + along
            turn = np.cross(n, along) / q
            self.w[i] += turn
            self.w[j] += turn
        self.v[i] -= push[: self.dimension]
        self.v[j] += push[: self.dimension]

    def _bounce(self, i, axis, direction, wall_speed, r, beta):
        """As with a partner of infinite mass: both prefactors of Eq. (collrule) double."""
        n = np.zeros(3)
        n[axis] = direction
        g = _in_space(self.v[i])
        g[axis] -= wall_speed
        g -= np.cross(self.w[i], n)
        r = self._restitution(r, i)
        g_n = (g @ n) * n
        push = (1.0 + r) * g_n
        if self.world.q is not None:
            q = self.world.q
            along = self._rubbed(push, q * (1.0 + beta) / (1.0 + q) * (g - g_n))
            push = push + along
            self.w[i] += np.cross(n, along) / q
        self.v[i] -= push[: self.dimension]

    def _rubbed(self, push, along):
        """The tangential impulse that would stick, cut where Coulomb's friction gives no more."""
        if self.world.mu is None:
            return along
        most, size = self.world.mu * math.sqrt(push @ push), math.sqrt(along @ along)
        return along * (most / size) if size > most else along


def _in_space(vector):
    full = np.zeros(3)
    full[: len(vector)] = vector
    return full


def _waits(x, v):
    """First root of |x + v t| = 2 for each row, if the pair approaches; overlapping is now."""
    b, vv, c = (x * v).sum(axis=1), (v * v).sum(axis=1), (x * x).sum(axis=1) - 4.0
    discriminant = b * b - vv * c
    with np.errstate(invalid="ignore", divide="ignore"):
        root = np.maximum(0.0, (-b - np.sqrt(discriminant)) / vv)
    return np.where((b < 0.0) & (discriminant >= 0.0), root, np.inf)


def _fall(gap, speed, gravity):
    """First time at which gap + speed t - gravity t^2/2 vanishes, from above."""
    if gap <= 1e-12 and speed < 0.0:
        return 0.0
    return (speed + math.sqrt(speed * speed + 2.0 * gravity * max(gap, 0.0))) / gravity
