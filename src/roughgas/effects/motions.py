"""How floors and walls are shaken, and when a particle meets one that comes towards it.

A, the amplitude, is the height of a stroke, T its period; a stroke begins at the lowest point. What
is a height above a floor is a gap in front of a piston.

- Sawtooth: the surface is at height A (t mod T)/T. While it rises it meets a falling particle at a
  root of a quadratic; at the end of a stroke it is back at zero without having touched anything.
- Sine: it is at A (1 - cos 2 pi t/T)/2. When it meets a particle no formula says; the time is
  approached by steps that cannot lead past a meeting.
- Triangle, and sawtooth the other way round: while it rises it is at A t/(rise T), for the rest of
  the period at A (1 - t/T)/(1 - rise). It meets a particle at a root of a quadratic: one that
  falls, and while it goes down itself also one that overtakes it. The reversed sawtooth rises in a
  tenth of its period: a floor that rose at once would give every particle that it meets an infinite
  speed.

Each is a type of its own, so that a kernel has the code of its own motion alone: `law_of`.
"""

import math
from typing import Any, NamedTuple

from roughgas.effects.settings import LENGTH, TIME, Number, SceneContext, Word, check_speed
from roughgas.kernel.jit import jit, of_types
from roughgas.kernel.mathematics import TURN, sine_and_cosine

ROUNDING = 2.0**-52
MEET, LOOK = range(2)  # what comes next: the surface, or the search for when it does
RISING, FALLING = 0, 1
REVERSED_RISE = 0.1  # of the reversed sawtooth's period
WAVES = ("sawtooth", "reversed_sawtooth", "triangle", "sine")
SETTINGS = {
    "amplitude": Number(
        "Height of a whole stroke, in a (2 A of a sine); 0 is a floor at rest.", LENGTH
    ),
    "period": Number("Time between strokes, in T.", TIME),
    "wave": Word(
        "Form of its motion; the sawtooth returns at once, the reversed one rises in a tenth of "
        "the period.",
        WAVES,
    ),
    "phase": Number("Share of a period that has passed at the start.", "[0, 1)", 0.0),
}


class Sawtooth(NamedTuple):
    """Out at constant speed, and back at once."""

    amplitude: float  # height of a stroke, in a; what is at rest has 0
    period: float  # T
    ahead: float = 0.0  # T that have passed since a period began, at the start


class Sine(NamedTuple):
    """Out and back harmonically."""

    amplitude: float
    period: float
    ahead: float = 0.0


class Triangle(NamedTuple):
    """Out and back at constant speeds."""

    amplitude: float
    period: float
    rise: float  # share of the period in which it goes out
    ahead: float = 0.0


def motion_of(
    around: SceneContext, amplitude: float, period: float, wave: str, phase: float
) -> Sawtooth | Sine | Triangle:
    """Return the motion that settings describe; raise InputError for one that is too fast."""
    check_speed(around, amplitude, period)
    ahead = phase * period if phase else 0.0  # the period may be infinite
    if wave == "sine":
        return Sine(amplitude, period, ahead)
    rises = {"triangle": 0.5, "reversed_sawtooth": REVERSED_RISE}
    if wave in rises:
        return Triangle(amplitude, period, rises[wave], ahead)
    return Sawtooth(amplitude, period, ahead)


@jit
def since_period_began(motion, time):
    """Return how long a period has lasted at an absolute time, in T."""
    return (time + motion.ahead) % motion.period


class Law(NamedTuple):
    """What a kind of motion does; all but `waits` and `height` is compiled."""

    meet: Any
    """(motion, gravity, height, speed, phase) -> (time, what): when it meets a particle that is at
    `height`, rising at `speed`, and `phase` of the motion is the time since some period began; inf
    where they never meet"""
    speed: Any
    """(motion, what, phase) -> the speed of the surface when it meets a particle so"""
    along: Any
    """(motion, phase) -> its speed if it is shaken along itself"""
    height: Any
    """(motion, time) -> height of the surface in a; in Python"""
    waits: bool = False
    """What flies above all strokes is looked at again when it is back: most collide before"""


@of_types
def law_of(motion):
    """Return the Law of a motion, or of its type in numba."""
    return LAWS[getattr(motion, "instance_class", type(motion))]


@jit
def fall(gap, speed, gravity):
    """Return the first time at which gap + speed t - gravity t^2 / 2 = 0, without cancellation.

    What is on the surface, or below it by rounding, is met at once if it approaches, else after its
    hop. Where gravity pulls away from the surface it is negative; inf where there is no meeting.
    """
    if gravity <= 0.0:
        return _drift(gap, speed, -gravity)
    if gap <= 0.0:
        return 0.0 if speed < 0.0 else 2.0 * speed / gravity
    root = math.sqrt(speed * speed + 2.0 * gravity * gap)
    return 2.0 * gap / (root - speed) if speed < 0.0 else (speed + root) / gravity


@jit
def _drift(gap, speed, lift):
    square = speed * speed - 2.0 * lift * gap
    if speed >= 0.0 or square < 0.0:
        return math.inf
    return 2.0 * max(gap, 0.0) / (math.sqrt(square) - speed)


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
def time_to_sawtooth(motion, gravity, height, speed, phase):
    """Return when a particle with its lowest point at `height`, rising at `speed`, meets it.

    phase is the time since some stroke began. Times in T, lengths in a; inf where they never meet.
    """
    stroke = math.floor(phase / motion.period)
    own_speed = motion.amplitude / motion.period
    back = time_below(motion.amplitude, gravity, height, speed, 0.0)
    while back < math.inf:
        stroke = max(stroke, math.floor((phase + back) / motion.period))
        begin = max(0.0, stroke * motion.period - phase)
        end = (stroke + 1.0) * motion.period - phase
        surface = own_speed * (phase + begin - stroke * motion.period)
        gap = height + speed * begin - 0.5 * gravity * begin * begin - surface
        relative = speed - gravity * begin - own_speed
        meeting = begin + fall(gap, relative, gravity)
        if meeting <= end:
            return meeting
        stroke += 1
        back = time_below(motion.amplitude, gravity, height, speed, end)
    return math.inf


@jit
def _meet_sawtooth(motion, gravity, height, speed, phase):
    return time_to_sawtooth(motion, gravity, height, speed, phase), MEET


@jit
def _speed_of_sawtooth(motion, what, phase):
    return motion.amplitude / motion.period


@jit
def _along_sawtooth(motion, phase):
    return motion.amplitude / motion.period


def height_of_sawtooth(motion, time):
    """Return the height of the surface at `time`, in a."""
    return motion.amplitude * (time % motion.period / motion.period)


@jit
def time_to_sine(motion, gravity, height, speed, phase):
    """Return when a particle with its lowest point at `height`, rising at `speed`, meets it.

    phase is the time since some period began, negative before. Times in T, lengths in a; inf where
    they never meet.

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
    while time < math.inf:
        surface, surface_speed, acceleration = sine_motion(motion, phase + time)
        gap = height + speed * time - 0.5 * gravity * time * time - surface
        relative = speed - gravity * time - surface_speed
        bend = gravity + min(sharpest, acceleration + sharpest * rate * reach / 3.0)
        step = _stays_above(gap, relative, bend)
        if bend < gravity + sharpest:
            step = min(step, reach)
        if relative >= 0.0:
            step = max(step, slack)
        elif step <= ROUNDING * (motion.period + abs(phase) + time):
            return time + max(0.0, step)
        back = time_below(motion.amplitude, gravity, height, speed, time)
        step = max(step, back - time)
        reach = 2.0 * step
        time += step
    return math.inf


@jit
def sine_motion(motion, phase):
    """Return (height, speed, acceleration) of the surface."""
    rate = TURN / motion.period
    half = 0.5 * motion.amplitude
    sine, cosine = sine_and_cosine(phase / motion.period)
    return half * (1.0 - cosine), half * rate * sine, half * rate * rate * cosine


@jit
def _stays_above(gap, speed, bend):
    """Return how long gap + speed t - bend t^2/2 >= 0 is certain; bend may be negative.

    A gap that is negative by rounding, and opens, is none.
    """
    if bend > 0.0:
        return fall(gap, speed, bend)
    square = speed * speed + 2.0 * bend * gap
    if speed >= 0.0 or square < 0.0:
        return math.inf
    return 2.0 * gap / (math.sqrt(square) - speed)


@jit
def _meet_sine(motion, gravity, height, speed, phase):
    return time_to_sine(motion, gravity, height, speed, phase), MEET


@jit
def _speed_of_sine(motion, what, phase):
    return sine_motion(motion, phase)[1]


@jit
def _along_sine(motion, phase):
    turns = phase / motion.period
    return 0.5 * TURN * motion.amplitude / motion.period * sine_and_cosine(turns)[0]


def height_of_sine(motion, time):
    """Return the height of the surface at `time`, in a."""
    turn = TURN * (time % motion.period / motion.period)
    return motion.amplitude * (1.0 - math.cos(turn)) / 2.0


@jit
def time_to_triangle(motion, gravity, height, speed, phase):
    """(time, RISING or FALLING): when a particle whose lowest point is at `height`, rising at
    `speed`, meets it, and on which piece of its motion.

    phase is the time since some period began. Times in T, lengths in a; inf where they never meet.
    At a turning point it is the earlier piece on which the particle approaches it.
    """
    number = _piece_at(motion, phase)
    back = time_below(motion.amplitude, gravity, height, speed, 0.0)
    while back < math.inf:
        number = max(number, _piece_at(motion, phase + back))
        piece = number & 1
        own_speed = speed_of_piece(motion, piece)
        start = _begin(motion, number) - phase
        end = _begin(motion, number + 1) - phase
        begin = max(0.0, start)
        level = motion.amplitude if piece == FALLING else 0.0
        gap = height + speed * begin - 0.5 * gravity * begin * begin
        gap -= level + own_speed * (begin - start)
        meeting = begin + fall(gap, speed - gravity * begin - own_speed, gravity)
        if meeting <= end:
            return meeting, piece
        number += 1
        back = time_below(motion.amplitude, gravity, height, speed, end)
    return math.inf, RISING


@jit
def speed_of_piece(motion, piece):
    """Return the upward speed of the surface on a piece of its motion."""
    if piece == RISING:
        return motion.amplitude / (motion.rise * motion.period)
    return -motion.amplitude / ((1.0 - motion.rise) * motion.period)


@jit
def _begin(motion, number):
    """Return when a piece begins; a period has two, and those of even number rise."""
    return (number // 2 + (number & 1) * motion.rise) * motion.period


@jit
def _piece_at(motion, phase):
    """Return the number of the piece at a time since some period began."""
    periods = phase / motion.period
    whole = math.floor(periods)
    return 2 * whole + (FALLING if periods - whole > motion.rise else RISING)


@jit
def _speed_of_triangle(motion, what, phase):
    return speed_of_piece(motion, what)


@jit
def _along_triangle(motion, phase):
    return speed_of_piece(motion, _piece_at(motion, phase) & 1)


def height_of_triangle(motion, time):
    """Return the height of the surface at `time`, in a."""
    done = time % motion.period / motion.period
    share = done / motion.rise if done < motion.rise else (1.0 - done) / (1.0 - motion.rise)
    return motion.amplitude * share


LAWS = {
    Sawtooth: Law(_meet_sawtooth, _speed_of_sawtooth, _along_sawtooth, height_of_sawtooth),
    Sine: Law(_meet_sine, _speed_of_sine, _along_sine, height_of_sine, waits=True),
    Triangle: Law(time_to_triangle, _speed_of_triangle, _along_triangle, height_of_triangle),
}
