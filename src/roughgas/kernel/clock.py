"""Time: kept relative to a base that moves along, so that its resolution never wears out."""

import math

from roughgas.kernel import hooks
from roughgas.kernel.agenda import enter_in_queue
from roughgas.kernel.hooks import unless_absent
from roughgas.kernel.jit import compiled, jit
from roughgas.kernel.pairs import DIAMETER
from roughgas.kernel.state import (
    BASE,
    EXTENT,
    LONGEST_HORIZON,
    NOW,
    SINCE_REBASE,
    SLOTS,
    SPAN,
    TYPICAL_SPEED,
)
from roughgas.kernel.sweep import redraw_line
from roughgas.kernel.vectors import dot, read

FLIGHTS = 2.5  # foresee about so many mean free flights


@compiled
def rebase(state, scene):
    """Move the base up to the present, by a whole number of spans, and look at the gas afresh.

    A span is a power of two, so that the base stays exact; it is about the time that a typical
    particle takes to cross the box.
    """
    clock = state.clock
    step = math.floor(clock[NOW] / clock[SPAN]) * clock[SPAN]
    _shift_times(state, scene, step)
    clock[BASE] += step
    hooks.set_phases(scene.effects, state.phase, clock[BASE])
    _survey(state, scene, step)
    clock[EXTENT] = 0.0
    for i in range(len(state.changes)):
        redraw_line(state, scene, i)


@jit
def _shift_times(state, scene, step):
    agenda = state.agenda
    state.clock[NOW] -= step
    for i in range(len(state.changes)):
        state.trajectory[i, 2 * len(scene.box)] -= step
        enter_in_queue(agenda, i, agenda.key[i] - step)
        agenda.complete_until[i] -= step
        agenda.boundary_time[i] -= step
        for k in range(SLOTS):
            agenda.slot_time[i, k] -= step
        _shift(state.last_contact, i, step)


@unless_absent
def _shift(times, i, step):
    times[i] -= step


@jit
def _survey(state, scene, elapsed):
    clock, counts = state.clock, state.counts
    number = len(state.changes)
    total = 0.0
    for i in range(number):
        v = read(state.trajectory, i, len(scene.box), scene.box)
        total += dot(v, v)
    speed = math.sqrt(total / number)
    clock[TYPICAL_SPEED] = speed
    if speed > 0.0:
        clock[SPAN] = math.ldexp(0.5, math.frexp(scene.extent / speed)[1])
    clock[LONGEST_HORIZON] = math.inf
    if counts[SINCE_REBASE] > number and elapsed > 0.0:
        clock[LONGEST_HORIZON] = FLIGHTS * elapsed * number / (2.0 * counts[SINCE_REBASE])
    counts[SINCE_REBASE] = 0


@jit
def horizon(state, scene, i):
    """How far ahead particle i's contacts are foreseen; any positive time gives the same events,
    to rounding."""
    v = read(state.trajectory, i, len(scene.box), scene.box)
    speed = math.sqrt(dot(v, v)) + 2.0 * state.clock[TYPICAL_SPEED]
    if speed == 0.0:
        return state.clock[SPAN]
    return min((scene.extent - 2.0 * DIAMETER) / speed, state.clock[LONGEST_HORIZON])
