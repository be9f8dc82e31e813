"""Motions of shaken walls, and the times when particles meet walls shaken along the normal.

In these equations T is the period, A the height of the stroke. "Height" and "gravity" refer to a
floor; at other walls they are the gap in front of the wall, and the acceleration towards it.

- PiecewiseLinear: from its lowest point on, the surface moves at a constant speed in each segment
  of the period. It meets a particle at a root of a quadratic equation. A sawtooth has one segment,
  A t/T: at its end the surface returns to zero instantly, and touches nothing on the way. A
  triangle has two segments; so has a reversed sawtooth, which rises in a tenth of its period: a
  sudden rise would give every particle that it meets an infinite speed.
- Sine: the surface is at A (1 - cos 2 pi t/T)/2. The time of a meeting has no closed form; it is
  approached by steps that cannot lead past a meeting.
- Swing: harmonic, A sin 2 pi t/T about the middle; along the wall only.

Each motion is a type, so that a kernel contains the code of its own motion only: `law_of`. A new
motion needs its fields, its functions and a line in LAWS.
"""

import math
from typing import Annotated, Any, Literal, NamedTuple

from roughgas.base import InputError
from roughgas.base.fields import described, number
from roughgas.compiling.jit import jit, static
from roughgas.effects.settings import (
    LENGTH_RANGE,
    PERIOD_RANGE,
    Material,
    SceneContext,
    check_speed,
)
from roughgas.kernel.mathematics import TURN, sine_and_cosine

ROUNDING = 2.0**-52
MEETING, SEARCH_AGAIN = range(2)  # event codes: a meeting, or the continuation of the search
RISES = {"reversed_sawtooth": 0.1, "triangle": 0.5}  # shares of a period


Amplitude = Annotated[
    float,
    number(LENGTH_RANGE, "Height of a whole stroke, in a (2 A of a sine); 0 is a wall at rest."),
]
HalfStroke = Annotated[
    float,
    number(
        LENGTH_RANGE,
        "In place of an amplitude: half of a stroke, in a (A of a sine A sin 2 pi t/T), for "
        "floors and walls alike.",
    ),
]
Phase = Annotated[float, number("[0, 1)", "Share of a period that has passed at the start.")]


class Stroke(Material, frozen=True, kw_only=True):
    """Settings of a shaken surface."""

    amplitude: Amplitude | None = None
    half_stroke: HalfStroke | None = None
    period: Annotated[float, number(PERIOD_RANGE, "Time between strokes, in T.")]
    phase: Phase = 0.0


class Shaking(Stroke, frozen=True, kw_only=True):
    """Settings of a surface that is shaken along its normal."""

    wave: Annotated[
        Literal["sawtooth", "reversed_sawtooth", "triangle", "sine"],
        described(
            "Form of its motion; the sawtooth returns at once, the reversed one rises in a tenth "
            "of the period."
        ),
    ] = "sawtooth"


class PiecewiseLinear(NamedTuple):
    """Out and back, with a constant speed in each segment of the period."""

    amplitude: float  # height of a stroke, in a; 0 at rest
    period: float  # T
    ahead: float  # time since the beginning of a period, at time 0, in T
    shares: tuple[float, ...]  # of the period, before each segment begins
    levels: tuple[float, ...]  # of the surface at the beginning of each segment, in a
    speeds: tuple[float, ...]  # outwards, in a/T


class Sine(NamedTuple):
    """Out and back harmonically."""

    amplitude: float
    period: float
    ahead: float = 0.0


class Swing(NamedTuple):
    """To and fro about the middle, harmonically."""

    amplitude: float  # half a stroke
    period: float
    ahead: float = 0.0


Motion = PiecewiseLinear | Sine | Swing


def sawtooth(amplitude: float, period: float, ahead: float = 0.0) -> PiecewiseLinear:
    """Return the motion outwards at constant speed, with an instant return.

    `amplitude` is the height of a stroke in particle radii a, `period` is in T; `ahead` is the time
    in T since the beginning of a period, at time 0.
    """
    return PiecewiseLinear(amplitude, period, ahead, (0.0,), (0.0,), (amplitude / period,))


def triangle(amplitude: float, period: float, rise: float, ahead: float = 0.0) -> PiecewiseLinear:
    """Return the motion outwards during the share `rise` of the period, and back in the rest.

    `amplitude`, `period` and `ahead` are as in `sawtooth`.
    """
    speeds = amplitude / (rise * period), -amplitude / ((1.0 - rise) * period)
    return PiecewiseLinear(amplitude, period, ahead, (0.0, rise), (0.0, amplitude), speeds)


def half_stroke(
    context: SceneContext, settings: Stroke, share: float = 0.5, min_count: int = 1
) -> float:
    """Return half of a stroke of a shaken surface, in particle radii a; 0 if unset.

    It is the setting `half_stroke`, or a `share` of the setting `amplitude`. Raises InputError
    where both are set, or fewer than `min_count`, or the motion is too fast.
    """
    lengths = (settings.half_stroke, 1.0), (settings.amplitude, share)
    halves = [factor * length for length, factor in lengths if length is not None]
    if not min_count <= len(halves) <= 1:
        key, value = f"effects.{context.name}.half_stroke", halves[0] if halves else "(nothing)"
        raise InputError(key, value, "be given, or else amplitude, and not both")
    (half,) = halves or (0.0,)
    if half > 0.0:
        check_speed(context, half / share, settings.period)
    return half


def motion_of(half: float, settings: Shaking) -> PiecewiseLinear | Sine:
    """Return the motion of these settings with half of a stroke, `half`, in particle radii a."""
    amplitude, period, wave = 2.0 * half, settings.period, settings.wave
    ahead = settings.phase * period
    if wave == "sine":
        return Sine(amplitude, period, ahead)
    if wave in RISES:
        return triangle(amplitude, period, RISES[wave], ahead)
    return sawtooth(amplitude, period, ahead)


class Law(NamedTuple):
    """The jitted functions of a type of motion; `phase` is the time since the beginning of some
    period."""

    surface: Any
    """(motion, phase) -> (position of the surface, in a; its speed; further derivatives)"""
    meet: Any = None
    """(motion, gravity, height, speed, phase) -> (time, code): time of the meeting with a particle
    at `height`, rising at `speed`; inf if they never meet"""
    surface_speed: Any = None
    """(motion, code, phase) -> speed of the surface at a meeting with this code"""
    search: Any = None
    """As `meet`, with a time limit as last argument: (a later time, SEARCH_AGAIN) if they do not
    meet before. The limit is the next contact, for an expensive search: most particles collide
    first"""

    @property
    def has_limit(self) -> bool:
        """Whether the search may end at a limit before the meeting."""
        return self.search is not None


@static
def law_of(motion):
    """Return the Law, the compiled functions, of a motion; it may be the numba type of a motion."""
    return LAWS[getattr(motion, "instance_class", type(motion))]


@jit
def time_in_period(motion, time):
    """Return the time since the beginning of a period at an absolute time, in T."""
    return (time + motion.ahead) % motion.period


def displacement(motion, time):
    """Return the position of the surface at an absolute time (T), in particle radii a.

    It is relative to the lowest point, or the middle of a Swing.
    """
    return law_of(motion).surface(motion, time_in_period(motion, time))[0]


@jit
def fall_time(gap, speed, gravity):
    """Return the first root t >= 0 of gap + speed t - gravity t^2/2 = 0, without cancellation.

    It is the time of a particle's fall onto a surface: `gap` is its height above the surface,
    `speed` its velocity upwards, relative to it. A particle on the surface, or below it by
    rounding, is met at once if it approaches, else after its hop. Negative gravity pulls away from
    the surface. Returns inf if there is no meeting.
    """
    if gravity <= 0.0:
        square = speed * speed + 2.0 * gravity * gap
        if speed >= 0.0 or square < 0.0:
            return math.inf
        return 2.0 * max(gap, 0.0) / (math.sqrt(square) - speed)
    if gap <= 0.0:
        return 0.0 if speed < 0.0 else 2.0 * speed / gravity
    root = math.sqrt(speed * speed + 2.0 * gravity * gap)
    return 2.0 * gap / (root - speed) if speed < 0.0 else (speed + root) / gravity


@jit
def is_above(amplitude, gravity, height, speed, span):
    """Return whether a particle is above all strokes during a span of time (start, end).

    `amplitude` is the height of the strokes. `height` of the particle's lowest point and its upward
    `speed` hold at time 0. Under gravity it suffices that it is above at both ends; the result is
    False for negative gravity.
    """
    start, end = span
    first = height + speed * start - 0.5 * gravity * start * start
    last = height + speed * end - 0.5 * gravity * end * end
    return (gravity >= 0.0) & (min(first, last) > amplitude)


@jit
def time_below(amplitude, gravity, height, speed, time):
    """Return when a particle above all strokes at `time` returns to their height; inf if never.

    Returns `time` itself if it is not above. `amplitude` is the height of the strokes; height of
    the particle's lowest point and its upward speed hold at time 0. A long flight passes over
    millions of strokes.
    """
    above = height + speed * time - 0.5 * gravity * time * time - amplitude
    if above > 0.0:
        return time + fall_time(above, speed - gravity * time, gravity)
    return time


@jit
def time_to_piecewise(motion, gravity, height, speed, phase):
    """Return (time, segment) of a particle's meeting with a surface that moves piecewise linearly.

    The particle's lowest point is at `height`, rising at `speed`; phase is the time since the
    beginning of some period. Times in T, lengths in particle radii a; the time is inf if they never
    meet. At a turning point the segment is the earliest where the particle approaches.
    """
    number = _segment_at(motion, phase)
    back = time_below(motion.amplitude, gravity, height, speed, 0.0)
    while back < math.inf:
        number = max(number, _segment_at(motion, phase + back))
        segment = number % len(motion.shares)
        surface_speed = motion.speeds[segment]
        start, end = _segment_begin(motion, number), _segment_begin(motion, number + 1) - phase
        t = max(0.0, start - phase)
        surface = motion.levels[segment] + surface_speed * (phase + t - start)
        gap = height + speed * t - 0.5 * gravity * t * t - surface
        meeting = t + fall_time(gap, speed - gravity * t - surface_speed, gravity)
        if meeting <= end:
            return meeting, segment
        number += 1
        back = time_below(motion.amplitude, gravity, height, speed, end)
    return math.inf, MEETING


@jit
def _segment_at(motion, phase):
    """Return the number of the segment at a phase, counted on from period to period.

    `phase` is the time since the beginning of some period.
    """
    periods = phase / motion.period
    completed = math.floor(periods)
    number = len(motion.shares) * completed
    for k in range(1, len(motion.shares)):
        number += 1 if periods - completed > motion.shares[k] else 0
    return number


@jit
def _segment_begin(motion, number):
    """Return the phase at the beginning of segment `number`, counted on from period to period."""
    segments = len(motion.shares)
    return (number // segments + motion.shares[number % segments]) * motion.period


@jit
def _piecewise_surface(motion, phase):
    """Return the height of a piecewise linear surface and its speed, at a phase."""
    number = _segment_at(motion, phase)
    segment = number % len(motion.shares)
    speed = motion.speeds[segment]
    return motion.levels[segment] + speed * (phase - _segment_begin(motion, number)), speed


@jit
def _segment_speed(motion, segment, phase):
    """Return the outward speed of a piecewise linear surface in a segment, at any phase."""
    return motion.speeds[segment % len(motion.shares)]


@jit
def time_to_sine(motion, gravity, height, speed, phase):
    """Return (time, MEETING) for a particle and a surface that moves as a sine.

    The particle's lowest point is at `height`, rising at `speed`; phase is the time since the
    beginning of some period, or negative. Times in T, lengths in particle radii a; inf if they
    never meet.
    """
    return search_sine(motion, gravity, height, speed, phase, math.inf)


@jit
def search_sine(motion, gravity, height, speed, phase, limit):
    """Return (time, MEETING), or (a time after `limit`, SEARCH_AGAIN) if they do not meet before.

    The arguments are as in `time_to_sine`, and times count from the same instant. Let s be the
    surface's height, T its period, f the gap at the current time t, and b a bound of
    -f'' within the reach D of the next step. Then f(t + d) >= f + f' d - b d^2/2 for 0 <= d <= D,
    so that the step d to the root of this parabola cannot lead past a meeting. At first b = g + S,
    a bound at all times, with S the maximum acceleration of the surface. Steps shrink towards a
    meeting, so the reach of each is taken to be twice the last step: as the jerk is no more than 2
    pi S/T, f cannot fall faster than with b = g + s'' + 2 pi S D/(3 T), where s'' is the surface's
    acceleration. Such steps converge faster than Newton's, also where the surface only grazes the
    particle.
    """
    rate = TURN / motion.period
    peak = 0.5 * motion.amplitude * rate * rate
    # the gap changes by less than its rounding error in this time, for any motion of the surface
    max_acceleration = abs(gravity) + peak
    slack = math.sqrt(2.0 * ROUNDING * (motion.amplitude + abs(height)) / max_acceleration)
    time, reach = 0.0, motion.period  # long enough for the bound S of the acceleration
    while time < limit:
        surface, surface_speed, acceleration = sine_motion(motion, phase + time)
        gap = height + speed * time - 0.5 * gravity * time * time - surface
        relative = speed - gravity * time - surface_speed
        bound = gravity + min(peak, acceleration + peak * rate * reach / 3.0)
        step = fall_time(gap, relative, bound)
        if bound < gravity + peak:
            step = min(step, reach)
        if relative >= 0.0:
            step = max(step, slack)
        elif step <= ROUNDING * (motion.period + abs(phase) + time):
            return time + max(0.0, step), MEETING
        back = time_below(motion.amplitude, gravity, height, speed, time)
        step = max(step, back - time)
        reach = 2.0 * step
        time += step
    return time, SEARCH_AGAIN


@jit
def sine_motion(motion, phase):
    """Return (height, speed, acceleration) of a surface that moves as a sine, at a phase.

    In units of a and T; phase is the time since the beginning of some period.
    """
    rate = TURN / motion.period
    half = 0.5 * motion.amplitude
    sine, cosine = sine_and_cosine(phase / motion.period)
    return half * (1.0 - cosine), half * rate * sine, half * rate * rate * cosine


@jit
def _speed_of_sine(motion, code, phase):
    """Return the speed of a surface that moves as a sine, at a phase, for any event code."""
    return sine_motion(motion, phase)[1]


@jit
def _swing_surface(motion, phase):
    """Return the displacement of a surface from the middle of its swing, and its speed.

    `phase` is the time since the beginning of some period.
    """
    sine, cosine = sine_and_cosine(phase / motion.period)
    return motion.amplitude * sine, TURN * motion.amplitude / motion.period * cosine


LAWS = {
    PiecewiseLinear: Law(_piecewise_surface, time_to_piecewise, _segment_speed),
    Sine: Law(sine_motion, time_to_sine, _speed_of_sine, search_sine),
    Swing: Law(_swing_surface),
}
