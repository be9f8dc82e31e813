"""Side walls that are shaken along themselves, so that they drive what their roughness grips.

They close the first axis and move along the last one as a sine, both alike. The surface of a wall
stays where it is: only the velocity that particles meet there changes.
"""

import math
from typing import NamedTuple

from roughgas.base import InputError
from roughgas.effects import walls
from roughgas.effects.settings import LENGTH, MATERIAL, TIME, Number, check_speed, register
from roughgas.kernel.contact import collide_with_wall
from roughgas.kernel.jit import jit
from roughgas.kernel.mathematics import TURN, sine_and_cosine
from roughgas.kernel.vectors import along_first, along_last

SETTINGS = {
    "amplitude": Number("Largest displacement from the middle, in a.", LENGTH),
    "period": Number("Period of the motion, in T.", TIME),
    **MATERIAL,
}


class ShakenWalls(NamedTuple):
    """Side walls that close the first axis, and are shaken along the last one as a sine."""

    width: float  # they are at 0 and at this place, in a
    speed: float  # the largest, in a/T
    period: float
    restitution: float
    roughness: float

    @classmethod
    def from_settings(cls, settings, around):
        """Return the effect; raise InputError beside walls at rest."""
        if "walls" in around.effects:
            raise InputError("effects", "walls and shaken_walls", "not close the same axis twice")
        amplitude, period, *material = settings.values()
        check_speed(around, amplitude, period)
        return cls(around.box[0], TURN * amplitude / period, period, *material)


@jit
def phase(shaken, index, base):
    """Return the time from the beginning of a period to the clock's base."""
    return base % shaken.period


@jit
def resolve(shaken, index, what, state, scene, i, time):
    normal = along_first(scene.box, 1.0 if what == walls.LEFT else -1.0)
    turns = (state.phase[index] + time) / shaken.period
    moving = along_last(scene.box, shaken.speed * sine_and_cosine(turns)[1])
    material = (shaken.restitution, shaken.roughness)
    return collide_with_wall(state, scene, index, i, time, material, normal, moving, 0.0)


def displacement(shaken, time):
    """Return how far the walls are from their middle at `time`, in a."""
    turn = TURN * (time % shaken.period) / shaken.period
    return shaken.speed * shaken.period / TURN * math.sin(turn)


register(
    ShakenWalls,
    SETTINGS,
    predict=walls.predict,
    resolve=resolve,
    phase=phase,
    displacement=displacement,
    drives=True,
    closes=True,
)
