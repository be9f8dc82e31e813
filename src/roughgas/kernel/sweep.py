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
from roughgas.kernel.event_lists import clear_contacts
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
def look_ahead(state, scene, i, time):
    """Forget particle i's contacts; those that are listed next are complete to its horizon."""
    clear_contacts(state.agenda, i, time + horizon(state, scene, i))


@jit
def list_by_sweep(state, scene, i, begin, time):
    """List every particle that i may touch up to its horizon in the shortlist, from `begin` on;
    return the end."""
    start, velocity = line_of(state, scene, i)
    half = 0.5 * (state.agenda.complete_until[i] - time)
    line = singles(start), singles(velocity)
    end = list_candidates(state, scene, i, begin, *line, time + half, half)
    draw_line(state, i, start, velocity)
    return end


@jit
def horizon(state, scene, i):
    """How far ahead particle i's contacts are foreseen; any positive time gives the same events,
    to rounding."""
    v = read(state.trajectory, i, len(scene.box), scene.box)
    speed = math.sqrt(dot(v, v)) + 2.0 * state.clock[TYPICAL_SPEED]
    if speed == 0.0:
        return state.clock[SPAN]
    return min(_free_way(state.bodies, scene) / speed, state.clock[LONGEST_HORIZON])


@jit
def _free_way(bodies, scene):
    if bodies is None:
        return scene.extent - 4.0
    return max(scene.extent - 4.0 * bodies.largest[0], bodies.largest[0])  # walls may be near


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
def list_candidates(state, scene, i, begin, start, velocity, middle, half):
    """List every particle that one on this line may touch within `half` of time `middle` in the
    shortlist; return the end. The particle itself may be among them: it never meets itself."""
    lines, clock, bodies = state.sweep.lines, state.clock, state.bodies
    slack = 16.0 * ROUNDING * clock[EXTENT]
    own = single(ROUNDED_UP * (radius_of(bodies, i) + slack))
    margin = radius_of(bodies, i) + largest_of(bodies) + slack
    speed = max(clock[TYPICAL_SPEED], 1e-30)
    # s |u| <= (s / 2) (u.u / w + w) for any speed w, which saves a root per pair
    reach, spare = single(half + 0.55 * margin / speed), single(0.55 * margin * speed)
    limit = single(speed_limit(scene.box, half, 2.0 * largest_of(bodies)))
    slide = singles(slid(hooks.sliding(scene.effects, state), middle))
    box, square, middle = singles(scene.box), single(margin * margin), single(middle)
    number = begin
    for first in range(0, len(state.changes), lanes_of(lines)):
        u = subtract(velocity, _lines_of(lines, len(scene.box), first, box))
        x = add_scaled(subtract(start, _lines_of(lines, 0, first, box)), u, middle)
        x, u = shifted(x, u, image_numbers(x, box, slide), box, slide)
        uu = dot(u, u)
        passes = cross_squared(x, u) <= _square(state.sweep.sizes, own, first, square) * uu
        meets = passes & (abs(dot(x, u)) <= multiply_add(uu, reach, spare))
        meets = _or_beyond(limit, meets, uu)
        number = append(state.shortlist.found, number, meets, first)
    return number


@jit
def _or_beyond(limit, meets, uu):
    """Return which pairs meet, and those that are too fast for one image."""
    return meets if limit is None else meets | (uu > limit)


@jit
def _square(sizes, own, first, square):
    """Return the square of the distance at which each of these particles may be touched."""
    if sizes is None:
        return square
    reach = load(sizes, 0, first, lanes_of(sizes)) + own
    return reach * reach


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
