"""How walls are shaken, and when a particle meets one that is shaken along its normal.

T is the period. What is a height above a floor is a gap in front of a wall on any other side.

- Pieces: from its lowest point the surface goes at constant speeds, from one share of the period to
  the next. It meets a particle at a root of a quadratic: one that falls, and while it goes down
  itself also one that overtakes it. A sawtooth has one piece, A t/T: at its end it is back at zero
  without having touched anything. A triangle has two, and a reversed sawtooth, which rises in a
  tenth of its period: if it rose at once it would give every particle that it meets an infinite
  speed. A is the height of the stroke.
- Sine: it is at A (1 - cos 2 pi t/T)/2. When it meets a particle no formula says; the time is
  approached by steps that cannot lead past a meeting.
- Swing: about its middle, A sin 2 pi t/T; along the wall only.

Each is a type of its own, so that a kernel has the code of its own motion alone: `law_of`. A new
one is its fields, its functions and a line in LAWS.
"""

import math
from collections.abc import Mapping
from typing import Any, NamedTuple

from roughgas.base import InputError
from roughgas.compiling.jit import jit, of_types
from roughgas.effects.settings import LENGTH, TIME, Number, SceneContext, Word, check_speed
from roughgas.kernel.mathematics import TURN, sine_and_cosine

ROUNDING = 2.0**-52
MEET, LOOK = range(2)  # what comes next: the surface, or the search for when it does
RISES = {"reversed_sawtooth": 0.1, "triangle": 0.5}  # shares of a period
WAVES = ("sawtooth", *RISES, "sine")
STROKE = {  # of all that is shaken
    "amplitude": Number(
        "Height of a whole stroke, in a (2 A of a sine); 0 is a wall at rest.", LENGTH, math.inf
    ),
    "half_stroke": Number(
        "In place of an amplitude: half of a stroke, in a (A of a sine A sin 2 pi t/T), of "
        "whatever is shaken.",
        LENGTH,
        math.inf,
    ),
    "period": Number("Time between strokes, in T.", TIME),
    "phase": Number("Share of a period that has passed at the start.", "[0, 1)", 0.0),
}
SETTINGS = STROKE | {
    "wave": Word(
        "Form of its motion; the sawtooth returns at once, the reversed one rises in a tenth of "
        "the period.",
        WAVES,
    ),
}


class Pieces(NamedTuple):
    """Out and back in pieces of constant speed."""

    amplitude: float  # height of a stroke, in a; what is at rest has 0
    period: float  # T
    ahead: float  # T that have passed since a period began, at the start
    shares: tuple[float, ...]  # of a period that have passed when each piece begins
    levels: tuple[float, ...]  # where the surface is then, in a
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


Motion = Pieces | Sine | Swing


def sawtooth(amplitude: float, period: float, ahead: float = 0.0) -> Pieces:
    """Return the motion that goes out at constant speed, and back at once."""
    return Pieces(amplitude, period, ahead, (0.0,), (0.0,), (amplitude / period,))


def triangle(amplitude: float, period: float, rise: float, ahead: float = 0.0) -> Pieces:
    """Return the motion that goes out in this share of the period, and back in the rest of it."""
    speeds = amplitude / (rise * period), -amplitude / ((1.0 - rise) * period)
    return Pieces(amplitude, period, ahead, (0.0, rise), (0.0, amplitude), speeds)


def half_stroke(
    around: SceneContext, settings: Mapping[str, Any], share: float = 0.5, fewest: int = 1
) -> float:
    """Return half of a stroke, in a, which is a `share` of an amplitude; 0 if not given.

    Raises InputError where it is given twice, or less often than `fewest`, or the motion is too
    fast.
    """
    given = [x for x in (settings["half_stroke"], share * settings["amplitude"]) if x < math.inf]
    if not fewest <= len(given) <= 1:
        key, value = f"effects.{around.name}.half_stroke", given[0] if given else "(nothing)"
        raise InputError(key, value, "be given, or else amplitude, and not both")
    (half,) = given or (0.0,)
    check_speed(around, half / share, settings["period"])
    return half


def motion_of(half: float, settings: Mapping[str, Any]) -> Pieces | Sine:
    """Return the motion that settings describe; `half` of a stroke in a."""
    amplitude, period, wave = 2.0 * half, settings["period"], settings["wave"]
    ahead = settings["phase"] * period
    if wave == "sine":
        return Sine(amplitude, period, ahead)
    if wave in RISES:
        return triangle(amplitude, period, RISES[wave], ahead)
    return sawtooth(amplitude, period, ahead)


class Law(NamedTuple):
    """What a kind of motion does, in compiled functions; `phase` is the time since some period
    began."""

    at: Any
    """(motion, phase) -> (where the surface is, in a; its speed; perhaps more)"""
    meet: Any = None
    """(motion, gravity, height, speed, phase) -> (time, what): when it meets a particle that is at
    `height`, rising at `speed`; inf where they never meet"""
    met: Any = None
    """(motion, what, phase) -> the speed of the surface when it meets a particle so"""
    search: Any = None
    """As `meet`, with a limit as well: (a time beyond it, LOOK) where they do not meet before. The
    limit is the next contact, for a meeting that takes long to find: few particles get past it"""

    @property
    def waits(self) -> bool:
        """Whether the search may end before a meeting is found."""
        return self.search is not None


@of_types
def law_of(motion):
    """Return the Law of a motion, or of its type in numba."""
    return LAWS[getattr(motion, "instance_class", type(motion))]


@jit
def since_period_began(motion, time):
    """Return how long a period has lasted at an absolute time, in T."""
    return (time + motion.ahead) % motion.period


def displacement(motion, time):
    """Return where the surface is at an absolute time, in a."""
    return law_of(motion).at(motion, since_period_began(motion, time))[0]


@jit
def fall(gap, speed, gravity):
    """Return the first time at which gap + speed t - gravity t^2 / 2 = 0, without cancellation.

    What is on the surface, or below it by rounding, is met at once if it approaches, else after its
    hop. Where gravity pulls away from the surface it is negative; inf where there is no meeting.
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
    """Return whether a particle that gravity pulls back is above all strokes in a span of time.

    Then it is so at both ends. Height and speed are those at time 0.
    """
    start, end = span
    first = height + speed * start - 0.5 * gravity * start * start
    last = height + speed * end - 0.5 * gravity * end * end
    return (gravity >= 0.0) & (min(first, last) > amplitude)


@jit
def time_below(amplitude, gravity, height, speed, time):
    """Return when a particle that is above all strokes at `time` is back from there, else `time`.

    A long flight passes over millions of strokes. Height and speed are those at time 0. What never
    comes back does so at inf.
    """
    above = height + speed * time - 0.5 * gravity * time * time - amplitude
    if above > 0.0:
        return time + fall(above, speed - gravity * time, gravity)
    return time


@jit
def time_to_pieces(motion, gravity, height, speed, phase):
    """(time, piece): when a particle whose lowest point is at `height`, rising at `speed`, meets
    the surface, and on which piece of its motion.

    phase is the time since some period began. Times in T, lengths in a; inf where they never meet.
    At a turning point it is the earlier piece on which the particle approaches it.
    """
    number = _piece_at(motion, phase)
    back = time_below(motion.amplitude, gravity, height, speed, 0.0)
    while back < math.inf:
        number = max(number, _piece_at(motion, phase + back))
        piece = number % len(motion.shares)
        own_speed = motion.speeds[piece]
        start, end = _begin(motion, number), _begin(motion, number + 1) - phase
        begin = max(0.0, start - phase)
        surface = motion.levels[piece] + own_speed * (phase + begin - start)
        gap = height + speed * begin - 0.5 * gravity * begin * begin - surface
        meeting = begin + fall(gap, speed - gravity * begin - own_speed, gravity)
        if meeting <= end:
            return meeting, piece
        number += 1
        back = time_below(motion.amplitude, gravity, height, speed, end)
    return math.inf, MEET


@jit
def _piece_at(motion, phase):
    """Return the number of the piece at a time since some period began."""
    periods = phase / motion.period
    whole = math.floor(periods)
    number = len(motion.shares) * whole
    for k in range(1, len(motion.shares)):
        number += 1 if periods - whole > motion.shares[k] else 0
    return number


@jit
def _begin(motion, number):
    """Return when a piece begins."""
    pieces = len(motion.shares)
    return (number // pieces + motion.shares[number % pieces]) * motion.period


@jit
def _pieces_at(motion, phase):
    number = _piece_at(motion, phase)
    piece = number % len(motion.shares)
    speed = motion.speeds[piece]
    return motion.levels[piece] + speed * (phase - _begin(motion, number)), speed


@jit
def _speed_of_piece(motion, what, phase):
    return motion.speeds[what % len(motion.shares)]


@jit
def time_to_sine(motion, gravity, height, speed, phase):
    """Return (time, what): when a particle with its lowest point at `height`, rising at `speed`,
    meets it; inf where they never meet.

    phase is the time since some period began, negative before. Times in T, lengths in a.
    """
    return search_sine(motion, gravity, height, speed, phase, math.inf)


@jit
def search_sine(motion, gravity, height, speed, phase, limit):
    """Return (time, what): when they meet, or a later time than `limit` before which they do not.

    With f the gap at the time t that has been reached, b a bound of -f'' within the reach D of the
    next step, f(t + d) >= f + f' d - b d^2/2 for 0 <= d <= D: the step d to the root of that
    parabola cannot lead past a meeting. At once, b = g + S bounds it for ever, S being the
    largest acceleration. Steps shrink towards a meeting, so the reach of the next one is taken to
    be twice the last: as the jerk is no more than 2 pi S/T, f cannot fall faster than with
    b = g + s'' + 2 pi S D/(3 T), where s'' is the surface's acceleration. That makes the steps
    converge better than Newton's, and quickly even where the surface only grazes the particle.
    """
    rate = TURN / motion.period
    sharpest = 0.5 * motion.amplitude * rate * rate
    # within it the gap closes by a rounding, whatever the surface does
    most = abs(gravity) + sharpest
    slack = math.sqrt(2.0 * ROUNDING * (motion.amplitude + abs(height)) / most)
    time, reach = 0.0, motion.period  # so far that the acceleration may be any
    while time < limit:
        surface, surface_speed, acceleration = sine_motion(motion, phase + time)
        gap = height + speed * time - 0.5 * gravity * time * time - surface
        relative = speed - gravity * time - surface_speed
        bend = gravity + min(sharpest, acceleration + sharpest * rate * reach / 3.0)
        step = fall(gap, relative, bend)
        if bend < gravity + sharpest:
            step = min(step, reach)
        if relative >= 0.0:
            step = max(step, slack)
        elif step <= ROUNDING * (motion.period + abs(phase) + time):
            return time + max(0.0, step), MEET
        back = time_below(motion.amplitude, gravity, height, speed, time)
        step = max(step, back - time)
        reach = 2.0 * step
        time += step
    return time, LOOK


@jit
def sine_motion(motion, phase):
    """Return (height, speed, acceleration) of the surface."""
    rate = TURN / motion.period
    half = 0.5 * motion.amplitude
    sine, cosine = sine_and_cosine(phase / motion.period)
    return half * (1.0 - cosine), half * rate * sine, half * rate * rate * cosine


@jit
def _speed_of_sine(motion, what, phase):
    return sine_motion(motion, phase)[1]


@jit
def _swing_at(motion, phase):
    sine, cosine = sine_and_cosine(phase / motion.period)
    return motion.amplitude * sine, TURN * motion.amplitude / motion.period * cosine


LAWS = {
    Pieces: Law(_pieces_at, time_to_pieces, _speed_of_piece),
    Sine: Law(sine_motion, time_to_sine, _speed_of_sine, search_sine),
    Swing: Law(_swing_at),
}
