"""A floor that shakes the gas as a sine does: its surface is at A (1 - cos 2 pi t/T)/2.

So it starts at its lowest point, and A, the amplitude, is the height of its stroke as that of the
other wave forms. When it meets a particle no formula says; the time is approached by steps that
cannot lead past a meeting.
"""

import math
from typing import NamedTuple

from roughgas.effects.settings import register
from roughgas.effects.surface import bounce, fall, flight, phase, time_below
from roughgas.kernel.jit import jit
from roughgas.kernel.mathematics import TURN, sine_and_cosine
from roughgas.kernel.state import NOBODY, NOW

ROUNDING = 2.0**-52
MEET, LOOK = range(2)  # what comes next: the floor, or the search for when it does


class SineFloor(NamedTuple):
    """A floor under a gas with gravity, whose surface moves harmonically."""

    amplitude: float  # height of a stroke, in a; a floor at rest has 0
    period: float  # T
    restitution: float
    roughness: float


@jit
def predict(floor, index, state, scene, i):
    """A particle above all strokes looks again when it is back from there: most collide before."""
    falling, time = flight(floor, index, state, scene, i)
    gravity, height, speed, _ = falling
    back = time + time_below(floor.amplitude, gravity, height, speed, 0.0)
    if back > state.clock[NOW]:
        return back, LOOK
    return time + time_to_floor(floor, *falling), MEET


@jit
def time_to_floor(floor, gravity, height, speed, phase):
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
        surface, surface_speed, acceleration = motion(floor, phase + time)
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
def motion(floor, phase):
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
def resolve(floor, index, what, state, scene, i, time):
    if what == LOOK:
        return NOBODY
    _, speed, _ = motion(floor, state.phase[index] + time)
    return bounce(floor, index, state, scene, i, time, speed)


def displacement(floor, time):
    """Return the height of the surface at `time`, in a."""
    turn = TURN * (time % floor.period / floor.period)
    return floor.amplitude * (1.0 - math.cos(turn)) / 2.0


register(
    SineFloor, predict=predict, resolve=resolve, phase=phase, displacement=displacement, drives=True
)
