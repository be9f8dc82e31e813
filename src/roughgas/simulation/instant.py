"""Where the particles of a gas are at the present instant, between the kernel's events."""

import numpy as np

from roughgas.kernel.hooks import displacement
from roughgas.kernel.state import NOW, State
from roughgas.scene import Scene


def in_order(state: State, values: np.ndarray) -> np.ndarray:
    """Return a copy of `values` (N, ...), one of each particle, in the order of the start."""
    ordered = np.empty_like(values)
    ordered[state.label] = values
    return ordered


def whereabouts(state: State, scene: Scene, time: float) -> tuple[np.ndarray, np.ndarray]:
    """Return positions in a, folded into the box, and velocities now, (N, D) each.

    `time` is the present in T. Velocities are those of the images in the box, in the kernel's unit:
    2^exponent a/T. The order is that of the state's arrays.
    """
    dimension, gravity, shear = len(scene.box), scene.effects.gravity, scene.effects.shear
    elapsed = state.clock[NOW] - state.trajectory[:, -1]
    velocity = state.trajectory[:, dimension:-1].copy()
    position = state.trajectory[:, :dimension] + velocity * elapsed[:, None]
    if gravity is not None:
        position[:, -1] -= 0.5 * gravity.acceleration * elapsed**2
        velocity[:, -1] -= gravity.acceleration * elapsed
    if shear is not None:
        images = np.floor(position[:, 1] / scene.box[1])
        position[:, 0] -= displacement(shear, time) * images
        velocity[:, 0] -= shear.velocity * images
    for axis, length in enumerate(scene.box):
        if length is not None:
            position[:, axis] %= length
    return position, velocity
