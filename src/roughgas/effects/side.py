"""Walls on single sides of the box, each with a material and a motion of its own.

A wall closes its side of the box. It is at rest, or moves along itself, at constant velocity or
shaken; or it is shaken along its normal (piston.py); or it is thermal (thermal_wall.py). What each
is follows from its parameters: `SideWall.from_settings` makes it.
"""

import math
from typing import NamedTuple

from roughgas.base import InputError, NeedsError
from roughgas.effects import piston, thermal_wall
from roughgas.effects.floor import WAVES
from roughgas.effects.plane import Place, bounce, normal_axis, predict
from roughgas.effects.settings import (
    LENGTH,
    MATERIAL,
    TEMPERATURE,
    TIME,
    Number,
    Word,
    check_speed,
    register,
)
from roughgas.effects.triangular_floor import REVERSED_RISE
from roughgas.kernel.jit import jit
from roughgas.kernel.mathematics import TURN, sine_and_cosine

SIDES = {  # name -> (axis, the end of it: 0 or 1); -1 is the last axis
    "left_wall": (0, 0),
    "right_wall": (0, 1),
    "front_wall": (1, 0),
    "back_wall": (1, 1),
    "bottom_wall": (-1, 0),
    "lid": (-1, 1),
}
NORMAL, ALONG = "normal", "along"
RISES = {"sawtooth": 1.0, "reversed_sawtooth": REVERSED_RISE, "triangle": 0.5, "sine": 0.0}
SETTINGS = {
    "restitution": MATERIAL["restitution"]._replace(default=1.0),
    "roughness": MATERIAL["roughness"]._replace(default=-1.0),
    "velocity": Number(
        "Constant velocity along itself, in a/T: along the first axis, of a left or right wall "
        "along the last one.",
        "[-1e+06, 1e+06]",
        default=0.0,
    ),
    "amplitude": Number("Height of a stroke of a shaken wall, in a.", LENGTH, 0.0),
    "period": Number("Time between strokes, in T; given for a shaken wall.", TIME, math.inf),
    "wave": Word("Form of its motion, as of floors.", WAVES),
    "shaken": Word("Whether it is shaken along its normal or along itself.", (NORMAL, ALONG)),
    "temperature": Number(
        "Temperature of a thermal wall, in m a^2/T^2: particles leave it with Maxwellian "
        "velocities and spins, whatever its material.",
        TEMPERATURE,
        default=math.inf,
    ),
}


class SideWall(NamedTuple):
    """A wall on one side of the box: at rest, sliding, shaken or thermal."""

    place: Place
    restitution: float
    roughness: float

    axis = normal_axis

    @classmethod
    def from_settings(cls, settings, around):
        """Return the wall that the settings describe; raise InputError where they contradict."""
        place = _place(around)
        _refuse_contradictions(settings, around)
        material = settings["restitution"], settings["roughness"]
        if settings["temperature"] < math.inf:
            return thermal_wall.make(place, settings, around)
        amplitude, period = settings["amplitude"], settings["period"]
        if amplitude > 0.0 and settings["shaken"] == NORMAL:
            return piston.make(place, settings, around)
        if amplitude > 0.0:
            return MovingWall(place, *material, 0.0, amplitude, period, RISES[settings["wave"]])
        if settings["velocity"] != 0.0:
            return MovingWall(place, *material, settings["velocity"], 0.0, 1.0, 1.0)
        return cls(place, *material)


class MovingWall(NamedTuple):
    """A wall that moves along itself: at a velocity that is constant, in turns, or a sine."""

    place: Place
    restitution: float
    roughness: float
    velocity: float  # constant, and
    amplitude: float  # of what is added, in a
    period: float  # T
    rise: float  # share of the period in which it goes forwards; 0 stands for a sine

    axis = normal_axis


def _place(around):
    """Return the plane of a wall; raise InputError where the box has no such side."""
    key, (axis, end) = f"effects.{around.name}", SIDES[around.name]
    dimension = len(around.box)
    if axis == 1 and dimension == 2:
        raise InputError(key, "in the plane", "be bottom_wall or lid there")
    axis %= dimension
    if around.box[axis] is None:
        raise NeedsError(key, f"a length of the box along its {'last' if axis else 'first'} axis")
    if around.name == "bottom_wall" and "gravity" in around.effects:
        raise InputError(key, "with gravity", "be a floor there, which may be at rest")
    along = dimension - 1 if axis == 0 else 0
    return Place(axis, 1.0 - 2.0 * end, around.box[axis] * end, along)


def _refuse_contradictions(settings, around):
    key, given = f"effects.{around.name}", around.effects[around.name]
    shaken = settings["amplitude"] > 0.0
    if shaken and settings["period"] == math.inf:
        raise InputError(f"{key}.period", "(nothing)", "be given where the wall is shaken")
    check_speed(around, settings["amplitude"], settings["period"])
    if shaken and settings["velocity"] != 0.0:
        raise InputError(f"{key}.velocity", settings["velocity"], "be 0 where the wall is shaken")
    if settings["temperature"] < math.inf:
        for name in ("restitution", "roughness", "amplitude"):
            if name in given:
                legal = "not be given where the wall has a temperature"
                raise InputError(f"{key}.{name}", given[name], legal)


# ---------------------------------------------------------------------- part in the kernel


@jit
def resolve(wall, index, what, state, scene, i, time):
    return bounce(wall, index, state, scene, i, time, 0, 0.0, 0.0)


@jit
def phase(wall, index, base):
    """Return the time from the beginning of a period to the clock's base."""
    return base % wall.period


@jit
def resolve_moving(wall, index, what, state, scene, i, time):
    velocity = wall.velocity + _speed(wall, state.phase[index] + time)
    return bounce(wall, index, state, scene, i, time, wall.place.along, velocity, 0.0)


@jit
def _speed(wall, time):
    """Return the velocity that shaking adds, at a time since some period began."""
    if wall.rise == 0.0:
        return 0.5 * TURN * wall.amplitude / wall.period * sine_and_cosine(time / wall.period)[0]
    done = time / wall.period
    if done - math.floor(done) <= wall.rise:
        return wall.amplitude / (wall.rise * wall.period)
    return -wall.amplitude / ((1.0 - wall.rise) * wall.period)


register(SideWall, SETTINGS, predict=predict, resolve=resolve, closes=True)
register(MovingWall, predict=predict, resolve=resolve_moving, phase=phase, drives=True, closes=True)
