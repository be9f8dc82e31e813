"""Walls on sides of the box, and the contacts of particles with them.

A wall has a side, a motion, and a material or a temperature. It is at rest, or slides along itself,
at constant velocity or shaken; or it is shaken along its normal (motions.py): then its outermost
position is the side of the box, and its strokes go into the gas. A floor is a wall under a gas with
gravity, which pulls particles towards it and away from a lid. Gravity in another direction may pull
towards other walls, which slow particles leave with a minimum speed, as they leave a floor. Two
equal walls that close both ends of the first axis are one effect, with one account. Motion along
the wall changes the velocity of its surface, not its position.

Particles bounce off a material with its restitution and roughness. They leave a thermal wall, for
any velocity before, with the velocity and spin of particles that cross a plane in a Maxwellian gas
at the wall's temperature, which moves with the wall: the component into the gas has the density
v exp(-m v^2/(2 T)), all others are Gaussian with the variance T/m, and components of a w with
T/(m q).
"""

import math
from collections.abc import Iterable
from typing import Annotated, Literal, NamedTuple

from roughgas.base import InputError, NeedsError
from roughgas.base.fields import described, number
from roughgas.compiling.jit import jit
from roughgas.effects import motions
from roughgas.effects.motions import (
    SEARCH_AGAIN,
    Motion,
    Shaking,
    Stroke,
    Swing,
    fall_time,
    law_of,
    motion_of,
)
from roughgas.effects.settings import (
    LENGTH_RANGE,
    PERIOD_RANGE,
    TEMPERATURE_RANGE,
    Material,
    WallRestitution,
    WallRoughness,
    register,
)
from roughgas.kernel import hooks
from roughgas.kernel.contact import Contact, collide_with_wall, note_contact
from roughgas.kernel.event_lists import next_contact, predicted_until
from roughgas.kernel.hooks import active
from roughgas.kernel.mathematics import (
    add_scaled,
    along_axis,
    gaussian_vector,
    logarithm,
    scale,
    subtract,
    uniform,
)
from roughgas.kernel.particles import (
    change_spin_and_book,
    enter_box,
    mass_of,
    radius_of,
    set_path_and_book,
    spin_mass_of,
    spin_of,
)
from roughgas.kernel.state import BOUNDARY_HITS, NOBODY, NOW

# Minimum normal speed relative to a wall, a/T, with which particles leave it where it is shaken or
# gravity pulls towards it: below, they could hit it infinitely often in a finite time
LEAST_DEPARTURE = 1e-3
LOW, HIGH = 0, 1  # the ends of an axis
SIDES = {  # name -> (axis, end); -1 is the last axis
    "left_wall": (0, LOW),
    "right_wall": (0, HIGH),
    "front_wall": (1, LOW),
    "back_wall": (1, HIGH),
    "bottom_wall": (-1, LOW),
    "lid": (-1, HIGH),
}
BOTH_SIDES = {"walls", "shaken_walls"}  # effects that close both ends of the first axis


def closed_sides(names: Iterable[str], dimension: int) -> dict[str, tuple[int, int]]:
    """Return (axis, end) of each side of the box that effects of these `names` close, by its wall.

    Sides are in the order of the axes, which count from 0, and end is LOW or HIGH. A wall has the
    name of its effect; two walls of one effect are `left_wall` and `right_wall`.
    """
    walls = {*names}
    if walls & BOTH_SIDES:
        walls |= {"left_wall", "right_wall"}
    sides = {"floor": (-1, LOW)} | SIDES
    closed = {name: (sides[name][0] % dimension, sides[name][1]) for name in sides.keys() & walls}
    return dict(sorted(closed.items(), key=lambda side: side[1]))


ShakenAmplitude = Annotated[
    float,
    number(
        LENGTH_RANGE,
        "Maximum displacement from the middle, in a: the same as `half_stroke`, and half of the "
        "amplitude of an equal motion of a floor.",
    ),
]
Temperature = Annotated[
    float,
    number(
        TEMPERATURE_RANGE,
        "Temperature of a thermal wall, in m a^2/T^2: particles leave it with Maxwellian "
        "velocities and spins.",
    ),
]


class ShakenWallsSettings(Stroke, frozen=True, kw_only=True):
    """Settings of `shaken_walls`."""

    amplitude: ShakenAmplitude | None = None


class WallSettings(Shaking, frozen=True, kw_only=True):
    """Settings of a wall on one side of the box."""

    restitution: WallRestitution = 1.0
    roughness: WallRoughness = -1.0
    period: Annotated[float, number(PERIOD_RANGE, "Time between strokes, in T.")] = math.inf
    velocity: Annotated[
        float,
        number(
            "[-1e+06, 1e+06]",
            "Constant velocity along itself, in a/T: along the first axis, of a left or right wall "
            "along the last one.",
        ),
    ] = 0.0
    shaken: Annotated[
        Literal["normal", "along"],
        described("Whether it is shaken along its normal or along itself."),
    ] = "normal"
    temperature: Temperature | None = None


class Side(NamedTuple):
    """The side of the box that a wall closes, or both sides of an axis."""

    axis: int
    inwards: float | None  # component of the normal into the gas, 1 or -1; None: both ends
    position: float  # outermost, in a; of two walls the higher
    slide_axis: int  # axis of motion along the wall


class Wall(NamedTuple):
    """A wall on one side of the box: at rest, sliding, shaken or thermal."""

    side: Side
    restitution: float = 1.0
    roughness: float = -1.0
    velocity: float = 0.0  # constant, along the wall, in a/T
    motion: Motion | None = None  # along the normal
    sliding: Motion | None = None  # along the wall
    temperature: float | None = None  # m a^2/T^2; None is not thermal

    @property
    def axis(self) -> int:
        """The axis that the wall closes, from 0."""
        return self.side.axis

    @property
    def ends(self) -> tuple[int, ...]:
        """The closed ends of the axis: LOW, HIGH, or both."""
        if self.side.inwards is None:
            return LOW, HIGH
        return (HIGH if self.side.inwards < 0.0 else LOW,)

    @property
    def period(self) -> float:
        """Time between strokes, in T; infinite without shaking."""
        shaken = self.motion or self.sliding
        return math.inf if shaken is None or shaken.amplitude == 0.0 else shaken.period

    @classmethod
    def from_settings(cls, settings, context):
        """Return the wall from WallSettings and a SceneContext, whose `name` is the wall's.

        Raises InputError for settings that contradict each other or the scene.
        """
        side, velocity = _side(context), settings.velocity
        _refuse_contradictions(settings, context)
        half = motions.half_stroke(context, settings, min_count=0)
        if settings.temperature is not None:
            return ThermalWall(side, velocity=velocity, temperature=settings.temperature)
        material = settings.resolved(context)
        if half > 0.0:
            field = "motion" if settings.shaken == "normal" else "sliding"
            return MovingWall(side, *material, **{field: motion_of(half, settings)})
        return (MovingWall if velocity else cls)(side, *material, velocity)


class MovingWall(Wall):
    """A wall that supplies energy by its motion."""


class ThermalWall(Wall):
    """A wall that particles leave with Maxwellian velocities and spins."""


class Walls(Wall):
    """Side walls at rest that close the first axis."""

    @classmethod
    def from_settings(cls, settings, context):
        """Return the walls from the settings of a Material and a SceneContext.

        They are as far apart as the box is wide.
        """
        return cls(_both_ends(context), *settings.resolved(context))


class ShakenWalls(Wall):
    """Side walls that close the first axis, and are shaken along the last one as a sine."""

    @classmethod
    def from_settings(cls, settings, context):
        """Return the walls from ShakenWallsSettings and a SceneContext.

        They are as far apart as the box is wide.
        """
        half, period = motions.half_stroke(context, settings, share=1.0), settings.period
        swing = Swing(half, period, settings.phase * period)
        return cls(_both_ends(context), *settings.resolved(context), sliding=swing)


class Floor(Wall):
    """A shaken floor under a gas with gravity."""

    amplitude = property(lambda floor: floor.motion.amplitude)

    @classmethod
    def from_settings(cls, settings, context):
        """Return the floor from the settings of its Shaking and a SceneContext."""
        motion = motion_of(motions.half_stroke(context, settings), settings)
        side = Side(len(context.box) - 1, 1.0, 0.0, 0)
        return cls(side, *settings.resolved(context), motion=motion)


def _both_ends(context):
    """Return the Side of two walls that close both ends of the first axis."""
    return Side(0, None, context.box[0], len(context.box) - 1)


def _side(context):
    """Return the Side of the wall `context.name`; raise InputError if the box has no such side."""
    key, (axis, end) = f"effects.{context.name}", SIDES[context.name]
    dimension = len(context.box)
    if axis == 1 and dimension == 2:
        raise InputError(key, "in the plane", "be bottom_wall or lid there")
    axis %= dimension
    if context.box[axis] is None:
        raise NeedsError(key, f"a length of the box along its {'last' if axis else 'first'} axis")
    if context.name == "bottom_wall" and _gravity_is_vertical(context):
        raise InputError(key, "with gravity", "be a floor there, which may be at rest")
    slide_axis = dimension - 1 if axis == 0 else 0
    return Side(axis, 1.0 - 2.0 * end, context.box[axis] * end, slide_axis)


def _gravity_is_vertical(context):
    """Return whether gravity in a SceneContext has a component along the last axis."""
    gravity = context.effects.get("gravity")
    return gravity is not None and (gravity.direction is None or gravity.direction[-1] != 0.0)


def _refuse_contradictions(settings, context):
    """Raise InputError for settings of a wall that contradict each other."""
    key = f"effects.{context.name}"
    shaken = bool(settings.amplitude or settings.half_stroke)
    if shaken and settings.period == math.inf:
        raise InputError(f"{key}.period", "(nothing)", "be given where the wall is shaken")
    if shaken and settings.velocity != 0.0:
        raise InputError(f"{key}.velocity", settings.velocity, "be 0 where the wall is shaken")
    if settings.temperature is not None:
        defaults = WallSettings()
        for name in ("restitution", "roughness", "amplitude", "half_stroke"):
            if getattr(settings, name) != getattr(defaults, name):
                legal = "not be given where the wall has a temperature"
                raise InputError(f"{key}.{name}", getattr(settings, name), legal)


@jit
def predict_wall(wall, account, state, scene, i):
    """Return (time, code) of particle i's next meeting with the wall, or of a renewed search.

    The code is MEETING or SEARCH_AGAIN, the segment of a piecewise linear motion, or the end of the
    axis (LOW, HIGH) where the walls close both. Hook `predict` (kernel.hooks); `account` is the
    index of the wall's phase in State.phase.
    """
    side, dimension, radius = wall.side, len(scene.box), radius_of(state.bodies, i)
    time = state.trajectory[i, 2 * dimension]
    position = state.trajectory[i, side.axis]
    velocity = state.trajectory[i, dimension + side.axis]
    if side.inwards is None:
        gaps = position - radius, side.position - radius - position
        delay, end = _first_of_both_ends(hooks.acceleration(scene.effects), gaps, velocity)
        return time + delay, end
    gap = side.inwards * (position - side.position) - radius
    speed = side.inwards * velocity
    gravity = _gravity_towards(hooks.acceleration(scene.effects), side.axis, side.inwards)
    if wall.motion is None:
        return time + fall_time(gap, speed, gravity), motions.MEETING
    # A particle that stays above all strokes until its next prediction has no event until then.
    # With searches this would shift other events, and with them the last bits of all times
    if not law_of(wall.motion).has_limit:
        span = state.clock[NOW] - time, predicted_until(state, i) - time
        if motions.is_above(wall.motion.amplitude, gravity, gap, speed, span):
            return math.inf, motions.MEETING
    phase = state.phase[account] + time
    # In cells most particles collide before they meet the wall, so the search ends at the next
    # contact. With a sweep this would move the clock's base at other events, and change the last
    # bits of all times
    if law_of(wall.motion).has_limit and state.cells is not None:
        limit = next_contact(state, i)[0]
        search = law_of(wall.motion).search
        delay, code = search(wall.motion, gravity, gap, speed, phase, limit - time)
        return (time + delay if code == motions.MEETING else max(time + delay, limit)), code
    if law_of(wall.motion).has_limit:  # above all strokes: search when it returns
        return_time = time + motions.time_below(wall.motion.amplitude, gravity, gap, speed, 0.0)
        if return_time > state.clock[NOW]:
            return return_time, SEARCH_AGAIN
    delay, code = law_of(wall.motion).meet(wall.motion, gravity, gap, speed, phase)
    return time + delay, code


@jit
def _first_of_both_ends(gravity, gaps, velocity):
    """Return the time until a particle meets a wall of two that close the first axis, and the end.

    `gaps` are its distances from the walls at both ends; `velocity` is along the axis, and
    `gravity` as in `_gravity_towards`.
    """
    if gravity is None or gravity[0] is None:
        end = HIGH if velocity > 0.0 else LOW
        return fall_time(gaps[1] if end == HIGH else gaps[0], -abs(velocity), 0.0), end
    low, high = fall_time(gaps[0], velocity, -gravity[0]), fall_time(gaps[1], -velocity, gravity[0])
    return (low, LOW) if low < high else (high, HIGH)


@jit
def _gravity_towards(gravity, axis, inwards):
    """Return the acceleration towards a wall; 0 along an axis without gravity.

    `gravity` is the acceleration along each axis, None where it vanishes, or None; the wall closes
    the `axis`, and its normal into the gas has the component `inwards` along it.
    """
    towards = 0.0
    if gravity is not None:
        for k in range(len(gravity)):
            if gravity[k] is not None and axis == k:
                towards = -inwards * gravity[k]
    return towards


@jit
def resolve_wall(wall, account, code, state, scene, i, time):
    """Let particle i meet the wall at `time`, or only search again; return NOBODY (-1).

    `code` is from `predict_wall`. Hook `resolve` (kernel.hooks): the energy gained is entered in
    the wall's account, whose index is `account`.
    """
    side, material = wall.side, (wall.restitution, wall.roughness)
    if wall.temperature is not None:
        return _leave_thermal_wall(wall, account, state, scene, i, time)
    if wall.motion is not None and law_of(wall.motion).has_limit and code == SEARCH_AGAIN:
        return NOBODY
    inwards = _inwards(side, code)
    normal = along_axis(scene.box, side.axis, inwards)
    velocity = _surface_velocity(wall, account, code, state, scene.box, time)
    min_departure = _min_departure(wall, hooks.acceleration(scene.effects), inwards)
    return collide_with_wall(
        state, scene, account, i, time, material, normal, velocity, min_departure
    )


@jit
def _min_departure(wall, gravity, inwards):
    """Return the minimum normal speed, a/T, with which particles leave a wall that is not thermal.

    `gravity` and `inwards` are as in `_gravity_towards`. Without a minimum, an inelastic particle
    that falls back would hit the wall infinitely often in a finite time.
    """
    if wall.motion is not None:
        return LEAST_DEPARTURE
    return LEAST_DEPARTURE if _gravity_towards(gravity, wall.side.axis, inwards) > 0.0 else 0.0


@jit
def _inwards(side, end):
    """Return the component of the normal into the gas, 1 or -1.

    Of two walls it is the wall's at this `end` of the axis, LOW or HIGH.
    """
    if side.inwards is None:
        return 1.0 if end == LOW else -1.0
    return side.inwards


@jit
def _surface_velocity(wall, account, code, state, box, time):
    """Return the velocity of the wall's surface at a meeting with a particle at `time`.

    `code` is from `predict_wall`.
    """
    side = wall.side
    if wall.motion is not None:
        speed = law_of(wall.motion).surface_speed(wall.motion, code, state.phase[account] + time)
        return along_axis(box, side.axis, side.inwards * speed)
    if wall.sliding is not None:
        surface = law_of(wall.sliding).surface(wall.sliding, state.phase[account] + time)
        return along_axis(box, side.slide_axis, surface[1])
    return along_axis(box, side.slide_axis, wall.velocity)


@jit
def _leave_thermal_wall(wall, account, state, scene, i, time):
    """Draw velocity and spin of particle i as it leaves a thermal wall at `time`; return NOBODY."""
    side, box = wall.side, scene.box
    position, before = enter_box(state, scene, i, time)
    thermal = math.sqrt(wall.temperature / mass_of(state.bodies, i))
    normal_velocity = (
        side.inwards * thermal * math.sqrt(-2.0 * logarithm(1.0 - uniform(state.random)))
    )
    random = gaussian_vector(state.random, before, thermal)
    after = tuple(normal_velocity if k == side.axis else random[k] for k in range(len(box)))
    after = add_scaled(after, along_axis(box, side.slide_axis, wall.velocity), 1.0)
    ledger_row = state.ledger[0, account]
    set_path_and_book(state, scene, i, position, before, after, time, ledger_row)
    w, spin = spin_of(state.spin, box, i), scene.effects.spin
    if state.spin is not None:
        deviation = math.sqrt(wall.temperature / spin_mass_of(state.bodies, spin, i))
        spin_change = subtract(gaussian_vector(state.random, w, deviation), w)
        change_spin_and_book(state, scene, i, w, spin_change, ledger_row)
    for hook in active(scene.effects, "observe_thermal_wall"):
        contact = _departure(wall, state, scene, i, time, (before, after), w)
        hook.function(scene.effects[hook.effect_index], hook.account, state, contact)
    note_contact(state, scene.effects, i, time)
    state.counts[BOUNDARY_HITS] += 1
    return NOBODY


@jit
def _departure(wall, state, scene, i, time, velocities, w):
    """Return the Contact of particle i with a thermal wall that it leaves at `time`.

    `velocities` are the particle's before and after, `w` is its spin before.
    """
    side, box, (before, after) = wall.side, scene.box, velocities
    n = along_axis(box, side.axis, side.inwards)
    surface = along_axis(box, side.slide_axis, wall.velocity)
    impulse = scale(subtract(before, after), mass_of(state.bodies, i))
    v = subtract(before, surface)
    return Contact(i, NOBODY, time, n, v, w, impulse, (before, surface), (w, w))


@jit
def phase_of_wall(wall, account, base):
    """Return the time from the beginning of a period to the absolute time `base`, in T.

    0 if the wall is not shaken. Hook `phase` (kernel.hooks), which does without the account.
    """
    shaken = wall.sliding if wall.motion is None else wall.motion
    return 0.0 if shaken is None else motions.time_in_period(shaken, base)


def displacement_of_wall(wall, time):
    """Return the displacement of a shaken wall at absolute `time` (T), in particle radii a."""
    return motions.displacement(wall.motion or wall.sliding, time)


EVENT_HOOKS = {"predict": predict_wall, "resolve": resolve_wall}
MOTION_HOOKS = {"phase": phase_of_wall, "displacement": displacement_of_wall, "drives": True}
register(Wall, WallSettings, **EVENT_HOOKS)
register(MovingWall, **EVENT_HOOKS, **MOTION_HOOKS)
register(ThermalWall, **EVENT_HOOKS, random=True, drives=True)
register(Walls, Material, **EVENT_HOOKS)
register(ShakenWalls, ShakenWallsSettings, **EVENT_HOOKS, **MOTION_HOOKS)
register(Floor, Shaking, **EVENT_HOOKS, **MOTION_HOOKS)
