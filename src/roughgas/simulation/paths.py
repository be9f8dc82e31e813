"""Free flight to the present instant, and the paths of particles through periodic boundaries.

The kernel keeps each particle's path as of its last event. With the effect `paths` it counts, up to
that event, the net crossings of the box and the rotation of disks (see roughgas.effects.paths): the
flight since then is added here, so that unwrapped positions and angles are exact at any instant,
however far apart the instants are.
"""

import numpy as np

from roughgas.kernel.state import NOW, State
from roughgas.scene import Scene


def in_order(state: State, values: np.ndarray) -> np.ndarray:
    """Return a copy of `values` (N, ...), a row for each particle, in the order of the start."""
    ordered = np.empty_like(values)
    ordered[state.label] = values
    return ordered


def flown(state: State, scene: Scene) -> tuple[np.ndarray, np.ndarray]:
    """Return positions in a and velocities at the present instant, (N, D) each, not folded.

    Velocities are in the kernel's unit, 2^exponent a/T. The order is that of the state's arrays.
    """
    dimension, gravity = len(scene.box), scene.effects.gravity
    elapsed = state.clock[NOW] - state.trajectory[:, -1]
    velocity = state.trajectory[:, dimension:-1].copy()
    position = state.trajectory[:, :dimension] + velocity * elapsed[:, None]
    if gravity is not None:
        position[:, -1] -= 0.5 * gravity.acceleration * elapsed**2
        velocity[:, -1] -= gravity.acceleration * elapsed
    return position, velocity


def unwrapped_positions(state: State, scene: Scene) -> np.ndarray | None:
    """Return positions (N, D) in a along continuous paths, in the order of the start.

    Differences of two instants are displacements. Along the flow of a sheared gas positions are
    NaN. None without the effect `paths`.
    """
    if state.paths is None:
        return None
    position, _ = flown(state, scene)
    unwrapped = in_order(state, position)
    for axis, length in enumerate(scene.box):
        if length is not None:
            unwrapped[:, axis] += state.paths.crossings[:, axis] * length
    if scene.effects.shear is not None:
        unwrapped[:, 0] = np.nan
    return unwrapped


def rotations(state: State) -> np.ndarray | None:
    """Return the angles (N,) in rad by which disks have turned since the start, anticlockwise.

    The order is that of the start. None without the effect `paths`, and unless disks spin.
    """
    if state.paths is None or state.paths.rotation is None:
        return None
    return state.paths.rotation + in_order(state, _turned_since_event(state))


def _turned_since_event(state):
    """Return the angles (N,) by which disks have turned since their last events."""
    radius = 1.0 if state.bodies is None else state.bodies.radius
    return state.spin[:, 0] / radius * (state.clock[NOW] - state.trajectory[:, -1])


def begin_paths(state: State) -> None:
    """Let rotations count from the present instant on, where flights are under way.

    For a state from a kernel's memory, in which counts are zero and flights have begun before.
    """
    if state.paths is not None and state.paths.rotation is not None:
        state.paths.rotation[state.label] = -_turned_since_event(state)


def end_flights(state: State, position: np.ndarray, landing: np.ndarray, scene: Scene) -> None:
    """Count the flights that end at the present instant, of all particles.

    `landing` and `position` are (N, D), before and after folding into the box, in the order of the
    state's arrays. For changes that Python makes to a state; the kernel counts its own.
    """
    if state.paths is None:
        return
    for axis, length in enumerate(scene.box):
        if length is not None:
            crossings = np.rint((landing - position)[:, axis] / length)
            state.paths.crossings[state.label, axis] += crossings
    if state.paths.rotation is not None:
        state.paths.rotation[state.label] += _turned_since_event(state)
