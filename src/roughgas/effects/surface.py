"""What all shaken floors share: how a particle falls onto their surface, and leaves it."""

import math

from roughgas.kernel import hooks
from roughgas.kernel.contact import collide_with_wall
from roughgas.kernel.jit import jit
from roughgas.kernel.particles import radius_of
from roughgas.kernel.vectors import along_last

# Relative to the floor, a/T: any less, and a particle could hit it infinitely often in finite time
LEAST_DEPARTURE = 1e-3


@jit
def phase(floor, index, base):
    """Return the time from the beginning of a period to the clock's base."""
    return base % floor.period


@jit
def flight(floor, index, state, scene, i):
    """Particle i's flight: (gravity, height of its lowest point, upward speed, the floor's phase),
    all when its path begins, and that time."""
    dimension = len(scene.box)
    time = state.trajectory[i, 2 * dimension]
    height = state.trajectory[i, dimension - 1] - radius_of(state.bodies, i)
    speed = state.trajectory[i, 2 * dimension - 1]
    gravity = hooks.acceleration(scene.effects, None)
    return (gravity, height, speed, state.phase[index] + time), time


@jit
def fall(gap, speed, gravity):
    """Return the first time at which gap + speed t - gravity t^2 / 2 = 0, without cancellation.

    What is on the surface, or below it by rounding, is met at once if it approaches, else after its
    hop. Where gravity pulls away from the surface it is negative; inf where there is no meeting.
    """
    if gravity <= 0.0:
        return _drift(gap, speed, -gravity)
    if gap <= 0.0:
        return 0.0 if speed < 0.0 else 2.0 * speed / gravity
    root = math.sqrt(speed * speed + 2.0 * gravity * gap)
    return 2.0 * gap / (root - speed) if speed < 0.0 else (speed + root) / gravity


@jit
def _drift(gap, speed, lift):
    square = speed * speed - 2.0 * lift * gap
    if speed >= 0.0 or square < 0.0:
        return math.inf
    return 2.0 * max(gap, 0.0) / (math.sqrt(square) - speed)


@jit
def time_below(amplitude, gravity, height, speed, time):
    """Return when a particle that is above all strokes at `time` is back from there, else `time`.

    A long flight passes over millions of strokes. Height and speed are those at time 0. What never
    comes back does so at inf.
    """
    above = height + speed * time - 0.5 * gravity * time * time - amplitude
    if above > 0.0:
        return time + fall(above, speed - gravity * time, gravity)
    return time


@jit
def bounce(floor, index, state, scene, i, time, speed):
    """Carry out particle i's contact with a floor that moves up at `speed`."""
    normal = along_last(scene.box, 1.0)
    moving = along_last(scene.box, speed)
    material = (floor.restitution, floor.roughness)
    return collide_with_wall(
        state, scene, index, i, time, material, normal, moving, LEAST_DEPARTURE
    )
