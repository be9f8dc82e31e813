"""A floor that shakes the gas: an asymmetric sawtooth, up at constant speed and back at once.

Its surface is at height V (t mod T), V = amplitude/T. While it rises it meets a falling particle at
a root of a quadratic; at the end of a stroke it is back at zero without having touched anything.
"""

import math
from typing import NamedTuple

from roughgas.effects.settings import MATERIAL, Number, read
from roughgas.kernel import hooks
from roughgas.kernel.contact import collide_with_wall
from roughgas.kernel.jit import jit
from roughgas.kernel.vectors import along_last

# Below it a floor that takes energy would be hit infinitely often in a finite time (a/T)
LEAST_DEPARTURE = 1e-3


SETTINGS = {
    "amplitude": Number("Height of a stroke, in a; 0 is a floor at rest.", "[0, inf)"),
    "period": Number("Time between strokes, in T."),
    **MATERIAL,
}
DRIVES = True


class Floor(NamedTuple):
    """A floor under a gas with gravity."""

    amplitude: float
    period: float
    restitution: float
    roughness: float
    least_departure: float  # a particle leaves at no less than this speed, relative to the floor

    @classmethod
    def from_settings(cls, settings, around):
        """The effect; raises InputError for illegal parameters."""
        return cls(**read(SETTINGS, "floor", settings, around), least_departure=LEAST_DEPARTURE)


@jit
def phase(floor, index, base):
    """Time since the stroke began at which the clock's base lies."""
    return base % floor.period


@jit
def predict(floor, index, state, scene, i):
    dimension = len(scene.box)
    time = state.trajectory[i, 2 * dimension]
    gap = state.trajectory[i, dimension - 1] - 1.0
    speed = state.trajectory[i, 2 * dimension - 1]
    gravity = hooks.acceleration(scene.effects, None)
    return time + time_to_floor(floor, gravity, gap, speed, state.phase[index] + time), 0


@jit
def time_to_floor(floor, gravity, height, speed, phase):
    """Time until a particle whose lowest point is at `height`, rising at `speed`, meets the floor.

    phase is the time since some stroke began; gravity > 0. Times in T, lengths in a.
    """
    stroke = _stroke_to_meet(floor, gravity, height, speed, phase, 0.0)
    floor_speed = floor.amplitude / floor.period
    while True:
        begin = max(0.0, stroke * floor.period - phase)
        end = (stroke + 1.0) * floor.period - phase
        surface = floor_speed * (phase + begin - stroke * floor.period)
        gap = height + speed * begin - 0.5 * gravity * begin * begin - surface
        relative = speed - gravity * begin - floor_speed
        meeting = begin + _fall(gap, relative, gravity)
        if meeting <= end:
            return meeting
        stroke = max(stroke + 1.0, _stroke_to_meet(floor, gravity, height, speed, phase, end))


@jit
def _stroke_to_meet(floor, gravity, height, speed, phase, time):
    """The stroke under way at `time`; of a particle above all strokes, when it is back from there.

    A long flight passes over millions of strokes.
    """
    above = height + speed * time - 0.5 * gravity * time * time - floor.amplitude
    if above > 0.0:
        time += _fall(above, speed - gravity * time, gravity)
    return math.floor((phase + time) / floor.period)


@jit
def _fall(gap, speed, gravity):
    """First time at which gap + speed t - gravity t^2 / 2 = 0, without cancellation."""
    if gap <= 0.0:
        return 0.0 if speed < 0.0 else 2.0 * speed / gravity
    root = math.sqrt(speed * speed + 2.0 * gravity * gap)
    return 2.0 * gap / (root - speed) if speed < 0.0 else (speed + root) / gravity


@jit
def resolve(floor, index, what, state, scene, i, time):
    normal = along_last(scene.box, 1.0)
    moving = along_last(scene.box, floor.amplitude / floor.period)
    material = (floor.restitution, floor.roughness)
    return collide_with_wall(
        state, scene, index, i, time, material, normal, moving, floor.least_departure
    )
