"""A floor that rises and falls at constant speeds: a triangle, or a sawtooth the other way round.

While it rises its surface is at A t/(rise T), and for the rest of the period at
A (1 - t/T)/(1 - rise), with A the amplitude and T the period. It meets a particle at a root of a
quadratic: one that falls, and while it goes down itself also one that overtakes it.

The reversed sawtooth rises in a tenth of its period: a floor that rose at once would give every
particle that it meets an infinite speed.
"""

import math
from typing import NamedTuple

from roughgas.effects.settings import register
from roughgas.effects.surface import bounce, fall, flight, phase, time_below
from roughgas.kernel.jit import jit

REVERSED_RISE = 0.1  # of the reversed sawtooth's period
RISING, FALLING = 0, 1


class TriangularFloor(NamedTuple):
    """A floor under a gas with gravity, whose surface is piecewise linear in time."""

    amplitude: float  # height of a stroke, in a; a floor at rest has 0
    period: float  # T
    rise: float  # share of the period in which it rises
    restitution: float
    roughness: float


@jit
def predict(floor, index, state, scene, i):
    falling, time = flight(floor, index, state, scene, i)
    wait, piece = time_to_floor(floor, *falling)
    return time + wait, piece


@jit
def time_to_floor(floor, gravity, height, speed, phase):
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
        floor_speed = speed_of(floor, piece)
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
def speed_of(floor, piece):
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
def resolve(floor, index, what, state, scene, i, time):
    return bounce(floor, index, state, scene, i, time, speed_of(floor, what))


def displacement(floor, time):
    """Return the height of the surface at `time`, in a."""
    done = time % floor.period / floor.period
    share = done / floor.rise if done < floor.rise else (1.0 - done) / (1.0 - floor.rise)
    return floor.amplitude * share


register(
    TriangularFloor,
    predict=predict,
    resolve=resolve,
    phase=phase,
    displacement=displacement,
    drives=True,
)
