"""Walls on single sides of the box, as one would write them first."""

import math
from typing import NamedTuple

import numpy as np

from brute_force.formulas import first_touch, in_space

AXES = {"left_wall": 0, "right_wall": 0, "front_wall": 1, "back_wall": 1}  # others: the last
LOW = ("left_wall", "front_wall", "bottom_wall")
ALIKE = {"velocity": 0.0, "amplitude": 0.0, "period": 1.0, "wave": "sawtooth", "shaken": "normal"}
ALIKE |= {"restitution": 1.0, "roughness": -1.0, "temperature": None}


STROKES = {
    "sawtooth": (lambda share: share, lambda share: 1.0),
    "reversed_sawtooth": (
        lambda share: np.minimum(share / 0.1, (1.0 - share) / 0.9),
        lambda share: 10.0 if share < 0.1 else -1.0 / 0.9,
    ),
    "triangle": (
        lambda share: 2.0 * np.minimum(share, 1.0 - share),
        lambda share: 2.0 if share < 0.5 else -2.0,
    ),
    "sine": (
        lambda share: 0.5 - 0.5 * np.cos(2.0 * math.pi * share),
        lambda share: math.pi * math.sin(2.0 * math.pi * share),
    ),
}
"""Height, in amplitudes, and slope, in amplitudes a period, at a share of the period."""


class Side(NamedTuple):
    """One wall."""

    name: str
    axis: int
    inwards: float  # 1 at the low end of the axis, -1 at the high one
    at: float
    along: int  # axis along which it moves
    settings: dict

    def shift(self, time):
        """How far a stroke has gone, of a wall that is shaken; of one time or an array of them."""
        height, _ = STROKES[self.settings["wave"]]
        return self.settings["amplitude"] * height(time / self.settings["period"] % 1.0)

    def speed(self, time):
        """How fast it goes."""
        _, slope = STROKES[self.settings["wave"]]
        fastest = self.settings["amplitude"] / self.settings["period"]
        return fastest * slope(time / self.settings["period"] % 1.0)

    @property
    def goes_in(self):
        """Whether it is shaken along its normal."""
        return self.settings["amplitude"] > 0.0 and self.settings["shaken"] == "normal"

    def velocity(self, time):
        """Of its surface, in space."""
        found = np.zeros(3)
        if self.goes_in:
            found[self.axis] = self.inwards * self.speed(time)
        elif self.settings["amplitude"] > 0.0:
            found[self.along] = self.speed(time)
        else:
            found[self.along] = self.settings["velocity"]
        return found

    def wait(self, gap, speed, weight, time, limit):
        """Time until a particle meets it; gap + speed t - weight t^2/2 from where it is farthest
        out."""
        if self.goes_in:
            return self._wait_for_stroke(gap, speed, weight, time, limit)
        if speed >= 0.0 and weight <= 0.0:
            return math.inf
        gap = max(0.0, gap)
        if weight == 0.0:
            return gap / -speed
        square = speed * speed + 2.0 * weight * gap
        return math.inf if square < 0.0 else (speed + math.sqrt(square)) / weight

    def _wait_for_stroke(self, gap, speed, weight, time, limit):
        if gap - self.shift(time) <= 1e-12 and speed < self.speed(time):
            return 0.0

        def apart(wait):
            return gap + speed * wait - weight * wait**2 / 2.0 - self.shift(time + wait)

        return first_touch(apart, limit)


def sides_of(effects, box):
    """The walls among the settings of effects; `box` has the lengths of its sides."""
    found = []
    for name in ("left_wall", "right_wall", "front_wall", "back_wall", "bottom_wall", "lid"):
        if name in effects:
            last = len(box) - 1
            axis = AXES.get(name, last)
            at, inwards = (0.0, 1.0) if name in LOW else (float(box[axis]), -1.0)
            along = last if axis == 0 else 0
            found.append(Side(name, axis, inwards, at, along, ALIKE | effects[name]))
    return tuple(found)


def gaussian(random):
    """Marsaglia's polar method; the second of the two numbers is thrown away."""
    while True:
        x, y = (2.0 * random.uniform() - 1.0 for _ in range(2))
        if 0.0 < x * x + y * y < 1.0:
            return x * math.sqrt(-2.0 * math.log(x * x + y * y) / (x * x + y * y))


def leave_thermal(side, random, dimension, mass, spin_mass):
    """Velocity (D,) and spin (3,) with which a particle leaves a thermal wall."""
    temperature = side.settings["temperature"]
    outwards = math.sqrt(-2.0 * temperature / mass * math.log(1.0 - random.uniform()))
    v = in_space([math.sqrt(temperature / mass) * gaussian(random) for _ in range(dimension)])
    v[side.axis] = side.inwards * outwards
    v[side.along] += side.settings["velocity"]
    w = np.zeros(3)
    if spin_mass is not None:
        for k in range(6 - 2 * dimension, 3):
            w[k] = math.sqrt(temperature / spin_mass) * gaussian(random)
    return v[:dimension], w
