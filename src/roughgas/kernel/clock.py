"""Time: kept relative to a base that moves along, so that its resolution never wears out."""

import math

from roughgas.kernel import hooks
from roughgas.kernel.jit import jit
from roughgas.kernel.state import (
    AT_ONCE,
    BASE,
    INSTANT_END,
    LONGEST_HORIZON,
    NOW,
    SINCE_REBASE,
    SPAN,
    SPENT,
    TYPICAL_SPEED,
)
from roughgas.kernel.vectors import dot, read

FLIGHTS = 2.5  # mean free flights to foresee
CELLS = 16.0  # cells that a particle crosses before all are sorted anew
INSTANT = 2.0**-30  # of a span; events as close as this count as simultaneous
COLLAPSE = 10  # simultaneous contacts of particles that hardly approach
STANDSTILL = 100_000, 10  # simultaneous events, and as many more for each particle


@jit
def check_collapse(state, time):
    """Note an event at `time`; return False where events accumulate as if time stood still.

    In an inelastic collapse infinitely many contacts of a few particles are made in a finite time,
    at less and less speed: contacts at almost no speed are its sign. Symmetry can make a few events
    per particle simultaneous; many more are a fault, which must not hang.
    """
    clock, counts = state.clock, state.counts
    if time > clock[INSTANT_END]:
        clock[INSTANT_END] = time + INSTANT * clock[SPAN]
        counts[AT_ONCE] = 0
        counts[SPENT] = 0
    counts[AT_ONCE] += 1
    many = STANDSTILL[0] + STANDSTILL[1] * len(state.changes)
    return (counts[SPENT] < COLLAPSE) & (counts[AT_ONCE] < many)


@jit
def rebase(state, scene):
    """Move the base up to the present, by a whole number of spans, and look at the gas afresh.

    A span is a power of two, so that the base stays exact, and about the time in which a typical
    particle crosses the box, or CELLS cells. Returns how far the base has moved; the times
    on the agenda still count from the old one.
    """
    clock, moments = state.clock, state.moments
    step = math.floor(clock[NOW] / clock[SPAN]) * clock[SPAN]
    clock[NOW] -= step
    clock[INSTANT_END] -= step
    for i in range(len(state.changes)):
        state.trajectory[i, 2 * len(scene.box)] -= step
        for k in range(len(moments)):
            if moments[k] is not None:
                moments[k][i] -= step
    clock[BASE] += step
    hooks.set_phases(scene.effects, state.phase, clock[BASE])
    _survey(state, scene, step)
    return step


@jit
def _survey(state, scene, elapsed):
    clock, counts = state.clock, state.counts
    number = len(state.changes)
    total = 0.0
    slide = hooks.sliding(scene.effects, state)
    for i in range(number):
        position = read(state.trajectory, i, 0, scene.box)
        v = read(state.trajectory, i, len(scene.box), scene.box)
        v = _beside_flow(slide, scene.box, position, v)
        total += dot(v, v)
    speed = math.sqrt(total / number)
    clock[TYPICAL_SPEED] = speed
    if speed > 0.0:
        clock[SPAN] = math.ldexp(0.5, math.frexp(_stretch(state.cells, scene) / speed)[1])
    clock[LONGEST_HORIZON] = math.inf
    if counts[SINCE_REBASE] > number and elapsed > 0.0:
        clock[LONGEST_HORIZON] = FLIGHTS * elapsed * number / (2.0 * counts[SINCE_REBASE])
    counts[SINCE_REBASE] = 0


@jit
def _stretch(cells, scene):
    return scene.extent if cells is None else min(scene.extent, CELLS * max(cells.widths))


@jit
def _beside_flow(slide, box, x, v):
    """Return a velocity relative to the mean flow of a sheared gas, up to a constant."""
    return v if slide is None else (v[0] - slide[1] * (x[1] / box[1] - 0.5),) + v[1:]
