"""The simplest event-driven simulation: all events are predicted anew after each event.

Written from the paper's text and equations, not from the kernel: all particles stay at the same
time, each pair is tried over all periodic images within reach, and no prediction outlives an event.
Absolute times, textbook roots. Units: a = m = T = 1.
"""

import itertools
import math
from collections import defaultdict

import numpy as np

from brute_force.bodies import identical_bodies
from brute_force.contacts import Contacts
from brute_force.formulas import (
    falling_time,
    first_touch,
    in_three_dimensions,
    meeting_times,
)
from brute_force.kicks import Bath, Kicks, SplitMix
from brute_force.sides import resting_wait, thermal_velocity_and_spin
from brute_force.world import Event, Snapshot

# Strokes of a period of the floor: (begin, end) in periods, (height at the begin, at the end) in
# amplitudes; a period of the sine is a single stroke
FLOOR_STROKES = {
    "sawtooth": [(0.0, 1.0, 0.0, 1.0)],
    "reversed_sawtooth": [(0.0, 0.1, 0.0, 1.0), (0.1, 1.0, 1.0, 0.0)],
    "triangle": [(0.0, 0.5, 0.0, 1.0), (0.5, 1.0, 1.0, 0.0)],
    "sine": [(0.0, 1.0, 0.0, 0.0)],
}


class BruteForce(Contacts):
    """A simulation: `step` carries out an event, `run` a number of pair collisions."""

    def __init__(
        self, world, x, v, spin, time=0.0, last_contact=None, drive=None, bodies=None, word=0
    ):
        self.world = world
        self.x, self.v = np.array(x, float), np.array(v, float)
        self.number, self.dimension = self.x.shape
        self.w = np.zeros((self.number, 3))  # a times the angular velocity, always in space
        if spin is not None:
            self.w[:, 3 - np.shape(spin)[1] :] = spin
        self.time = float(time)
        # index of the floor's present stroke; at its very end, of the next one
        self.strokes = FLOOR_STROKES[world.wave]
        periods, share = divmod(time / world.floor[1] if world.floor else 0.0, 1.0)
        strokes_begun = sum(share >= begin for begin, *_ in self.strokes)
        self.stroke = int(periods) * len(self.strokes) + strokes_begun - 1
        self.last_contacts = (
            np.full(self.number, -np.inf) if last_contact is None else last_contact.copy()
        )
        self.pairs = np.transpose(np.triu_indices(self.number, 1))
        self.image_steps = self._image_steps()
        bodies = bodies or identical_bodies(self.number, world.q)
        self.radius, self.mass, self.q, self.species = bodies
        drive_class, drive_settings = (
            (Bath, world.bath) if world.bath else (Kicks, world.thermostat)
        )
        drive_settings = drive and drive_settings
        self.kicks = (
            drive_class(drive_settings, world.q, self.dimension, drive, bodies)
            if drive_settings
            else None
        )
        self.random = self.kicks.random if drive_settings else SplitMix(word)
        self.contact_sums = np.zeros(3)  # of v_t^2, v_r^2 and v_t.v_r, over contacts of pairs
        self.carried_momentum = np.zeros((3, 3))  # momentum times distance, by component and axis
        self.carried_energy = np.zeros(3)  # energy times distance
        # momentum (3), and angular momentum of spins (3), lost to the walls of each kind of event
        self.lost_to_walls = defaultdict(lambda: np.zeros(6))
        self._fold()

    def run(self, collisions):
        """Run to the given number of pair collisions; return all events."""
        events = []
        while collisions > 0:
            events.append(self.step())
            collisions -= events[-1].kind == "pair"
        return events

    def run_until(self, end):
        """Run to the absolute time `end`; return all events."""
        events = []
        while (event := self.step(end)) is not None:
            events.append(event)
        return events

    def snapshot(self):
        """The present Snapshot."""
        spin = self.w[:, 6 - 2 * self.dimension :]
        return Snapshot(self.time, self.x.copy(), self.v.copy(), spin.copy())

    def step(self, end=math.inf):
        """Carry out the next event and return it, or stop at `end` and return None."""
        while True:
            limit = self._search_limit()
            wait, kind, i, j = min(self._candidates(limit), default=(math.inf, "", 0, 0))
            if min(wait, limit) > end - self.time:
                self._move(end - self.time)
                return None
            if wait <= limit:
                self._move(wait)
                self._resolve(kind, i, j)
                return Event(self.time, kind, i, j)
            self._move(limit)
            if self.world.floor and self.time >= self._stroke()[1] - 1e-12:
                self.time = self._stroke()[1]
                self.stroke += 1

    def _search_limit(self):
        """A time within which no pair moves by half a box and no stroke of the floor ends."""
        periods = [length for length in self.world.box if length is not None]
        fastest = 2.0 * np.sqrt((self.v**2).sum(axis=1).max()) + abs(self.world.shear) + 1e-12
        limit = 0.5 * min(periods) / fastest if periods else math.inf
        limit = min([limit, *(side.settings["period"] / 2 for side in self.world.sides)])
        return min(limit, self._stroke()[1] - self.time) if self.world.floor else limit

    def _stroke(self):
        """(begin, end, height at the begin, speed) of the floor's present stroke."""
        amplitude, period = self.world.floor[:2]
        periods, k = divmod(self.stroke, len(self.strokes))
        begin, end, low, high = self.strokes[k]
        speed = amplitude * (high - low) / ((end - begin) * period)
        return (periods + begin) * period, (periods + end) * period, amplitude * low, speed

    def surface(self, wait):
        """(height, speed) of the floor after a time, within the present stroke."""
        amplitude, period = self.world.floor[:2]
        if self.world.wave == "sine":
            angle = 2.0 * np.pi * (self.time + wait) / period
            speed = amplitude * np.pi / period * np.sin(angle)
            return amplitude * (1.0 - np.cos(angle)) / 2.0, speed
        begin, _, low, speed = self._stroke()
        return low + speed * (self.time + wait - begin), speed

    def _candidates(self, limit):
        """(wait, kind, i, j) of the earliest pair, the next kick and all boundary events."""
        events = list(self._boundary_events(limit))
        if len(self.pairs):
            waits = self._pair_waits()
            first = int(np.argmin(waits))
            events.append((waits[first], "pair", *map(int, self.pairs[first])))
        if self.kicks:
            events.append(self.kicks.next_event(self.time))
        return [event for event in events if event[0] <= limit]

    def _pair_waits(self):
        """Time until each pair touches, over all images within reach of half a box of motion."""
        i, j = self.pairs.T
        x, v = self.x[i] - self.x[j], self.v[i] - self.v[j]
        shifts, drifts = self.images()
        contact_distances = self.radius[i] + self.radius[j]
        return meeting_times(x + shifts[:, None], v + drifts[:, None], contact_distances).min(
            axis=0
        )

    def _image_steps(self):
        """Displacements, in boxes, of all images within reach of another particle."""
        ranges = [range(0, 1) if side is None else range(-1, 2) for side in self.world.box]
        if self.world.shear:
            ranges[0] = range(-3, 4)
        return np.array(list(itertools.product(*ranges)))

    def images(self):
        """(displacements, velocities) of these images, (images, D)."""
        world = self.world
        shifts, drifts = (
            self.image_steps * [side or 0.0 for side in world.box],
            0.0 * self.image_steps,
        )
        if world.shear:
            shifts[:, 0] += self.image_steps[:, 1] * (
                (world.shear * self.time + world.slide) % world.box[0]
            )
            drifts[:, 0] = self.image_steps[:, 1] * world.shear
        return shifts, drifts

    def _boundary_events(self, limit):
        """Yield (wait, kind, i, -1) of the hits of floor and walls by each particle."""
        world = self.world
        floor = self.surface(0.0) if world.floor else None
        for i in range(self.number):
            if world.floor:
                yield self._floor_wait(i, limit, *floor), "floor", i, -1
            if world.walls:
                x, v, radius = self.x[i, 0], self.v[i, 0], self.radius[i]
                weight = -world.fall(1.0)[0]
                yield resting_wait(x - radius, v, weight), "left", i, -1
                yield resting_wait(world.walls[0] - radius - x, -v, -weight), "right", i, -1
            for side in world.sides:
                yield self._side_wait(side, i, limit), side.name, i, -1

    def _side_wait(self, side, i, limit):
        """Time until particle i meets a wall."""
        gap = side.inwards * (self.x[i, side.axis] - side.at) - self.radius[i]
        speed = side.inwards * self.v[i, side.axis]
        weight = -side.inwards * self.world.fall(1.0)[side.axis]
        return side.wait(gap, speed, weight, self.time, limit)

    def _floor_wait(self, i, limit, level, speed):
        """Time until particle i meets the floor; of a sine, inf beyond the limit."""
        height, v, g = self.x[i, -1] - self.radius[i], self.v[i, -1], self.world.gravity
        if self.world.wave != "sine" or (height - level <= 1e-12 and v < speed):
            return falling_time(height - level, v - speed, g)

        def height_at(wait):
            return height + v * wait - g * wait**2 / 2.0

        if min(height, height_at(limit)) > self.world.floor[0]:  # above all strokes
            return math.inf
        return first_touch(lambda wait: height_at(wait) - self.surface(wait)[0], limit)

    def _move(self, wait):
        """Move all particles in free flight."""
        self.x += self.v * wait + 0.5 * self.world.fall(wait) * wait
        self.v += self.world.fall(wait)
        self.time += wait
        self._fold()

    def _fold(self):
        """Fold positions into the periodic box."""
        world = self.world
        offset = world.shear * self.time + world.slide
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
        """Carry out an event."""
        if kind == "kick":
            self.kicks.apply(i, self.x, self.v, self.w)
        elif kind == "pair":
            self._collide(i, j)
        else:
            before = self._momenta(i)
            self._meet_wall(kind, i)
            self.lost_to_walls[kind] += before - self._momenta(i)

    def _momenta(self, i):
        """Momentum (3) of particle i, and angular momentum (3) of its spin."""
        moment = self.mass[i] * self.q[i] * self.radius[i]  # over a: w is a times the spin
        return np.concatenate([self.mass[i] * in_three_dimensions(self.v[i]), moment * self.w[i]])

    def _meet_wall(self, kind, i):
        """Carry out the contact of particle i with the wall of this kind of event."""
        world = self.world
        if kind == "floor":
            floor_velocity = self._along_last(self.surface(0.0)[1])
            self._bounce(i, self.dimension - 1, 1.0, floor_velocity, *world.floor[2:])
        elif kind in ("left", "right"):
            wall_velocity = self._along_last(self._shaking())
            self._bounce(i, 0, 1.0 if kind == "left" else -1.0, wall_velocity, *world.walls[1:])
        else:
            self._meet_side(i, next(side for side in world.sides if side.name == kind))

    def _meet_side(self, i, side):
        """Carry out the contact of particle i with a wall on a side of the box."""
        if side.settings["temperature"] is None:
            material = side.settings["restitution"], side.settings["roughness"]
            self._bounce(i, side.axis, side.inwards, side.velocity(self.time), *material)
            return
        mass = self.mass[i]
        spin_mass = None if self.world.q is None else mass * self.q[i]
        velocity_and_spin = thermal_velocity_and_spin(
            side, self.random, self.dimension, mass, spin_mass
        )
        self.v[i], self.w[i] = velocity_and_spin
        self.last_contacts[i] = self.time

    def _along_last(self, speed):
        """A vector (3,) along the last axis."""
        vector = np.zeros(3)
        vector[self.dimension - 1] = speed
        return vector

    def _shaking(self):
        """Velocity of the shaken side walls, along the last axis."""
        if self.world.shaken is None:
            return 0.0
        amplitude, period = self.world.shaken
        return 2.0 * np.pi * amplitude / period * np.cos(2.0 * np.pi * self.time / period)
