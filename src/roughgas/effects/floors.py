"""Floors that shake the gas: how a particle falls onto one and leaves it, for each wave form.

A, the amplitude, is the height of a stroke, T its period; a stroke begins at the lowest point.

- Sawtooth: the surface is at height A (t mod T)/T. While it rises it meets a falling particle at a
  root of a quadratic; at the end of a stroke it is back at zero without having touched anything.
- Sine: it is at A (1 - cos 2 pi t/T)/2. When it meets a particle no formula says; the time is
  approached by steps that cannot lead past a meeting.
- Triangle, and sawtooth the other way round: while it rises it is at A t/(rise T), for the rest of
  the period at A (1 - t/T)/(1 - rise). It meets a particle at a root of a quadratic: one that
  falls, and while it goes down itself also one that overtakes it. The reversed sawtooth rises in a
  tenth of its period: a floor that rose at once would give every particle that it meets an infinite
  speed.
"""

import math
from typing import NamedTuple

from roughgas.effects.settings import LENGTH, MATERIAL, TIME, Number, Word, check_speed, register
from roughgas.kernel import hooks
from roughgas.kernel.contact import collide_with_wall
from roughgas.kernel.jit import jit
from roughgas.kernel.mathematics import TURN, sine_and_cosine
from roughgas.kernel.particles import radius_of
from roughgas.kernel.state import NOBODY, NOW
from roughgas.kernel.vectors import along_last

# Relative to the floor, a/T: any less, and a particle could hit it infinitely often in finite time
LEAST_DEPARTURE = 1e-3
ROUNDING = 2.0**-52
MEET, LOOK = range(2)  # what comes next: the floor, or the search for when it does
RISING, FALLING = 0, 1
REVERSED_RISE = 0.1  # of the reversed sawtooth's period
WAVES = ("sawtooth", "reversed_sawtooth", "triangle", "sine")
SETTINGS = {
    "amplitude": Number("Height of a stroke, in a; 0 is a floor at rest.", LENGTH),
    "period": Number("Time between strokes, in T.", TIME),
    "wave": Word(
        "Form of its motion; the sawtooth returns at once, the reversed one rises in a tenth of "
        "the period.",
        WAVES,
    ),
    **MATERIAL,
}


@jit
def phase(floor, index, base):
    """Return the time from the beginning of a period to the clock's base."""
    return base % floor.period


@jit
def flight(floor, index, state, scene, i):
    """Particle i's flight: (gravity, height of its lowest point, upward speed, the floor's phase),
    all when its path begins, and that time."""
    dimension = len(scene.box)
    time = state.trajectory[i, 2 * dimension]
    height = state.trajectory[i, dimension - 1] - radius_of(state.bodies, i)
    speed = state.trajectory[i, 2 * dimension - 1]
    gravity = hooks.acceleration(scene.effects)
    return (gravity, height, speed, state.phase[index] + time), time


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
def bounce_off_floor(floor, index, state, scene, i, time, speed):
    """Carry out particle i's contact with a floor that moves up at `speed`."""
    normal = along_last(scene.box, 1.0)
    moving = along_last(scene.box, speed)
    material = (floor.restitution, floor.roughness)
    return collide_with_wall(
        state, scene, index, i, time, material, normal, moving, LEAST_DEPARTURE
    )


class Floor(NamedTuple):
    """A shaken floor under a gas with gravity."""

    amplitude: float
    period: float
    restitution: float
    roughness: float

    @classmethod
    def from_settings(cls, settings, around):
        """Return the floor of the wave form that the settings name."""
        check_speed(around, settings["amplitude"], settings["period"])
        wave = settings.pop("wave")
        rises = {"triangle": 0.5, "reversed_sawtooth": REVERSED_RISE}
        if wave in rises:
            return TriangularFloor(rise=rises[wave], **settings)
        return (SineFloor if wave == "sine" else cls)(**settings)


@jit
def predict_sawtooth(floor, index, state, scene, i):
    falling, time = flight(floor, index, state, scene, i)
    return time + time_to_sawtooth(floor, *falling), 0


@jit
def time_to_sawtooth(floor, gravity, height, speed, phase):
    """Return when a particle with its lowest point at `height`, rising at `speed`, meets the floor.

    phase is the time since some stroke began. Times in T, lengths in a; inf where they never meet.
    """
    stroke = math.floor(phase / floor.period)
    floor_speed = floor.amplitude / floor.period
    back = time_below(floor.amplitude, gravity, height, speed, 0.0)
    while back < math.inf:
        stroke = max(stroke, math.floor((phase + back) / floor.period))
        begin = max(0.0, stroke * floor.period - phase)
        end = (stroke + 1.0) * floor.period - phase
        surface = floor_speed * (phase + begin - stroke * floor.period)
        gap = height + speed * begin - 0.5 * gravity * begin * begin - surface
        relative = speed - gravity * begin - floor_speed
        meeting = begin + fall(gap, relative, gravity)
        if meeting <= end:
            return meeting
        stroke += 1
        back = time_below(floor.amplitude, gravity, height, speed, end)
    return math.inf


@jit
def resolve_sawtooth(floor, index, what, state, scene, i, time):
    return bounce_off_floor(floor, index, state, scene, i, time, floor.amplitude / floor.period)


def height_of_sawtooth(floor, time):
    """Return the height of the surface at `time`, in a."""
    return floor.amplitude * (time % floor.period / floor.period)


class SineFloor(NamedTuple):
    """A floor under a gas with gravity, whose surface moves harmonically."""

    amplitude: float  # height of a stroke, in a; a floor at rest has 0
    period: float  # T
    restitution: float
    roughness: float


@jit
def predict_sine(floor, index, state, scene, i):
    """A particle above all strokes looks again when it is back from there: most collide before."""
    falling, time = flight(floor, index, state, scene, i)
    gravity, height, speed, _ = falling
    back = time + time_below(floor.amplitude, gravity, height, speed, 0.0)
    if back > state.clock[NOW]:
        return back, LOOK
    return time + time_to_sine(floor, *falling), MEET


@jit
def time_to_sine(floor, gravity, height, speed, phase):
    """Return when a particle with its lowest point at `height`, rising at `speed`, meets the floor.

    phase is the time since some period began, negative before. Times in T, lengths in a; inf where
    they never meet.

    With f the gap at the time t that has been reached, b a bound of -f'' within the reach D of the
    next step, f(t + d) >= f + f' d - b d^2/2 for 0 <= d <= D: the step d to the root of that
    parabola cannot lead past a meeting. At once, b = g + S bounds it for ever, S being the floor's
    largest acceleration. Steps shrink towards a meeting, so the reach of the next one is taken to
    be twice the last: as the jerk is no more than 2 pi S/T, f cannot fall faster than with
    b = g + s'' + 2 pi S D/(3 T), where s'' is the floor's acceleration. That makes the steps
    converge better than Newton's, and quickly even where the floor only grazes the particle.
    """
    rate = TURN / floor.period
    sharpest = 0.5 * floor.amplitude * rate * rate
    # within it the gap closes by a rounding, whatever the floor does
    most = abs(gravity) + sharpest
    slack = math.sqrt(2.0 * ROUNDING * (floor.amplitude + abs(height)) / most)
    time, reach = 0.0, floor.period  # so far that the floor's acceleration may be any
    while time < math.inf:
        surface, surface_speed, acceleration = sine_motion(floor, phase + time)
        gap = height + speed * time - 0.5 * gravity * time * time - surface
        relative = speed - gravity * time - surface_speed
        bend = gravity + min(sharpest, acceleration + sharpest * rate * reach / 3.0)
        step = _stays_above(gap, relative, bend)
        if bend < gravity + sharpest:
            step = min(step, reach)
        if relative >= 0.0:
            step = max(step, slack)
        elif step <= ROUNDING * (floor.period + abs(phase) + time):
            return time + max(0.0, step)
        back = time_below(floor.amplitude, gravity, height, speed, time)
        step = max(step, back - time)
        reach = 2.0 * step
        time += step
    return math.inf


@jit
def sine_motion(floor, phase):
    """Return (height, speed, acceleration) of the surface."""
    rate = TURN / floor.period
    half = 0.5 * floor.amplitude
    sine, cosine = sine_and_cosine(phase / floor.period)
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
def resolve_sine(floor, index, what, state, scene, i, time):
    if what == LOOK:
        return NOBODY
    _, speed, _ = sine_motion(floor, state.phase[index] + time)
    return bounce_off_floor(floor, index, state, scene, i, time, speed)


def height_of_sine(floor, time):
    """Return the height of the surface at `time`, in a."""
    turn = TURN * (time % floor.period / floor.period)
    return floor.amplitude * (1.0 - math.cos(turn)) / 2.0


class TriangularFloor(NamedTuple):
    """A floor under a gas with gravity, whose surface is piecewise linear in time."""

    amplitude: float  # height of a stroke, in a; a floor at rest has 0
    period: float  # T
    rise: float  # share of the period in which it rises
    restitution: float
    roughness: float


@jit
def predict_triangle(floor, index, state, scene, i):
    falling, time = flight(floor, index, state, scene, i)
    wait, piece = time_to_triangle(floor, *falling)
    return time + wait, piece


@jit
def time_to_triangle(floor, gravity, height, speed, phase):
    """(time, RISING or FALLING): when a particle whose lowest point is at `height`, rising at
    `speed`, meets the floor, and on which piece of its motion.

    phase is the time since some period began. Times in T, lengths in a; inf where they never meet.
    At a turning point it is the earlier piece on which the particle approaches the floor.
    """
    number = _piece_at(floor, phase)
    back = time_below(floor.amplitude, gravity, height, speed, 0.0)
    while back < math.inf:
        number = max(number, _piece_at(floor, phase + back))
        piece = number & 1
        floor_speed = speed_of_piece(floor, piece)
        start = _begin(floor, number) - phase
        end = _begin(floor, number + 1) - phase
        begin = max(0.0, start)
        level = floor.amplitude if piece == FALLING else 0.0
        gap = height + speed * begin - 0.5 * gravity * begin * begin
        gap -= level + floor_speed * (begin - start)
        meeting = begin + fall(gap, speed - gravity * begin - floor_speed, gravity)
        if meeting <= end:
            return meeting, piece
        number += 1
        back = time_below(floor.amplitude, gravity, height, speed, end)
    return math.inf, RISING


@jit
def speed_of_piece(floor, piece):
    """Return the upward speed of the surface on a piece of its motion."""
    if piece == RISING:
        return floor.amplitude / (floor.rise * floor.period)
    return -floor.amplitude / ((1.0 - floor.rise) * floor.period)


@jit
def _begin(floor, number):
    """Return when a piece begins; a period has two, and those of even number rise."""
    return (number // 2 + (number & 1) * floor.rise) * floor.period


@jit
def _piece_at(floor, phase):
    """Return the number of the piece at a time since some period began."""
    periods = phase / floor.period
    whole = math.floor(periods)
    return 2 * whole + (FALLING if periods - whole > floor.rise else RISING)


@jit
def resolve_triangle(floor, index, what, state, scene, i, time):
    return bounce_off_floor(floor, index, state, scene, i, time, speed_of_piece(floor, what))


def height_of_triangle(floor, time):
    """Return the height of the surface at `time`, in a."""
    done = time % floor.period / floor.period
    share = done / floor.rise if done < floor.rise else (1.0 - done) / (1.0 - floor.rise)
    return floor.amplitude * share


for _kind, _settings, _predict, _resolve, _height in (
    (Floor, SETTINGS, predict_sawtooth, resolve_sawtooth, height_of_sawtooth),
    (SineFloor, None, predict_sine, resolve_sine, height_of_sine),
    (TriangularFloor, None, predict_triangle, resolve_triangle, height_of_triangle),
):
    _hooks = {"predict": _predict, "resolve": _resolve, "displacement": _height}
    register(_kind, _settings, phase=phase, drives=True, **_hooks)
