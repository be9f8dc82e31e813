"""Run a scene and write down, at given instants, the sums from which every energy is made."""

import math
from typing import NamedTuple

from roughgas.kernel.flight import arrive, come_in, put
from roughgas.kernel.hooks import either, present, unless_absent
from roughgas.kernel.jit import compiled, entry, jit
from roughgas.kernel.loop import advance, start
from roughgas.kernel.spins import spin_of
from roughgas.kernel.state import (
    BASE,
    COLLISIONS,
    EXPONENT,
    INSTANT_END,
    NOW,
    ORIGIN,
    SPAN,
    STARTED,
)
from roughgas.kernel.unroll import unrolled

PATIENCE = 1000.0  # spans to wait for collisions that may never come


class Sampling(NamedTuple):
    """When to sample: every `interval` of time, or every `collisions`, whichever comes first.

    `refresh` is the number of samples after which a cooling gas is refreshed (0: never).
    """

    interval: float
    collisions: int
    refresh: int


def columns(scene):
    """Return the names of the columns that `record` fills, in order.

    These are sums over all particles, and last what effects have summed since the start.
    """
    dimension, effects = len(scene.box), scene.effects
    axes = "xyz"[:dimension]
    spins = (
        []
        if effects.spin is None
        else ["ww"] + (["w"] if dimension == 2 else ["w_x", "w_y", "w_z"])
    )
    return (
        ["time", "collisions", "exponent"]
        + [f"vv_{k}" for k in axes]
        + [f"p_{k}" for k in axes]
        + ["y", "yy", "yv_x"]
        + spins
        + [name for part in present(effects, "sums") for name in part.own]
    )


@entry(cache=True)
def record(state, scene, plan, samples):
    """Advance, filling one row of `samples` (see `columns`) at each instant of the plan.

    Returns the number of rows filled: fewer than asked for when the gas collapses.
    """
    if state.counts[STARTED] == 0:
        start(state, scene)
        state.counts[STARTED] = 1
    for k in range(len(samples)):
        now = state.clock[BASE] + state.clock[NOW]
        until = now + min(plan.interval, PATIENCE * state.clock[SPAN])
        collisions = state.counts[COLLISIONS] + plan.collisions
        if not advance(state, scene, until, collisions):
            return k
        take_sample(state, scene, samples[k])
        if plan.refresh > 0 and (k + 1) % plan.refresh == 0:
            refresh(state, scene)
    return len(samples)


@compiled
def take_sample(state, scene, row):
    """Fill a row with sums over the particles at the present instant; nothing is moved."""
    box = scene.box
    dimension = len(box)
    time = state.clock[NOW]
    for k in range(len(row)):
        row[k] = 0.0
    unit = math.ldexp(1.0, -state.counts[EXPONENT])
    row[0] = state.clock[ORIGIN] + (state.clock[BASE] + time) * unit
    row[1] = state.counts[COLLISIONS]
    row[2] = state.counts[EXPONENT]
    for i in range(len(state.changes)):
        position, velocity = arrive(state, scene, i, time)
        for k in range(dimension):
            row[3 + k] += velocity[k] * velocity[k]
            row[3 + dimension + k] += velocity[k]
        height = position[1] - scene.middle
        row[3 + 2 * dimension] += height
        row[4 + 2 * dimension] += height * height
        row[5 + 2 * dimension] += height * velocity[0]
        _add_spin(spin_of(state.spin, box, i), row, 6 + 2 * dimension)
    _enter_sums(state.sums, state.counts[EXPONENT], row, len(row))


@unless_absent
def _add_spin(spin, row, first):
    for k in range(len(spin)):
        row[first] += spin[k] * spin[k]
        row[first + 1 + k] += spin[k]


@unrolled
def _enter_sums(sums, exponent, row, end):
    if sums is not None:
        for k in range(len(sums) - 1, -1, -1):
            if sums[k] is not None:
                end = _enter(sums[k], exponent, row, end)


@jit
def _enter(sums, exponent, row, end):
    first = end - sums.shape[1]
    for k in range(sums.shape[1]):
        row[first + k] = _running_sum(sums, k, exponent)
    return first


@jit
def _running_sum(sums, k, exponent):
    """Return a sum in units of a and T; what is smaller than the smallest number becomes zero."""
    return sums[1, k] + math.ldexp(sums[0, k], int(sums[2, k]) * exponent)


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
        position, velocity = come_in(state, scene, i, time)
        put(state, scene, i, position, velocity, time)
    square = 0.0
    for k in range(dimension, 2 * dimension):
        mean = _conserved_mean(state.agenda.boundary_time, state.trajectory, k)
        for i in range(number):
            state.trajectory[i, k] -= mean
            square += state.trajectory[i, k] ** 2
    if square > 0.0:
        rescale(state, scene, math.frexp(math.sqrt(square / number))[1])
    start(state, scene)


def _mean(boundary_time, trajectory, k):
    mean = 0.0
    for i in range(len(trajectory)):
        mean += trajectory[i, k]
    return mean / len(trajectory)


_conserved_mean = either(lambda boundary_time, trajectory, k: 0.0, _mean)


@jit
def rescale(state, scene, power):
    """Divide velocities by 2^power and multiply times by it, all particles being at one instant."""
    clock, dimension = state.clock, len(scene.box)
    down = math.ldexp(1.0, -power)
    unit = math.ldexp(1.0, -state.counts[EXPONENT])
    clock[ORIGIN] += (clock[BASE] + clock[NOW]) * unit
    for i in range(len(state.changes)):
        state.trajectory[i, 2 * dimension] = 0.0
        for k in range(dimension, 2 * dimension):
            state.trajectory[i, k] *= down
        _scale_spin(state.spin, i, down)
        _scale_moments(state.moments, i, clock[NOW], down)
    for account in range(state.ledger.shape[1]):
        for k in range(2):
            state.ledger[1, account, k] += state.ledger[0, account, k] / (unit * unit)
            state.ledger[0, account, k] = 0.0
    _keep_sums(state.sums, state.counts[EXPONENT])
    state.counts[EXPONENT] += power
    clock[BASE] = 0.0
    clock[NOW] = 0.0
    clock[INSTANT_END] = 0.0


@unrolled
def _keep_sums(sums, exponent):
    if sums is not None:
        for k in range(len(sums)):
            if sums[k] is not None:
                _keep(sums[k], exponent)


@jit
def _keep(sums, exponent):
    for k in range(sums.shape[1]):
        sums[1, k] = _running_sum(sums, k, exponent)
        sums[0, k] = 0.0


@unless_absent
def _scale_spin(spin, i, factor):
    for k in range(spin.shape[1]):
        spin[i, k] *= factor


@unrolled
def _scale_moments(moments, i, now, factor):
    for k in range(len(moments)):
        if moments[k] is not None:
            moments[k][i] = (moments[k][i] - now) / factor
