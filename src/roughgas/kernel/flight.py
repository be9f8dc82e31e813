"""Free flight between events, with or without gravity."""

from roughgas.kernel import hooks
from roughgas.kernel.bodies import mass_of
from roughgas.kernel.images import fold_into_box, slid
from roughgas.kernel.jit import jit
from roughgas.kernel.unroll import unrolled
from roughgas.kernel.vectors import add_scaled, dot, read, subtract, subtract_last, write


@unrolled
def fallen(position, velocity, elapsed, gravity):
    """Return position and velocity after `elapsed`, falling along the last axis under gravity."""
    moved = add_scaled(position, velocity, elapsed)
    if gravity is None:
        return moved, velocity
    else:
        drop = 0.5 * gravity * elapsed * elapsed
        fall = gravity * elapsed
        return subtract_last(moved, drop), subtract_last(velocity, fall)


@jit
def path_of(trajectory, i, box):
    """Return particle i's path: position, velocity, and the time at which they hold."""
    return (
        read(trajectory, i, 0, box),
        read(trajectory, i, len(box), box),
        trajectory[i, 2 * len(box)],
    )


@jit
def along(path, time, gravity):
    """Return position and velocity at `time` on a path."""
    return fallen(path[0], path[1], time - path[2], gravity)


@jit
def whereabouts(state, scene, i, time):
    """Return position and velocity of particle i at `time`, on the continuation of its path."""
    path = path_of(state.trajectory, i, scene.box)
    return along(path, time, hooks.acceleration(scene.effects, None))


@jit
def arrive(state, scene, i, time):
    """Return position and velocity of particle i's image in the box at `time`."""
    position, velocity = whereabouts(state, scene, i, time)
    slide = hooks.sliding(scene.effects, None, state)
    return fold_into_box(position, velocity, scene.box, slid(slide, time))


@jit
def come_in(state, scene, i, time):
    """Do as `arrive`, and book the energy that particle i gains by becoming another image."""
    _, before = whereabouts(state, scene, i, time)
    position, velocity = arrive(state, scene, i, time)
    gained = subtract(velocity, before)
    work = dot(gained, add_scaled(before, gained, 0.5))
    hooks.transfer(scene.effects, None, state, mass_of(state.bodies, i) * work)
    return position, velocity


@jit
def put(state, scene, i, position, velocity, time):
    """Store particle i's trajectory."""
    write(state.trajectory, i, 0, position)
    write(state.trajectory, i, len(scene.box), velocity)
    state.trajectory[i, 2 * len(scene.box)] = time
