"""Single sides of the box: how a particle meets them, and walls there that put energy in.

Pistons are shaken along their normal, as the floors are, on any side. One is farthest out at the
side of the box, and its strokes go into the gas. Along the last axis gravity pulls particles away
from a lid; along the others nothing pulls.

Thermal walls: whatever a particle brings along, it leaves with the velocity and the spin of one
that flies through a plane in a Maxwellian gas at the wall's temperature: the component into the gas
has the density v exp(-m v^2/(2 T)), all others are Gaussian with the variance T/m, those of a w
with T/(m q). The wall may move along itself; that is then the mean velocity of what leaves.
"""

import math
from typing import NamedTuple

from roughgas.effects import floors
from roughgas.effects.floors import LEAST_DEPARTURE, fall
from roughgas.effects.settings import register
from roughgas.kernel import hooks
from roughgas.kernel.contact import collide_with_wall
from roughgas.kernel.jit import compiled, jit
from roughgas.kernel.mathematics import gaussian_vector, logarithm, uniform
from roughgas.kernel.particles import (
    book_spin,
    enter_box,
    mass_of,
    radius_of,
    set_path,
    spin_mass_of,
    spin_of,
    turn_spin,
)
from roughgas.kernel.state import BOUNDARY_HITS, NOBODY
from roughgas.kernel.vectors import add_scaled, along_axis, dot, subtract


class Place(NamedTuple):
    """Which plane a wall is; one that is shaken along its normal, when it is farthest out."""

    axis: int
    inwards: float  # component of its normal into the gas, 1 or -1
    at: float  # in a
    along: int  # axis along which it moves


normal_axis = property(lambda wall: wall.place.axis, doc="The axis that a wall closes.")


@jit
def approach(place, state, scene, i):
    """Particle i's way to the plane: (acceleration towards it, gap, speed away from it), all when
    its path begins, and that time."""
    dimension = len(scene.box)
    time = state.trajectory[i, 2 * dimension]
    position = state.trajectory[i, place.axis]
    speed = place.inwards * state.trajectory[i, dimension + place.axis]
    gap = place.inwards * (position - place.at) - radius_of(state.bodies, i)
    return (pull(hooks.acceleration(scene.effects), place, dimension), gap, speed), time


@jit
def pull(gravity, place, dimension):
    """Return the acceleration towards a plane."""
    if gravity is None or place.axis != dimension - 1:
        return 0.0
    return place.inwards * gravity


@jit
def predict_plane(wall, index, state, scene, i):
    (gravity, gap, speed), time = approach(wall.place, state, scene, i)
    return time + fall(gap, speed, gravity), 0


@jit
def bounce_off_plane(wall, index, state, scene, i, time, axis, velocity, least_departure):
    """Carry out particle i's contact with a wall that moves along an axis at `velocity`."""
    normal = along_axis(scene.box, wall.place.axis, wall.place.inwards)
    moving = along_axis(scene.box, axis, velocity)
    material = (wall.restitution, wall.roughness)
    return collide_with_wall(
        state, scene, index, i, time, material, normal, moving, least_departure
    )


class Piston(NamedTuple):
    """A wall that goes into the gas at constant speed, and is back at once."""

    place: Place
    restitution: float
    roughness: float
    motion: floors.Floor

    axis = normal_axis
    period = property(lambda wall: wall.motion.period)


class TriangularPiston(NamedTuple):
    """A wall that goes in and out at constant speeds."""

    place: Place
    restitution: float
    roughness: float
    motion: floors.TriangularFloor

    axis = normal_axis
    period = property(lambda wall: wall.motion.period)


class SinePiston(NamedTuple):
    """A wall that goes in and out harmonically."""

    place: Place
    restitution: float
    roughness: float
    motion: floors.SineFloor

    axis = normal_axis
    period = property(lambda wall: wall.motion.period)


def make_piston(place, settings, around):
    """Return the wall at a place that moves as the settings describe."""
    chosen = {key: settings[key] for key in floors.SETTINGS}
    motion = floors.Floor.from_settings(chosen, around)
    kind = next(one for one in PISTONS if one.__annotations__["motion"] is type(motion))
    return kind(place, motion.restitution, motion.roughness, motion)


@jit
def phase_of_motion(wall, index, base):
    """Return the time from the beginning of a period to the clock's base."""
    return base % wall.motion.period


# there may be several such walls: each would else have the whole solver in its place
_until_stroke = compiled(floors.time_to_sawtooth.py_func)
_until_piece = compiled(floors.time_to_triangle.py_func)
_until_sine = compiled(floors.time_to_sine.py_func)


@jit
def _out(wall, index, state, scene, i, time, speed):
    axis, inwards = wall.place.axis, wall.place.inwards
    return bounce_off_plane(
        wall, index, state, scene, i, time, axis, inwards * speed, LEAST_DEPARTURE
    )


@jit
def _predict_stroke(wall, index, state, scene, i):
    way, time = approach(wall.place, state, scene, i)
    return time + _until_stroke(wall.motion, *way, state.phase[index] + time), 0


@jit
def _resolve_stroke(wall, index, what, state, scene, i, time):
    motion = wall.motion
    return _out(wall, index, state, scene, i, time, motion.amplitude / motion.period)


@jit
def _predict_triangular(wall, index, state, scene, i):
    way, time = approach(wall.place, state, scene, i)
    wait, piece = _until_piece(wall.motion, *way, state.phase[index] + time)
    return time + wait, piece


@jit
def _resolve_triangular(wall, index, what, state, scene, i, time):
    speed = floors.speed_of_piece(wall.motion, what)
    return _out(wall, index, state, scene, i, time, speed)


@jit
def _predict_sine(wall, index, state, scene, i):
    way, time = approach(wall.place, state, scene, i)
    return time + _until_sine(wall.motion, *way, state.phase[index] + time), 0


@jit
def _resolve_sine(wall, index, what, state, scene, i, time):
    speed = floors.sine_motion(wall.motion, state.phase[index] + time)[1]
    return _out(wall, index, state, scene, i, time, speed)


def depth_of_stroke(wall, time):
    """Return how far into the gas the wall is at `time`, in a."""
    return wall.motion.hooks.displacement(wall.motion, time)


PISTONS = {
    Piston: (_predict_stroke, _resolve_stroke),
    TriangularPiston: (_predict_triangular, _resolve_triangular),
    SinePiston: (_predict_sine, _resolve_sine),
}
for _kind, (_predict, _resolve) in PISTONS.items():
    _hooks = {"predict": _predict, "resolve": _resolve, "displacement": depth_of_stroke}
    register(_kind, phase=phase_of_motion, drives=True, closes=True, **_hooks)


class ThermalWall(NamedTuple):
    """A wall that particles leave with Maxwellian velocities and spins."""

    place: Place
    temperature: float  # m a^2/T^2
    velocity: float  # along itself, in a/T

    axis = normal_axis


@jit
def resolve_thermal(wall, index, what, state, scene, i, time):
    place, mass = wall.place, mass_of(state.bodies, i)
    position, before = enter_box(state, scene, i, time)
    thermal = math.sqrt(wall.temperature / mass)
    outwards = place.inwards * thermal * math.sqrt(-2.0 * logarithm(1.0 - uniform(state.random)))
    random = gaussian_vector(state.random, before, thermal)
    after = _with_normal(random, place.axis, outwards)
    after = add_scaled(after, along_axis(scene.box, place.along, wall.velocity), 1.0)
    set_path(state, scene, i, position, after, time)
    gained = 0.5 * dot(subtract(after, before), add_scaled(before, after, 1.0))
    state.ledger[0, index, 0] += mass * gained
    if state.spin is not None:
        _spin_anew(wall, index, state, scene, i)
    state.changes[i] += 1
    hooks.after_contact(scene.effects, state, i, time)
    state.counts[BOUNDARY_HITS] += 1
    return NOBODY


@jit
def _with_normal(velocity, axis, normal):
    return tuple(normal if k == axis else velocity[k] for k in range(len(velocity)))


@jit
def _spin_anew(wall, index, state, scene, i):
    before = spin_of(state.spin, scene.box, i)
    deviation = math.sqrt(wall.temperature / spin_mass_of(state.bodies, scene.effects.spin, i))
    turn = subtract(gaussian_vector(state.random, before, deviation), before)
    turn_spin(state.spin, i, before, turn)
    book_spin(before, turn, scene.effects.spin, state.bodies, i, state.ledger[0, index])


register(
    ThermalWall,
    predict=predict_plane,
    resolve=resolve_thermal,
    random=True,
    drives=True,
    closes=True,
)
