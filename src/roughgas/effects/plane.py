"""What walls on single sides of the box share: where they are, and how a particle meets them."""

from typing import NamedTuple

from roughgas.effects.surface import fall
from roughgas.kernel import hooks
from roughgas.kernel.contact import collide_with_wall
from roughgas.kernel.hooks import either
from roughgas.kernel.jit import jit
from roughgas.kernel.particles import radius_of
from roughgas.kernel.vectors import along_axis


class Place(NamedTuple):
    """Which plane a wall is; one that is shaken along its normal, when it is farthest out."""

    axis: int
    inwards: float  # component of its normal into the gas, 1 or -1
    at: float  # in a
    along: int  # axis along which it moves


normal_axis = property(lambda wall: wall.place.axis, doc="The axis that a wall closes.")


@jit
def approach(place, state, scene, i):
    """Particle i's way to the plane: (acceleration towards it, gap, speed away from it), all when
    its path begins, and that time."""
    dimension = len(scene.box)
    time = state.trajectory[i, 2 * dimension]
    position = state.trajectory[i, place.axis]
    speed = place.inwards * state.trajectory[i, dimension + place.axis]
    gap = place.inwards * (position - place.at) - radius_of(state.bodies, i)
    return (pull(hooks.acceleration(scene.effects, None), place, dimension), gap, speed), time


def _pull(gravity, place, dimension):
    return place.inwards * gravity if place.axis == dimension - 1 else 0.0


pull = either(_pull, lambda gravity, place, dimension: 0.0)


@jit
def predict(wall, index, state, scene, i):
    (gravity, gap, speed), time = approach(wall.place, state, scene, i)
    return time + fall(gap, speed, gravity), 0


@jit
def bounce(wall, index, state, scene, i, time, axis, velocity, least_departure):
    """Carry out particle i's contact with a wall that moves along an axis at `velocity`."""
    normal = along_axis(scene.box, wall.place.axis, wall.place.inwards)
    moving = along_axis(scene.box, axis, velocity)
    material = (wall.restitution, wall.roughness)
    return collide_with_wall(
        state, scene, index, i, time, material, normal, moving, least_departure
    )
