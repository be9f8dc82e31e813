"""Run a scene and write down, at given instants, the sums from which every energy is made."""

import math
from typing import NamedTuple

from roughgas.compiling.jit import by_reference, compiled, entry, jit
from roughgas.kernel.hooks import sums as sums_of
from roughgas.kernel.loop import REACHED, advance, start
from roughgas.kernel.mathematics import read, write
from roughgas.kernel.particles import (
    enter_box,
    mass_of,
    position_in_box,
    radius_of,
    set_path,
    spin_mass_of,
    spin_of,
)
from roughgas.kernel.state import (
    BASE,
    BOUNDARY_HITS,
    COLLISIONS,
    EXPONENT,
    INSTANT_END,
    NOW,
    ORIGIN,
    STARTED,
)

UNLIMITED = 2**62


class Sampling(NamedTuple):
    """When to sample: every `interval` of time, or every `collisions`, whichever comes first.

    `refresh` is the number of samples after which a cooling gas is refreshed (0: never). More than
    `hits` of walls and floor within a call end it early.
    """

    interval: float
    collisions: int
    refresh: int
    hits: int = UNLIMITED


def columns(scene):
    """Return the names of the columns that `record` fills, in order.

    These are sums over all particles, then those over each species where there are any, as
    `vv_x[0]`, and last what effects have summed since the start. Where particles differ, masses
    weigh what has no spin in it; with s = m q over the q of the scene, `ww` is the sum of s (a w)^2
    and `w` that of s a (a w), over a^2 the angular momentum.
    """
    dimension, effects = len(scene.box), scene.effects
    axes = "xyz"[:dimension]
    sums = [f"vv_{k}" for k in axes] + [f"p_{k}" for k in axes] + ["y", "yy", "yv_x"]
    if effects.spin is not None:
        sums += ["ww"] + (["w"] if dimension == 2 else ["w_x", "w_y", "w_z"])
    kinds = 0 if effects.species is None else effects.species.kinds
    return (
        ["time", "collisions", "exponent"]
        + sums
        + [f"{name}[{kind}]" for kind in range(kinds) for name in sums]
        + [name for own in sums_of(effects).values() for name in own]
    )


@entry(cache=True)
def record(state, scene, plan, samples):
    """Advance, filling one row of `samples` (see `columns`) at each instant of the plan.

    Returns how it ended (see `advance`) and the number of rows filled: all, if it REACHED the end.
    """
    state, scene = by_reference(state), by_reference(scene)
    if state.counts[STARTED] == 0:
        start(state, scene)
        state.counts[STARTED] = 1
    hits = state.counts[BOUNDARY_HITS] + plan.hits
    for k in range(len(samples)):
        now = state.clock[BASE] + state.clock[NOW]
        collisions = state.counts[COLLISIONS] + plan.collisions
        ended = advance(state, scene, now + plan.interval, collisions, hits)
        if ended != REACHED:
            return ended, k
        take_sample(state, scene, samples, k)
        if plan.refresh > 0 and (k + 1) % plan.refresh == 0:
            refresh(state, scene)
    return REACHED, len(samples)


@compiled
def take_sample(state, scene, samples, place):
    """Fill a row with sums over the particles at the present instant; nothing is moved."""
    time, row = state.clock[NOW], samples[place]
    for k in range(len(row)):
        row[k] = 0.0
    unit = math.ldexp(1.0, -int(state.counts[EXPONENT]))
    row[0] = state.clock[ORIGIN] + (state.clock[BASE] + time) * unit
    row[1] = state.counts[COLLISIONS]
    row[2] = state.counts[EXPONENT]
    axes = len(scene.box)
    sums = tuple(0.0 for k in range(2 * axes + 3 if state.spin is None else 4 * axes + 1))
    for i in range(len(state.changes)):
        position, velocity = position_in_box(state, scene, i, time)
        sums = _added(state, scene, i, position, velocity, sums)
        if state.bodies is not None:
            first = 3 + len(sums) * (1 + state.bodies.species[i])
            own = read(samples, place, first, sums)
            own = _added(state, scene, i, position, velocity, own)
            write(samples, place, first, own)
    write(samples, place, 3, sums)
    _enter_sums(state.sums, state.counts[EXPONENT], row)


@jit
def _added(state, scene, i, position, velocity, sums):
    """Return the sums with what particle i adds to them."""
    mass, n = mass_of(state.bodies, i), len(position)
    height = position[1] - scene.middle
    squares = tuple(sums[k] + mass * (velocity[k] * velocity[k]) for k in range(n))
    momenta = tuple(sums[n + k] + mass * velocity[k] for k in range(n))
    profile = (
        sums[2 * n] + mass * height,
        sums[2 * n + 1] + mass * (height * height),
        sums[2 * n + 2] + mass * (height * velocity[0]),
    )
    if state.spin is None:
        return squares + momenta + profile
    share = 1.0
    if state.bodies is not None:
        share = spin_mass_of(state.bodies, scene.effects.spin, i) / scene.effects.spin.inertia
    lever = share * radius_of(state.bodies, i)
    spin = spin_of(state.spin, scene.box, i)
    square = sums[2 * n + 3]
    for k in range(2 * n - 3):
        square += share * (spin[k] * spin[k])
    turning = tuple(sums[2 * n + 4 + k] + lever * spin[k] for k in range(2 * n - 3))
    return squares + momenta + profile + (square,) + turning


@jit
def _enter_sums(sums, exponent, row):
    """Put the running sums of all effects last into a row."""
    if sums is not None:
        end = len(row)
        for k in range(len(sums) - 1, -1, -1):
            if sums[k] is not None:
                end -= sums[k].shape[1]
                for column in range(sums[k].shape[1]):
                    row[end + column] = _running_sum(sums[k], column, exponent)


@jit
def _running_sum(sums, k, exponent):
    """Return a sum in units of a and T; what is smaller than the smallest number becomes zero."""
    return sums[1, k] + math.ldexp(sums[0, k], int(sums[2, k] * exponent))


@compiled
def refresh(state, scene):
    """Bring a cooling gas to one instant, remove its momentum, and undo its slowing down.

    Each contact leaves a rounding error in the momentum; the velocities decay but these errors do
    not, until the gas would move as one lump that holds all the energy. Between walls momentum is
    not conserved, and stays. Velocities are scaled by a power of two, which changes no digit;
    State.counts[EXPONENT] keeps the sum of the powers.
    """
    number, dimension = len(state.changes), len(scene.box)
    time = state.clock[NOW]
    for i in range(number):
        position, velocity = enter_box(state, scene, i, time)
        set_path(state, scene, i, position, velocity, time)
    square = 0.0
    for k in range(dimension, 2 * dimension):
        mean = _mean_velocity(state, k) if state.agenda.boundary_time is None else 0.0
        for i in range(number):
            state.trajectory[i, k] -= mean
            square += state.trajectory[i, k] * state.trajectory[i, k]
    if square > 0.0:
        rescale(state, scene, math.frexp(math.sqrt(square / number))[1])
    start(state, scene)


@jit
def _mean_velocity(state, k):
    momentum, mass = 0.0, 0.0
    for i in range(len(state.trajectory)):
        momentum += mass_of(state.bodies, i) * state.trajectory[i, k]
        mass += mass_of(state.bodies, i)
    return momentum / mass


@jit
def rescale(state, scene, power):
    """Divide velocities by 2^power and multiply times by it, all particles being at one instant."""
    clock, dimension, moments = state.clock, len(scene.box), state.moments
    down = math.ldexp(1.0, -power)
    unit = math.ldexp(1.0, -int(state.counts[EXPONENT]))
    clock[ORIGIN] += (clock[BASE] + clock[NOW]) * unit
    for i in range(len(state.changes)):
        state.trajectory[i, 2 * dimension] = 0.0
        for k in range(dimension, 2 * dimension):
            state.trajectory[i, k] *= down
        if state.spin is not None:
            for k in range(state.spin.shape[1]):
                state.spin[i, k] *= down
        for k in range(len(moments)):
            if moments[k] is not None:
                moments[k][i] = (moments[k][i] - clock[NOW]) / down
    for account in range(state.ledger.shape[1]):
        for k in range(2):
            state.ledger[1, account, k] += state.ledger[0, account, k] / (unit * unit)
            state.ledger[0, account, k] = 0.0
    _keep_sums(state.sums, state.counts[EXPONENT])
    state.counts[EXPONENT] += power
    clock[BASE] = 0.0
    clock[NOW] = 0.0
    clock[INSTANT_END] = 0.0


@jit
def _keep_sums(sums, exponent):
    if sums is not None:
        for k in range(len(sums)):
            if sums[k] is not None:
                for column in range(sums[k].shape[1]):
                    sums[k][1, column] = _running_sum(sums[k], column, exponent)
                    sums[k][0, column] = 0.0
