"""A floor that shakes the gas: an asymmetric sawtooth, up at constant speed and back at once.

Its surface is at height V (t mod T), V = amplitude/T. While it rises it meets a falling particle at
a root of a quadratic; at the end of a stroke it is back at zero without having touched anything.
Floors of another wave form are in files of their own: each has its own way to be met.
"""

import math
from typing import NamedTuple

from roughgas.effects.settings import LENGTH, MATERIAL, TIME, Number, Word, check_speed, register
from roughgas.effects.sine_floor import SineFloor
from roughgas.effects.surface import bounce, fall, flight, phase, time_below
from roughgas.effects.triangular_floor import REVERSED_RISE, TriangularFloor
from roughgas.kernel.jit import jit

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
def predict(floor, index, state, scene, i):
    falling, time = flight(floor, index, state, scene, i)
    return time + time_to_floor(floor, *falling), 0


@jit
def time_to_floor(floor, gravity, height, speed, phase):
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
def resolve(floor, index, what, state, scene, i, time):
    return bounce(floor, index, state, scene, i, time, floor.amplitude / floor.period)


def displacement(floor, time):
    """Return the height of the surface at `time`, in a."""
    return floor.amplitude * (time % floor.period / floor.period)


register(
    Floor,
    SETTINGS,
    predict=predict,
    resolve=resolve,
    phase=phase,
    displacement=displacement,
    drives=True,
)
