"""Candidates for contacts with one particle, by a sweep over all particles in vector registers.

The sweep works in single precision on straight lines r0 + v0 t from the clock's base and is only a
sieve: a margin for its rounding ensures that no contact is missed, and the candidates that pass are
examined in double precision (prediction.py). So neither its precision nor its order affects the
results.

For each pair, with x the separation at mid-interval (nearest image) and u the relative velocity,
the line passes within a diameter s if |x cross u| <= s |u|, and does so within the interval of
half-length h if |x.u| <= u.u h + s |u|. Pairs too fast for a single image always pass.
"""

import math

import numpy as np

from roughgas.compiling.jit import jit, static
from roughgas.compiling.lanes import append, lanes_of, load, multiply_add
from roughgas.kernel import hooks
from roughgas.kernel.hooks import active
from roughgas.kernel.mathematics import add_scaled, cross_squared, dot, read, subtract
from roughgas.kernel.particles import (
    image_numbers,
    image_shift_at,
    largest_of,
    position_and_velocity,
    radius_of,
    shifted,
    single_image_limit,
)
from roughgas.kernel.state import EXTENT, LONGEST_HORIZON, SPAN, TYPICAL_SPEED

SINGLE_ROUNDING = 2.0**-24  # half the spacing of single precision just above 1
SPANS_OF_EXTENT = 3.0  # for which paths stay within State.clock[EXTENT]
MAX_HEATING = 2.0**10  # of the typical speed within a span, beyond which horizons stay as they are
FASTEST = 5.0  # speed of the fastest particle relative to a typical partner's, roughly
ROUNDED_UP = 1.0 + 2.0**-20  # factor that makes a number in single precision an upper bound


@jit
def list_by_sweep(state, scene, i, begin, time):
    """Write the particles that i may touch up to its horizon to the shortlist; return the end.

    The shortlist is filled from index `begin` on; the index after the last entry is returned. The
    horizon runs from `time` to Agenda.complete_until. Particle i may be listed itself: it is never
    found to meet itself.
    """
    start, velocity = line_of(state, scene, i)
    line = singles(start), singles(velocity)
    lines, clock, bodies = state.sweep.lines, state.clock, state.bodies
    half = 0.5 * (state.agenda.complete_until[i] - time)
    slack = 16.0 * SINGLE_ROUNDING * clock[EXTENT]
    margin = radius_of(bodies, i) + largest_of(bodies) + slack
    speed = max(clock[TYPICAL_SPEED], 1e-30)
    # s |u| <= (s / 2) (u.u / w + w) for any speed w, which saves a square root per pair
    time_reach, allowance = single(half + 0.55 * margin / speed), single(0.55 * margin * speed)
    limit = single(single_image_limit(scene.box, half, 2.0 * largest_of(bodies)))
    image_shift = singles(image_shift_at(hooks.image_shift(scene.effects, state), time + half))
    box, middle = singles(scene.box), single(time + half)
    base_distance = single(
        ROUNDED_UP * (margin if bodies is None else radius_of(bodies, i) + slack)
    )
    number = begin
    for first in range(0, len(state.changes), lanes_of(lines)):
        u = subtract(line[1], _lines_of(lines, len(scene.box), first, box))
        x = add_scaled(subtract(line[0], _lines_of(lines, 0, first, box)), u, middle)
        x, u = shifted(x, u, image_numbers(x, box, image_shift), box, image_shift)
        uu = dot(u, u)
        s = (
            base_distance
            if bodies is None
            else base_distance + load(state.sweep.sizes, 0, first, lanes_of(lines))
        )
        passes = cross_squared(x, u) <= s * s * uu
        meets = passes & (abs(dot(x, u)) <= multiply_add(uu, time_reach, allowance))
        number = append(state.shortlist.found, number, _or_too_fast(limit, meets, uu), first)
    store_line(state, i, start, velocity)
    return number


@jit
def horizon(state, scene, i):
    """Return the duration for which contacts of particle i are predicted.

    Any positive duration gives the same events, to rounding.
    """
    v = read(state.trajectory, i, len(scene.box), scene.box)
    speed = math.sqrt(dot(v, v)) + _speed_of_partners(state, scene)
    if speed == 0.0:
        return state.clock[SPAN]
    distance = scene.extent - 4.0 * largest_of(state.bodies)
    if state.bodies is not None:
        distance = max(distance, largest_of(state.bodies))  # walls may be near
    return min(distance / speed, state.clock[LONGEST_HORIZON])


@jit
def _speed_of_partners(state, scene):
    """Return twice the typical speed; more where kicks or walls have heated the gas up since the
    clock's typical speed was computed."""
    clock = state.clock
    speed = 2.0 * clock[TYPICAL_SPEED]
    if _may_heat_up(scene.effects):
        fastest = clock[EXTENT] / (SPANS_OF_EXTENT * clock[SPAN])
        speed = max(speed, min(fastest / FASTEST, MAX_HEATING * clock[TYPICAL_SPEED]))
    return speed


@static
def _may_heat_up(effects):
    """Return whether events of an effect, as kicks, may heat up a gas whose lines have the
    particles' velocities, without those of a free fall or a sheared flow, which partners share."""
    shared = active(effects, "acceleration") or active(effects, "image_shift")
    return bool(active(effects, "predict")) and not shared


@jit
def line_of(state, scene, i):
    """Return position and velocity of particle i at the clock's base, extrapolated from its path.

    They define its straight line r0 + v0 t for the sweep. Under gravity the lines hold in a frame
    that falls freely from the clock's base on: in r(t) = r0 + v0 t + g t^2/2 the last term is
    common to all and drops out of relative positions. State.clock[EXTENT] is raised if needed.
    """
    start, velocity = position_and_velocity(state, scene, i, 0.0)
    extent = 0.0
    for k in range(len(start)):
        extent += abs(start[k]) + SPANS_OF_EXTENT * state.clock[SPAN] * abs(velocity[k])
    state.clock[EXTENT] = max(state.clock[EXTENT], extent)
    return start, velocity


@jit
def store_line(state, i, start, velocity):
    """Store particle i's straight line, in single precision, for the sweeps of other particles.

    `start` and `velocity` are its position, not folded into the box, and velocity at the clock's
    base, as from `line_of`.
    """
    lines = state.sweep.lines
    for k in range(len(start)):
        lines[k, i] = start[k]
        lines[k + len(start), i] = velocity[k]


@jit
def _or_too_fast(limit, meets, uu):
    """Return the mask of pairs that meet or are too fast for a single image.

    `meets` is the mask of pairs that meet, uu their squared relative speed, `limit` the
    single_image_limit.
    """
    return meets if limit is None else meets | (uu > limit)


@jit
def _lines_of(lines, first, block, box):
    """Return D rows of the stored lines for a block of particles, as lanes.

    `first` is 0 for positions and D for velocities, `block` the first particle, `lines`
    Sweep.lines.
    """
    return tuple(load(lines, first + k, block, lanes_of(lines)) for k in range(len(box)))


@jit
def single(x):
    """Return a number in single precision; None for None."""
    return None if x is None else np.float32(x)


@jit
def singles(numbers):
    """Return a tuple in single precision; None for None, also inside the tuple."""
    return None if numbers is None else tuple(single(numbers[k]) for k in range(len(numbers)))
