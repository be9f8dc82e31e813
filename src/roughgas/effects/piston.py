"""Walls that are shaken along their normal: the motions of the floors, on any side of the box.

A wall is farthest out at the side of the box, and its strokes go into the gas. Along the last axis
gravity pulls particles away from a lid; along the others nothing pulls.
"""

from typing import NamedTuple

from roughgas.effects import floor, sine_floor, triangular_floor
from roughgas.effects.plane import Place, approach, bounce, normal_axis
from roughgas.effects.settings import register
from roughgas.effects.surface import LEAST_DEPARTURE
from roughgas.kernel.jit import compiled, jit


class Piston(NamedTuple):
    """A wall that goes into the gas at constant speed, and is back at once."""

    place: Place
    restitution: float
    roughness: float
    motion: floor.Floor

    axis = normal_axis
    period = property(lambda wall: wall.motion.period)


class TriangularPiston(NamedTuple):
    """A wall that goes in and out at constant speeds."""

    place: Place
    restitution: float
    roughness: float
    motion: triangular_floor.TriangularFloor

    axis = normal_axis
    period = property(lambda wall: wall.motion.period)


class SinePiston(NamedTuple):
    """A wall that goes in and out harmonically."""

    place: Place
    restitution: float
    roughness: float
    motion: sine_floor.SineFloor

    axis = normal_axis
    period = property(lambda wall: wall.motion.period)


def make(place, settings, around):
    """Return the wall at a place that moves as the settings describe."""
    chosen = {key: settings[key] for key in floor.SETTINGS}
    motion = floor.Floor.from_settings(chosen, around)
    kinds = {
        floor.Floor: Piston,
        triangular_floor.TriangularFloor: TriangularPiston,
        sine_floor.SineFloor: SinePiston,
    }
    return kinds[type(motion)](place, motion.restitution, motion.roughness, motion)


@jit
def phase(wall, index, base):
    """Return the time from the beginning of a period to the clock's base."""
    return base % wall.motion.period


# there may be several such walls: each would else have the whole solver in its place
_until_stroke = compiled(lambda *way: floor.time_to_floor(*way))
_until_piece = compiled(lambda *way: triangular_floor.time_to_floor(*way))
_until_sine = compiled(lambda *way: sine_floor.time_to_floor(*way))


@jit
def _out(wall, index, state, scene, i, time, speed):
    axis, inwards = wall.place.axis, wall.place.inwards
    return bounce(wall, index, state, scene, i, time, axis, inwards * speed, LEAST_DEPARTURE)


@jit
def _predict(wall, index, state, scene, i):
    way, time = approach(wall.place, state, scene, i)
    return time + _until_stroke(wall.motion, *way, state.phase[index] + time), 0


@jit
def _resolve(wall, index, what, state, scene, i, time):
    motion = wall.motion
    return _out(wall, index, state, scene, i, time, motion.amplitude / motion.period)


@jit
def _predict_triangular(wall, index, state, scene, i):
    way, time = approach(wall.place, state, scene, i)
    wait, piece = _until_piece(wall.motion, *way, state.phase[index] + time)
    return time + wait, piece


@jit
def _resolve_triangular(wall, index, what, state, scene, i, time):
    speed = triangular_floor.speed_of(wall.motion, what)
    return _out(wall, index, state, scene, i, time, speed)


@jit
def _predict_sine(wall, index, state, scene, i):
    way, time = approach(wall.place, state, scene, i)
    return time + _until_sine(wall.motion, *way, state.phase[index] + time), 0


@jit
def _resolve_sine(wall, index, what, state, scene, i, time):
    speed = sine_floor.motion(wall.motion, state.phase[index] + time)[1]
    return _out(wall, index, state, scene, i, time, speed)


def displacement(wall, time):
    """Return how far into the gas the wall is at `time`, in a."""
    return wall.motion.hooks.displacement(wall.motion, time)


for _kind, _ahead, _carry_out in (
    (Piston, _predict, _resolve),
    (TriangularPiston, _predict_triangular, _resolve_triangular),
    (SinePiston, _predict_sine, _resolve_sine),
):
    register(
        _kind,
        predict=_ahead,
        resolve=_carry_out,
        phase=phase,
        displacement=displacement,
        drives=True,
        closes=True,
    )
