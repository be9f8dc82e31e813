"""Walls: two equal ones that close the first axis, or one on a single side of the box.

The two are at rest, or shaken along the last axis as a sine, both alike, so that they drive what
their roughness grips. The surface of such a wall stays where it is: only the velocity that
particles meet there changes.

A single wall has a material and a motion of its own. It is at rest, or moves along itself, at
constant velocity or shaken; or it is a piston or thermal (planes.py). What each is follows from its
parameters: `SideWall.from_settings` makes it.
"""

import math
from typing import NamedTuple

from roughgas.base import InputError, NeedsError
from roughgas.effects.motions import (
    WAVES,
    Sawtooth,
    Sine,
    Triangle,
    law_of,
    motion_of,
    since_period_began,
)
from roughgas.effects.planes import (
    Piston,
    Place,
    ThermalWall,
    bounce_off_plane,
    normal_axis,
    predict_plane,
)
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
from roughgas.kernel.contact import collide_with_wall
from roughgas.kernel.jit import jit
from roughgas.kernel.mathematics import TURN, sine_and_cosine
from roughgas.kernel.particles import position_and_velocity, radius_of
from roughgas.kernel.vectors import along_first, along_last

LEFT, RIGHT = 0, 1


class Walls(NamedTuple):
    """Side walls at rest that close the first axis."""

    width: float  # they are at 0 and at this place, in a
    restitution: float
    roughness: float

    @classmethod
    def from_settings(cls, settings, around):
        """Return the effect, as wide as the box."""
        return cls(around.box[0], **settings)


@jit
def predict_walls(walls, index, state, scene, i):
    time = state.trajectory[i, 2 * len(scene.box)]
    position, velocity = position_and_velocity(state, scene, i, time)
    speed, radius = velocity[0], radius_of(state.bodies, i)
    if speed < 0.0:
        return time + max(0.0, (position[0] - radius) / -speed), LEFT
    if speed > 0.0:
        return time + max(0.0, (walls.width - radius - position[0]) / speed), RIGHT
    return math.inf, LEFT


@jit
def resolve_walls(walls, index, what, state, scene, i, time):
    normal = along_first(scene.box, 1.0 if what == LEFT else -1.0)
    material = (walls.restitution, walls.roughness)
    at_rest = along_first(scene.box, 0.0)
    return collide_with_wall(state, scene, index, i, time, material, normal, at_rest, 0.0)


register(Walls, MATERIAL, predict=predict_walls, resolve=resolve_walls, closes=True)


SHAKEN_SETTINGS = {
    "amplitude": Number(
        "Largest displacement from the middle, in a: half a stroke (A of a sine).", LENGTH
    ),
    "period": Number("Period of the motion, in T.", TIME),
    **MATERIAL,
}


class ShakenWalls(NamedTuple):
    """Side walls that close the first axis, and are shaken along the last one as a sine."""

    width: float  # they are at 0 and at this place, in a
    speed: float  # the largest, in a/T
    period: float
    restitution: float
    roughness: float

    @classmethod
    def from_settings(cls, settings, around):
        """Return the effect; raise InputError beside walls at rest."""
        if "walls" in around.effects:
            raise InputError("effects", "walls and shaken_walls", "not close the same axis twice")
        amplitude, period, *material = settings.values()
        check_speed(around, amplitude, period)
        return cls(around.box[0], TURN * amplitude / period, period, *material)


@jit
def resolve_shaken(shaken, index, what, state, scene, i, time):
    normal = along_first(scene.box, 1.0 if what == LEFT else -1.0)
    turns = (state.phase[index] + time) / shaken.period
    moving = along_last(scene.box, shaken.speed * sine_and_cosine(turns)[1])
    material = (shaken.restitution, shaken.roughness)
    return collide_with_wall(state, scene, index, i, time, material, normal, moving, 0.0)


@jit
def phase_of_walls(shaken, index, base):
    """Return the time from the beginning of a period to the clock's base."""
    return base % shaken.period


def displacement_of_walls(shaken, time):
    """Return how far the walls are from their middle at `time`, in a."""
    turn = TURN * (time % shaken.period) / shaken.period
    return shaken.speed * shaken.period / TURN * math.sin(turn)


register(
    ShakenWalls,
    SHAKEN_SETTINGS,
    predict=predict_walls,
    resolve=resolve_shaken,
    phase=phase_of_walls,
    displacement=displacement_of_walls,
    drives=True,
    closes=True,
)


SIDES = {  # name -> (axis, the end of it: 0 or 1); -1 is the last axis
    "left_wall": (0, 0),
    "right_wall": (0, 1),
    "front_wall": (1, 0),
    "back_wall": (1, 1),
    "bottom_wall": (-1, 0),
    "lid": (-1, 1),
}
NORMAL, ALONG = "normal", "along"
SHAKING = ("amplitude", "period", "wave", "phase")
SIDE_SETTINGS = {
    "restitution": MATERIAL["restitution"]._replace(default=1.0),
    "roughness": MATERIAL["roughness"]._replace(default=-1.0),
    "velocity": Number(
        "Constant velocity along itself, in a/T: along the first axis, of a left or right wall "
        "along the last one.",
        "[-1e+06, 1e+06]",
        default=0.0,
    ),
    "amplitude": Number("Height of a whole stroke of a shaken wall, in a.", LENGTH, 0.0),
    "period": Number("Time between strokes, in T; given for a shaken wall.", TIME, math.inf),
    "wave": Word("Form of its motion, as of floors.", WAVES),
    "phase": Number("Share of a period that has passed at the start, as of floors.", "[0, 1)", 0.0),
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
            return ThermalWall(place, settings["temperature"], settings["velocity"])
        if settings["amplitude"] > 0.0:
            motion = motion_of(around, *(settings[k] for k in SHAKING))
            if settings["shaken"] == NORMAL:
                return Piston(place, *material, motion)
            return MovingWall(place, *material, 0.0, motion)
        if settings["velocity"] != 0.0:
            return MovingWall(place, *material, settings["velocity"], None)
        return cls(place, *material)


class MovingWall(NamedTuple):
    """A wall that moves along itself: at a velocity that is constant, in turns, or a sine."""

    place: Place
    restitution: float
    roughness: float
    velocity: float  # constant, in a/T
    shaking: Sawtooth | Sine | Triangle | None

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


@jit
def resolve_side(wall, index, what, state, scene, i, time):
    return bounce_off_plane(wall, index, state, scene, i, time, 0, 0.0, 0.0)


@jit
def resolve_moving(wall, index, what, state, scene, i, time):
    velocity = wall.velocity
    if wall.shaking is not None:
        velocity += law_of(wall.shaking).along(wall.shaking, state.phase[index] + time)
    return bounce_off_plane(wall, index, state, scene, i, time, wall.place.along, velocity, 0.0)


@jit
def phase_of_shaking(wall, index, base):
    """Return the time from the beginning of a period to the clock's base."""
    return 0.0 if wall.shaking is None else since_period_began(wall.shaking, base)


register(SideWall, SIDE_SETTINGS, predict=predict_plane, resolve=resolve_side, closes=True)
register(
    MovingWall,
    predict=predict_plane,
    resolve=resolve_moving,
    phase=phase_of_shaking,
    drives=True,
    closes=True,
)
