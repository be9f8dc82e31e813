"""Which particles may meet a given one soon: all of them swept at once, in vector registers.

The sweep works in single precision on straight lines r0 + v0 t from the clock's base and is only a
sieve: with a margin for its rounding it never misses a contact, and what it lets through is decided
in double precision (prediction.py). So neither its precision nor its order shows in the results.

For each pair, with x the separation at mid-interval (nearest image) and u the relative velocity,
the line passes within a diameter s if |x cross u| <= s |u|, and does so within the interval of
half-length h if |x.u| <= u.u h + s |u|. Pairs too fast for one image are let through.
"""

import math

import numpy as np

from roughgas.compiling.jit import jit
from roughgas.compiling.lanes import append, lanes_of, load, multiply_add
from roughgas.kernel import hooks
from roughgas.kernel.mathematics import add_scaled, cross_squared, dot, read, subtract
from roughgas.kernel.particles import (
    image_numbers,
    largest_of,
    position_and_velocity,
    radius_of,
    shifted,
    slid,
    speed_limit,
)
from roughgas.kernel.state import EXTENT, LONGEST_HORIZON, SPAN, TYPICAL_SPEED

ROUNDING = 2.0**-24  # half the spacing of single precision just above 1
ROUNDED_UP = 1.0 + 2.0**-20  # radii in single precision are no less than they are


@jit
def list_by_sweep(state, scene, i, begin, time):
    """List every particle that i may touch up to its horizon in the shortlist, from `begin` on;
    return the end. The particle itself may be among them: it never meets itself."""
    start, velocity = line_of(state, scene, i)
    line = singles(start), singles(velocity)
    lines, clock, bodies = state.sweep.lines, state.clock, state.bodies
    half = 0.5 * (state.agenda.complete_until[i] - time)
    slack = 16.0 * ROUNDING * clock[EXTENT]
    margin = radius_of(bodies, i) + largest_of(bodies) + slack
    speed = max(clock[TYPICAL_SPEED], 1e-30)
    # s |u| <= (s / 2) (u.u / w + w) for any speed w, which saves a root per pair
    reach, spare = single(half + 0.55 * margin / speed), single(0.55 * margin * speed)
    limit = single(speed_limit(scene.box, half, 2.0 * largest_of(bodies)))
    slide = singles(slid(hooks.sliding(scene.effects, state), time + half))
    box, middle = singles(scene.box), single(time + half)
    own = single(ROUNDED_UP * (margin if bodies is None else radius_of(bodies, i) + slack))
    number = begin
    for first in range(0, len(state.changes), lanes_of(lines)):
        u = subtract(line[1], _lines_of(lines, len(scene.box), first, box))
        x = add_scaled(subtract(line[0], _lines_of(lines, 0, first, box)), u, middle)
        x, u = shifted(x, u, image_numbers(x, box, slide), box, slide)
        uu = dot(u, u)
        s = own if bodies is None else own + load(state.sweep.sizes, 0, first, lanes_of(lines))
        passes = cross_squared(x, u) <= s * s * uu
        meets = passes & (abs(dot(x, u)) <= multiply_add(uu, reach, spare))
        number = append(state.shortlist.found, number, _or_beyond(limit, meets, uu), first)
    draw_line(state, i, start, velocity)
    return number


@jit
def horizon(state, scene, i):
    """How far ahead particle i's contacts are foreseen; any positive time gives the same events,
    to rounding."""
    v = read(state.trajectory, i, len(scene.box), scene.box)
    speed = math.sqrt(dot(v, v)) + 2.0 * state.clock[TYPICAL_SPEED]
    if speed == 0.0:
        return state.clock[SPAN]
    way = scene.extent - 4.0 * largest_of(state.bodies)
    if state.bodies is not None:
        way = max(way, largest_of(state.bodies))  # walls may be near
    return min(way / speed, state.clock[LONGEST_HORIZON])


@jit
def line_of(state, scene, i):
    """Return where particle i's path is, and its velocity, at the clock's base.

    Under gravity the lines are those seen from a frame that falls with it from the clock's base:
    r(t) = r0 + v0 t - g t^2/2 with the same last term for all, so that pairs never see gravity.
    """
    start, velocity = position_and_velocity(state, scene, i, 0.0)
    extent = 0.0
    for k in range(len(start)):
        extent += abs(start[k]) + 3.0 * state.clock[SPAN] * abs(velocity[k])
    state.clock[EXTENT] = max(state.clock[EXTENT], extent)
    return start, velocity


@jit
def draw_line(state, i, start, velocity):
    """Keep particle i's line for the sweeps of others."""
    lines = state.sweep.lines
    for k in range(len(start)):
        lines[k, i] = start[k]
        lines[k + len(start), i] = velocity[k]


@jit
def _or_beyond(limit, meets, uu):
    """Return which pairs meet, and those that are too fast for one image."""
    return meets if limit is None else meets | (uu > limit)


@jit
def _lines_of(lines, first, block, box):
    return tuple(load(lines, first + k, block, lanes_of(lines)) for k in range(len(box)))


@jit
def single(x):
    """Return a number in single precision; None stays None."""
    return None if x is None else np.float32(x)


@jit
def singles(numbers):
    """Return a tuple in single precision; None stays None, inside and out."""
    return None if numbers is None else tuple(single(numbers[k]) for k in range(len(numbers)))
