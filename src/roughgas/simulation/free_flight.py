"""Positions and velocities after free flight, folded into the box or unwrapped; angles of disks.

Positions are in particle radii a. `flights` are the kernel's state or its copies at k instants;
[k,] is an axis that only the latter have. The order of the start is the particles' initial order,
and the order of memory the order of rows in the kernel's arrays, which changes during a run.

The kernel stores the path of a particle from its last event on. With the effect `paths` it counts,
up to that event, the net crossings of the box and the rotation of disks (see
roughgas.effects.paths). The flight since then is added here, so that unwrapped positions and angles
are exact at any instant, for any distance between instants.
"""

import numpy as np

from roughgas.kernel.hooks import displacement
from roughgas.kernel.record import RawFrames
from roughgas.kernel.state import NOW, State
from roughgas.scene import Scene

Flights = State | RawFrames
"""Flights since the last events: at the present instant, or at k instants, with a leading axis
k."""


def is_in_starting_order(flights: Flights) -> bool:
    """Return whether rows are in the order of the start, as always for few particles."""
    return bool((flights.label == np.arange(flights.label.shape[-1])).all())


def in_starting_order(flights: Flights, values: np.ndarray) -> np.ndarray:
    """Return a copy of `values` ([k,] N, ...) with the particles' rows in the order of the start.

    `values` are in the order of memory.
    """
    label = flights.label
    if is_in_starting_order(flights):
        return values.copy()
    instants = (np.arange(len(label))[:, None],) if label.ndim > 1 else ()
    ordered = np.empty_like(values)
    ordered[(*instants, label)] = values
    return ordered


def unfolded_positions_and_velocities(
    flights: Flights, scene: Scene
) -> tuple[np.ndarray, np.ndarray]:
    """Return positions in a, not folded into the box, and velocities, ([k,] N, D) each.

    Velocities are in the kernel's unit, 2^exponent a/T. The order is the order of memory.
    """
    dimension, gravity = len(scene.box), scene.effects.gravity
    elapsed = _elapsed(flights)
    velocity = flights.trajectory[..., dimension:-1].copy()
    position = np.empty_like(velocity)
    for axis in range(dimension):  # numpy is slow where the last axis is short
        flight = velocity[..., axis] * elapsed
        position[..., axis] = flights.trajectory[..., axis] + flight
    if gravity is not None:
        for axis, acceleration in gravity.along.items():
            position[..., axis] += 0.5 * acceleration * elapsed**2
            velocity[..., axis] += acceleration * elapsed
    return position, velocity


def _elapsed(flights):
    """Return the times ([k,] N) since the last events, in the kernel's unit T/2^exponent."""
    return flights.clock[..., NOW, None] - flights.trajectory[..., -1]


def fold_positions(
    position: np.ndarray, velocity: np.ndarray, scene: Scene, times: np.ndarray
) -> None:
    """Fold positions into the box, and change velocities accordingly, in place.

    Both are (k, N, D), positions in a. Velocities then refer to the images in the box, which slide
    in a sheared gas with `times` (k,) in T; the kernel's unit of velocity is then 1 a/T.
    """
    shear = scene.effects.shear
    if shear is not None:
        shift = np.array([displacement(shear, time) for time in times.tolist()], float)
        images = np.floor(position[..., 1] / scene.box[1])
        position[..., 0] -= shift[:, None] * images
        velocity[..., 0] -= shear.velocity * images
    for axis, length in enumerate(scene.box):
        if length is not None:
            coordinate = position[..., axis]
            outside = ~((coordinate > 0.0) & (coordinate < length))
            # few particles; a remainder is slow
            np.remainder(coordinate, length, out=coordinate, where=outside)


def positions_and_velocities(
    state: State, scene: Scene, time: float
) -> tuple[np.ndarray, np.ndarray]:
    """Return present positions in a, folded into the box, and velocities, (N, D) each.

    `time` is the present in T. Velocities refer to the images in the box, in the kernel's unit
    2^exponent a/T. The order is the order of the state's arrays.
    """
    position, velocity = unfolded_positions_and_velocities(state, scene)
    fold_positions(position[None], velocity[None], scene, np.array([time]))
    return position, velocity


def unwrapped_positions(state: State, scene: Scene) -> np.ndarray | None:
    """Return unwrapped positions (N, D) in a, in the order of the start.

    Unwrapped positions do not jump at the boundaries of a periodic box: their differences between
    two instants are displacements. Positions along a shear flow are NaN. None without the effect
    `paths`.
    """
    if state.paths is None:
        return None
    position, _ = unfolded_positions_and_velocities(state, scene)
    return unwrapped(in_starting_order(state, position), state.paths.crossings, scene)


def unwrapped(position: np.ndarray, crossings: np.ndarray, scene: Scene) -> np.ndarray:
    """Return unwrapped positions from unfolded ones and net crossings of the box, in a.

    `crossings` are in periods of the box along each axis. All arrays are ([k,] N, D), in the order
    of the start.
    """
    unwrapped_position = position.copy()
    for axis, length in enumerate(scene.box):
        if length is not None:
            unwrapped_position[..., axis] += crossings[..., axis] * length
    if scene.effects.shear is not None:
        unwrapped_position[..., 0] = np.nan
    return unwrapped_position


def rotations(state: State) -> np.ndarray | None:
    """Return the rotation angles (N,) of disks since the start, in rad, anticlockwise.

    They are in the order of the start. None without the effect `paths`, or without spinning disks.
    """
    if state.paths is None or state.paths.rotation is None:
        return None
    return state.paths.rotation + _turned_since_last_event(state)


def turned_since_events(flights: Flights, radius: np.ndarray) -> np.ndarray:
    """Return the rotation angles ([k,] N) of disks from their last events to the frame, in rad.

    `flights` has the free flights at k instants, or at a single instant without the axis k.
    `radius` (N,) and the angles are in the order that particles had at the start of the run.
    """
    assert flights.spin is not None  # of disks that spin
    turning = flights.spin[..., 0] / radius[flights.label]
    return in_starting_order(flights, turning * _elapsed(flights))


def _turned_since_last_event(state):
    """Return the rotation angles (N,) of disks from their last events to the present, in rad.

    They are in the order of the start.
    """
    bodies = state.bodies
    radius = (
        np.ones(len(state.label)) if bodies is None else in_starting_order(state, bodies.radius)
    )
    return turned_since_events(state, radius)


def begin_paths(state: State) -> None:
    """Make the kernel's `state` count rotations from the present instant on, in place.

    The state comes from a kernel's memory, with counts of zero. Flights that began earlier count
    only from now on.
    """
    if state.paths is not None and state.paths.rotation is not None:
        state.paths.rotation[:] = -_turned_since_last_event(state)


def end_flights(state: State, position: np.ndarray, landing: np.ndarray, scene: Scene) -> None:
    """Add the flights of all particles up to the present instant to the counts of `state.paths`.

    `landing` and `position` are (N, D) in a, before and after folding into the box, in the order of
    the state's arrays. Needed if Python moves particles; the kernel counts its own flights. Without
    the effect `paths` nothing happens.
    """
    if state.paths is None:
        return
    for axis, length in enumerate(scene.box):
        if length is not None:
            crossings = np.rint((landing - position)[:, axis] / length)
            state.paths.crossings[state.label, axis] += crossings
    if state.paths.rotation is not None:
        state.paths.rotation[:] += _turned_since_last_event(state)
