"""Violations of conservation laws and bounds of a gas, measured on its snapshots."""

import numpy as np
from brute_force.comparison import brute_force_from


def gain_of_momentum(before, after, world):
    """Change of the momentum relative to the mean flow, over the sum of all speeds.

    A particle that becomes another image loses U at the height L: v_x - U y/L stays.
    """
    drifts, mass = [], 1.0 if before.bodies is None else before.bodies.mass[:, None]
    for shot in (before, after):
        v = shot.velocity.copy()
        if world.shear:
            v[:, 0] -= world.shear * shot.position[:, 1] / world.box[1]
        drifts.append((mass * v).sum(axis=0))
    # positions are rounded on the scale of the box, velocities of crossings on the scale of U
    size = world.shear * (1.0 + world.shear * after.time / 7.0) * np.max(mass)
    size += np.abs(mass * after.velocity).sum()
    return np.abs(drifts[1] - drifts[0]).max() / size


def beyond_cone(before, after, pair, world):
    """(|J_t| - mu |J_n|)/|J| of the last contact of a pair, 0 if its impulse is inside the cone."""
    i, j = pair
    impulse = after.velocity[i] - before.velocity[i]
    fallen = world.fall(after.time - before.time)
    impulse -= fallen
    x = after.position[i] - after.position[j]
    lengths = np.array([side or 1e300 for side in world.box])  # no images along an open axis
    n = x - lengths * np.round(x / lengths)
    n /= np.linalg.norm(n)
    impulse_size = np.linalg.norm(impulse)
    # velocities are rounded, which matters for weak impulses
    speed = np.abs(before.velocity[[i, j]]).max() + np.abs(fallen).max()
    normal = impulse @ n
    tangential = np.linalg.norm(impulse - normal * n)
    mu = brute_force_from(world, before).material(i, j)[2]
    return max(0.0, tangential - mu * abs(normal)) / (impulse_size + 1e-3 * speed)


def outside(shot, world):
    """The greatest depth of a particle in a wall or in the floor, in a."""
    depth, radius = 0.0, brute_force_from(world, shot).radius
    if world.walls is not None:
        x = shot.position[:, 0]
        depth = max(depth, (radius - x).max(), (x + radius - world.walls[0]).max())
    for side in world.sides:
        distance_inside = side.inwards * (shot.position[:, side.axis] - side.at) - radius
        depth = max(
            depth,
            ((side.shift(shot.time) if side.moves_along_normal else 0.0) - distance_inside).max(),
        )
    if world.floor is not None:
        surface, _ = brute_force_from(world, shot).surface(0.0)
        depth = max(depth, (surface + radius - shot.position[:, -1]).max())
    return depth
