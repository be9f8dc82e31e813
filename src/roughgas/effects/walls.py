"""Resting side walls that close the first axis, with a material of their own."""

import math
from typing import NamedTuple

from roughgas.effects.settings import MATERIAL, register
from roughgas.kernel.contact import collide_with_wall
from roughgas.kernel.jit import jit
from roughgas.kernel.particles import position_and_velocity, radius_of
from roughgas.kernel.vectors import along_first

LEFT, RIGHT = 0, 1


class Walls(NamedTuple):
    """Side walls at rest that close the first axis."""

    width: float  # they are at 0 and at this place, in a
    restitution: float
    roughness: float

    @classmethod
    def from_settings(cls, settings, around):
        """Return the effect, as wide as the box."""
        return cls(around.box[0], **settings)


@jit
def predict(walls, index, state, scene, i):
    time = state.trajectory[i, 2 * len(scene.box)]
    position, velocity = position_and_velocity(state, scene, i, time)
    speed, radius = velocity[0], radius_of(state.bodies, i)
    if speed < 0.0:
        return time + max(0.0, (position[0] - radius) / -speed), LEFT
    if speed > 0.0:
        return time + max(0.0, (walls.width - radius - position[0]) / speed), RIGHT
    return math.inf, LEFT


@jit
def resolve(walls, index, what, state, scene, i, time):
    normal = along_first(scene.box, 1.0 if what == LEFT else -1.0)
    material = (walls.restitution, walls.roughness)
    at_rest = along_first(scene.box, 0.0)
    return collide_with_wall(state, scene, index, i, time, material, normal, at_rest, 0.0)


register(Walls, MATERIAL, predict=predict, resolve=resolve, closes=True)
