"""Walls on single sides of the box, in their plainest form."""

import math
from typing import NamedTuple

import numpy as np

from brute_force.formulas import first_touch, in_three_dimensions

AXES = {
    "left_wall": 0,
    "right_wall": 0,
    "front_wall": 1,
    "back_wall": 1,
}  # of other walls: the last
LOW_WALLS = ("left_wall", "front_wall", "bottom_wall", "thermal_floor")
SIDES = (
    "left_wall",
    "right_wall",
    "front_wall",
    "back_wall",
    "bottom_wall",
    "lid",
    "thermal_floor",
)
DEFAULTS = {
    "velocity": 0.0,
    "amplitude": 0.0,
    "period": 1.0,
    "wave": "sawtooth",
    "shaken": "normal",
}
DEFAULTS |= {"restitution": 1.0, "roughness": -1.0, "temperature": None}


STROKE_SHAPES = {
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
"""(height in amplitudes, slope in amplitudes per period), functions of the share of the period."""


class Side(NamedTuple):
    """A wall on one side of the box."""

    name: str
    axis: int
    inwards: float  # 1 at the low end of the axis, -1 at the high one
    at: float
    along: int  # axis along which it moves
    settings: dict

    def shift(self, time):
        """Displacement of a shaken wall at a time, or at an array of times."""
        height, _ = STROKE_SHAPES[self.settings["wave"]]
        return self.settings["amplitude"] * height(time / self.settings["period"] % 1.0)

    def speed(self, time):
        """Speed of a shaken wall at a time."""
        _, slope = STROKE_SHAPES[self.settings["wave"]]
        fastest = self.settings["amplitude"] / self.settings["period"]
        return fastest * slope(time / self.settings["period"] % 1.0)

    @property
    def moves_along_normal(self):
        """Whether the wall is shaken along its normal."""
        return self.settings["amplitude"] > 0.0 and self.settings["shaken"] == "normal"

    def velocity(self, time):
        """Velocity of the wall's surface, (3,)."""
        velocity = np.zeros(3)
        if self.moves_along_normal:
            velocity[self.axis] = self.inwards * self.speed(time)
        elif self.settings["amplitude"] > 0.0:
            velocity[self.along] = self.speed(time)
        else:
            velocity[self.along] = self.settings["velocity"]
        return velocity

    def wait(self, gap, speed, weight, time, limit):
        """Time until a particle meets the wall; inf if never, or beyond the limit on strokes.

        The distance from the wall's outermost position is gap + speed t - weight t^2/2.
        """
        if self.moves_along_normal:
            return self._wait_for_stroke(gap, speed, weight, time, limit)
        return resting_wait(gap, speed, weight)

    def _wait_for_stroke(self, gap, speed, weight, time, limit):
        if gap - self.shift(time) <= 1e-12 and speed < self.speed(time):
            return 0.0

        def distance(wait):
            return gap + speed * wait - weight * wait**2 / 2.0 - self.shift(time + wait)

        return first_touch(distance, limit)


def resting_wait(gap, speed, weight):
    """Time until a particle meets a wall that does not move along its normal; inf if never."""
    if speed >= 0.0 and weight <= 0.0:
        return math.inf
    gap = max(0.0, gap)
    if weight == 0.0:
        return gap / -speed
    square = speed * speed + 2.0 * weight * gap
    return math.inf if square < 0.0 else (speed + math.sqrt(square)) / weight


def sides_of(effects, box):
    """The walls in the settings of effects, as Sides; `box` has the lengths of its sides."""
    sides = []
    for name in SIDES:
        if name in effects:
            last = len(box) - 1
            axis = AXES.get(name, last)
            at, inwards = (0.0, 1.0) if name in LOW_WALLS else (float(box[axis]), -1.0)
            along = last if axis == 0 else 0
            sides.append(Side(name, axis, inwards, at, along, DEFAULTS | effects[name]))
    return tuple(sides)


def gaussian(random):
    """A Gaussian random number, by Marsaglia's polar method; its second number is thrown away."""
    while True:
        x, y = (2.0 * random.uniform() - 1.0 for _ in range(2))
        if 0.0 < x * x + y * y < 1.0:
            return x * math.sqrt(-2.0 * math.log(x * x + y * y) / (x * x + y * y))


def thermal_velocity_and_spin(side, random, dimension, mass, spin_mass):
    """Velocity (D,) and spin (3,) of a particle that leaves a thermal wall."""
    temperature = side.settings["temperature"]
    normal_speed = math.sqrt(-2.0 * temperature / mass * math.log(1.0 - random.uniform()))
    velocity = in_three_dimensions(
        [math.sqrt(temperature / mass) * gaussian(random) for _ in range(dimension)]
    )
    velocity[side.axis] = side.inwards * normal_speed
    velocity[side.along] += side.settings["velocity"]
    spin = np.zeros(3)
    if spin_mass is not None:
        for axis in range(6 - 2 * dimension, 3):
            spin[axis] = math.sqrt(temperature / spin_mass) * gaussian(random)
    return velocity[:dimension], spin
