"""Walls: what closes a side of the box, and how particles meet it.

A wall has a place, a motion, and what it does to particles. It is at rest, or slides along itself,
at constant velocity or shaken; or it is shaken along its normal (motions.py): then it is farthest
out at the side of the box, and its strokes go into the gas. A floor is one under a gas with
gravity, which pulls particles towards it and away from a lid; along the other axes nothing pulls.
Two equal walls that close both ends of the first axis are one effect, with one account. The
surface of what moves along itself stays where it is: only the velocity that particles meet there
changes.

What bounces off has a restitution and a roughness. From a thermal wall, whatever a particle brings
along, it leaves with the velocity and the spin of one that flies through a plane in a Maxwellian
gas at the wall's temperature, which moves as the wall does: the component into the gas has the
density v exp(-m v^2/(2 T)), all others are Gaussian with the variance T/m, those of a w with
T/(m q).
"""

import math
from typing import NamedTuple

from roughgas.base import InputError, NeedsError
from roughgas.compiling.jit import jit
from roughgas.effects import motions
from roughgas.effects.motions import LOOK, Motion, Swing, fall, law_of, motion_of
from roughgas.effects.settings import (
    MATERIAL,
    TEMPERATURE,
    Number,
    Word,
    register,
)
from roughgas.kernel import hooks
from roughgas.kernel.contact import collide_with_wall, note_contact
from roughgas.kernel.event_lists import foreseen_until, next_contact
from roughgas.kernel.mathematics import (
    add_scaled,
    along_axis,
    gaussian_vector,
    logarithm,
    subtract,
    uniform,
)
from roughgas.kernel.particles import (
    enter_box,
    mass_of,
    radius_of,
    set_path_and_book,
    spin_mass_of,
    spin_of,
    turn_and_book,
)
from roughgas.kernel.state import BOUNDARY_HITS, NOBODY, NOW

# Relative to what is shaken, a/T: any less, and a particle could hit it infinitely often in finite
# time
LEAST_DEPARTURE = 1e-3
LOW, HIGH = 0, 1  # the ends of an axis
SIDES = {  # name -> (axis, which end of it); -1 is the last axis
    "left_wall": (0, LOW),
    "right_wall": (0, HIGH),
    "front_wall": (1, LOW),
    "back_wall": (1, HIGH),
    "bottom_wall": (-1, LOW),
    "lid": (-1, HIGH),
}
NORMAL, ALONG = "normal", "along"
SHAKEN_SETTINGS = motions.STROKE | {
    "amplitude": motions.STROKE["amplitude"]._replace(
        description="Largest displacement from the middle, in a: the same as `half_stroke`, and "
        "half of what an amplitude of a floor is."
    )
}
SIDE_SETTINGS = {
    "restitution": MATERIAL["restitution"]._replace(default=1.0),
    "roughness": MATERIAL["roughness"]._replace(default=-1.0),
    "velocity": Number(
        "Constant velocity along itself, in a/T: along the first axis, of a left or right wall "
        "along the last one.",
        "[-1e+06, 1e+06]",
        default=0.0,
    ),
    **motions.SETTINGS,
    "period": motions.STROKE["period"]._replace(default=math.inf),
    "shaken": Word("Whether it is shaken along its normal or along itself.", (NORMAL, ALONG)),
    "temperature": Number(
        "Temperature of a thermal wall, in m a^2/T^2: particles leave it with Maxwellian "
        "velocities and spins, whatever its material.",
        TEMPERATURE,
        default=math.inf,
    ),
}


class Place(NamedTuple):
    """Which side of the box a wall closes."""

    axis: int
    inwards: float | None  # component of its normal into the gas, 1 or -1; None: both ends
    at: float  # in a, when it is farthest out; the high one of two
    along: int  # axis along which it moves if it moves along itself


class Wall(NamedTuple):
    """A wall on one side of the box: at rest, sliding, shaken or thermal."""

    place: Place
    restitution: float = 1.0
    roughness: float = -1.0
    velocity: float = 0.0  # constant, along itself, in a/T
    motion: Motion | None = None  # along its normal
    sliding: Motion | None = None  # along itself
    temperature: float | None = None  # m a^2/T^2; None is not thermal

    @property
    def axis(self) -> int:
        """The axis that it closes."""
        return self.place.axis

    @property
    def ends(self) -> tuple[int, ...]:
        """Which ends of the axis it closes: LOW, HIGH, or both."""
        if self.place.inwards is None:
            return LOW, HIGH
        return (HIGH if self.place.inwards < 0.0 else LOW,)

    @property
    def period(self) -> float:
        """Time between strokes, in T; infinite where it is not shaken."""
        shaken = self.motion or self.sliding
        return math.inf if shaken is None or shaken.amplitude == 0.0 else shaken.period

    @classmethod
    def from_settings(cls, settings, around):
        """Return the wall that the settings describe; raise InputError where they contradict."""
        place, velocity = _place(around), settings["velocity"]
        half = motions.half_stroke(around, settings, fewest=0)
        _refuse_contradictions(settings, around, half > 0.0)
        if settings["temperature"] < math.inf:
            return ThermalWall(place, velocity=velocity, temperature=settings["temperature"])
        material = _material(settings)
        if half > 0.0:
            way = "motion" if settings["shaken"] == NORMAL else "sliding"
            return MovingWall(place, *material, **{way: motion_of(half, settings)})
        return (MovingWall if velocity else cls)(place, *material, velocity)


class MovingWall(Wall):
    """A wall that puts energy in by its motion."""


class ThermalWall(Wall):
    """A wall that particles leave with Maxwellian velocities and spins."""


class Walls(Wall):
    """Side walls at rest that close the first axis."""

    @classmethod
    def from_settings(cls, settings, around):
        """Return the walls, as far apart as the box is wide."""
        return cls(_both_ends(around), **settings)


class ShakenWalls(Wall):
    """Side walls that close the first axis, and are shaken along the last one as a sine."""

    @classmethod
    def from_settings(cls, settings, around):
        """Return the walls, as far apart as the box is wide."""
        half, period = motions.half_stroke(around, settings, share=1.0), settings["period"]
        swing = Swing(half, period, settings["phase"] * period)
        return cls(_both_ends(around), *_material(settings), sliding=swing)


class Floor(Wall):
    """A shaken floor under a gas with gravity."""

    amplitude = property(lambda floor: floor.motion.amplitude)

    @classmethod
    def from_settings(cls, settings, around):
        """Return the floor whose motion the settings describe."""
        motion = motion_of(motions.half_stroke(around, settings), settings)
        place = Place(len(around.box) - 1, 1.0, 0.0, 0)
        return cls(place, *_material(settings), motion=motion)


def _material(settings):
    return settings["restitution"], settings["roughness"]


def _both_ends(around):
    return Place(0, None, around.box[0], len(around.box) - 1)


def _place(around):
    """Return the place of a single wall; raise InputError where the box has no such side."""
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


def _refuse_contradictions(settings, around, shaken):
    key, given = f"effects.{around.name}", around.effects[around.name]
    if shaken and settings["period"] == math.inf:
        raise InputError(f"{key}.period", "(nothing)", "be given where the wall is shaken")
    if shaken and settings["velocity"] != 0.0:
        raise InputError(f"{key}.velocity", settings["velocity"], "be 0 where the wall is shaken")
    if settings["temperature"] < math.inf:
        for name in ("restitution", "roughness", "amplitude", "half_stroke"):
            if name in given:
                legal = "not be given where the wall has a temperature"
                raise InputError(f"{key}.{name}", given[name], legal)


@jit
def predict_wall(wall, index, state, scene, i):
    place, dimension, radius = wall.place, len(scene.box), radius_of(state.bodies, i)
    time = state.trajectory[i, 2 * dimension]
    position = state.trajectory[i, place.axis]
    velocity = state.trajectory[i, dimension + place.axis]
    if place.inwards is None:
        end = HIGH if velocity > 0.0 else LOW
        gap = place.at - radius - position if end == HIGH else position - radius
        return time + fall(gap, -abs(velocity), 0.0), end
    gap = place.inwards * (position - place.at) - radius
    speed = place.inwards * velocity
    gravity = _pull(hooks.acceleration(scene.effects), place, dimension)
    if wall.motion is None:
        return time + fall(gap, speed, gravity), motions.MEET
    # What stays above all strokes is looked at again when its foresight ends. Where a search waits,
    # this would change when events are, and with them the last bits of all times
    if not law_of(wall.motion).waits:
        span = state.clock[NOW] - time, foreseen_until(state, i) - time
        if motions.is_above(wall.motion.amplitude, gravity, gap, speed, span):
            return math.inf, motions.MEET
    phase = state.phase[index] + time
    # Among many, few get there before a contact. Among few, the clock's base moves at other events
    # if a search ends at one, and with it the last bits of all times
    if law_of(wall.motion).waits and state.cells is not None:
        limit = next_contact(state, i)[0]
        search = law_of(wall.motion).search
        wait, what = search(wall.motion, gravity, gap, speed, phase, limit - time)
        return (time + wait if what == motions.MEET else max(time + wait, limit)), what
    if law_of(wall.motion).waits:  # what flies above all strokes is looked at when it is back
        back = time + motions.time_below(wall.motion.amplitude, gravity, gap, speed, 0.0)
        if back > state.clock[NOW]:
            return back, LOOK
    wait, what = law_of(wall.motion).meet(wall.motion, gravity, gap, speed, phase)
    return time + wait, what


@jit
def _pull(gravity, place, dimension):
    """Return the acceleration towards a wall."""
    if gravity is None or place.axis != dimension - 1:
        return 0.0
    return place.inwards * gravity


@jit
def resolve_wall(wall, index, what, state, scene, i, time):
    place, material = wall.place, (wall.restitution, wall.roughness)
    if wall.temperature is not None:
        return _leave(wall, index, state, scene, i, time)
    if wall.motion is not None and law_of(wall.motion).waits and what == LOOK:
        return NOBODY
    normal = along_axis(scene.box, place.axis, _inwards(place, what))
    velocity = _velocity(wall, index, what, state, scene.box, time)
    least = 0.0 if wall.motion is None else LEAST_DEPARTURE
    return collide_with_wall(state, scene, index, i, time, material, normal, velocity, least)


@jit
def _inwards(place, end):
    if place.inwards is None:
        return 1.0 if end == LOW else -1.0
    return place.inwards


@jit
def _velocity(wall, index, what, state, box, time):
    """Return the velocity of the surface when it meets a particle."""
    place = wall.place
    if wall.motion is not None:
        speed = law_of(wall.motion).met(wall.motion, what, state.phase[index] + time)
        return along_axis(box, place.axis, place.inwards * speed)
    if wall.sliding is not None:
        here = law_of(wall.sliding).at(wall.sliding, state.phase[index] + time)
        return along_axis(box, place.along, here[1])
    return along_axis(box, place.along, wall.velocity)


@jit
def _leave(wall, index, state, scene, i, time):
    """Let particle i leave a thermal wall."""
    place, box = wall.place, scene.box
    position, before = enter_box(state, scene, i, time)
    thermal = math.sqrt(wall.temperature / mass_of(state.bodies, i))
    outwards = place.inwards * thermal * math.sqrt(-2.0 * logarithm(1.0 - uniform(state.random)))
    random = gaussian_vector(state.random, before, thermal)
    after = tuple(outwards if k == place.axis else random[k] for k in range(len(box)))
    after = add_scaled(after, along_axis(box, place.along, wall.velocity), 1.0)
    account = state.ledger[0, index]
    set_path_and_book(state, scene, i, position, before, after, time, account)
    if state.spin is not None:
        w, spin = spin_of(state.spin, box, i), scene.effects.spin
        deviation = math.sqrt(wall.temperature / spin_mass_of(state.bodies, spin, i))
        turn = subtract(gaussian_vector(state.random, w, deviation), w)
        turn_and_book(state, scene, i, w, turn, account)
    note_contact(state, scene.effects, i, time)
    state.counts[BOUNDARY_HITS] += 1
    return NOBODY


@jit
def phase_of_wall(wall, index, base):
    """Return the time from the beginning of a period to the clock's base."""
    shaken = wall.sliding if wall.motion is None else wall.motion
    return 0.0 if shaken is None else motions.since_period_began(shaken, base)


def displacement_of_wall(wall, time):
    """Return how far the wall has moved at `time`, in a."""
    return motions.displacement(wall.motion or wall.sliding, time)


MET = {"predict": predict_wall, "resolve": resolve_wall}
MOVES = {"phase": phase_of_wall, "displacement": displacement_of_wall, "drives": True}
register(Wall, SIDE_SETTINGS, **MET)
register(MovingWall, **MET, **MOVES)
register(ThermalWall, **MET, random=True, drives=True)
register(Walls, MATERIAL, **MET)
register(ShakenWalls, SHAKEN_SETTINGS | MATERIAL, **MET, **MOVES)
register(Floor, motions.SETTINGS | MATERIAL, **MET, **MOVES)
