"""Single sides of the box: how a particle meets them, and those that put energy in.

A floor under a gas with gravity, and pistons on any side of a box, are shaken along their normal
(motions.py). A piston is farthest out at the side of the box, and its strokes go into the gas.
Along the last axis gravity pulls particles away from a lid; along the others nothing pulls.

Thermal walls: whatever a particle brings along, it leaves with the velocity and the spin of one
that flies through a plane in a Maxwellian gas at the wall's temperature: the component into the gas
has the density v exp(-m v^2/(2 T)), all others are Gaussian with the variance T/m, those of a w
with T/(m q). The wall may move along itself; that is then the mean velocity of what leaves.
"""

import math
from typing import NamedTuple

from roughgas.effects import motions
from roughgas.effects.motions import LOOK, MEET, Sawtooth, Sine, Triangle, fall, law_of, motion_of
from roughgas.effects.settings import MATERIAL, register
from roughgas.kernel import hooks
from roughgas.kernel.contact import collide_with_wall
from roughgas.kernel.jit import jit
from roughgas.kernel.mathematics import gaussian_vector, logarithm, uniform
from roughgas.kernel.particles import (
    book_spin,
    book_velocity,
    enter_box,
    mass_of,
    radius_of,
    set_path,
    spin_mass_of,
    spin_of,
    turn_spin,
)
from roughgas.kernel.state import BOUNDARY_HITS, NOBODY, NOW
from roughgas.kernel.vectors import add_scaled, along_axis, subtract

# Relative to what is shaken, a/T: any less, and a particle could hit it infinitely often in finite
# time
LEAST_DEPARTURE = 1e-3


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
    return time + fall(gap, speed, gravity), MEET


@jit
def bounce_off_plane(wall, index, state, scene, i, time, axis, velocity, least_departure):
    """Carry out particle i's contact with a wall that moves along an axis at `velocity`."""
    normal = along_axis(scene.box, wall.place.axis, wall.place.inwards)
    moving = along_axis(scene.box, axis, velocity)
    material = (wall.restitution, wall.roughness)
    return collide_with_wall(
        state, scene, index, i, time, material, normal, moving, least_departure
    )


@jit
def predict_stroke(wall, index, state, scene, i):
    (gravity, gap, speed), time = approach(wall.place, state, scene, i)
    motion, phase = wall.motion, state.phase[index] + time
    if law_of(wall.motion).waits:
        back = time + motions.time_below(motion.amplitude, gravity, gap, speed, 0.0)
        if back > state.clock[NOW]:
            return back, LOOK
    wait, what = law_of(wall.motion).meet(motion, gravity, gap, speed, phase)
    return time + wait, what


@jit
def resolve_stroke(wall, index, what, state, scene, i, time):
    if law_of(wall.motion).waits and what == LOOK:
        return NOBODY
    speed = law_of(wall.motion).speed(wall.motion, what, state.phase[index] + time)
    axis, velocity = wall.place.axis, wall.place.inwards * speed
    return bounce_off_plane(wall, index, state, scene, i, time, axis, velocity, LEAST_DEPARTURE)


@jit
def phase_of_stroke(wall, index, base):
    """Return the time from the beginning of a period to the clock's base."""
    return motions.since_period_began(wall.motion, base)


def depth_of_stroke(wall, time):
    """Return how far into the gas the surface is at `time`, in a."""
    return law_of(wall.motion).height(wall.motion, time + wall.motion.ahead)


class Piston(NamedTuple):
    """A wall that is shaken along its normal."""

    place: Place
    restitution: float
    roughness: float
    motion: Sawtooth | Sine | Triangle

    axis = normal_axis


class Floor(NamedTuple):
    """A shaken floor under a gas with gravity."""

    place: Place
    restitution: float
    roughness: float
    motion: Sawtooth | Sine | Triangle

    amplitude = property(lambda floor: floor.motion.amplitude)
    period = property(lambda floor: floor.motion.period)

    @classmethod
    def from_settings(cls, settings, around):
        """Return the floor whose motion the settings describe."""
        motion = motion_of(around, *(settings[name] for name in motions.SETTINGS))
        place = Place(len(around.box) - 1, 1.0, 0.0, 0)
        return cls(place, settings["restitution"], settings["roughness"], motion)


STROKES = {
    "predict": predict_stroke,
    "resolve": resolve_stroke,
    "phase": phase_of_stroke,
    "displacement": depth_of_stroke,
    "drives": True,
}
register(Floor, motions.SETTINGS | MATERIAL, **STROKES)
register(Piston, closes=True, **STROKES)


class ThermalWall(NamedTuple):
    """A wall that particles leave with Maxwellian velocities and spins."""

    place: Place
    temperature: float  # m a^2/T^2
    velocity: float  # along itself, in a/T

    axis = normal_axis


@jit
def resolve_thermal(wall, index, what, state, scene, i, time):
    place = wall.place
    position, before = enter_box(state, scene, i, time)
    thermal = math.sqrt(wall.temperature / mass_of(state.bodies, i))
    outwards = place.inwards * thermal * math.sqrt(-2.0 * logarithm(1.0 - uniform(state.random)))
    random = gaussian_vector(state.random, before, thermal)
    after = _with_normal(random, place.axis, outwards)
    after = add_scaled(after, along_axis(scene.box, place.along, wall.velocity), 1.0)
    set_path(state, scene, i, position, after, time)
    book_velocity(before, after, state.bodies, i, state.ledger[0, index])
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
