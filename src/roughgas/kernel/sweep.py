"""Which particles may meet a given one soon: all of them swept at once, in vector registers.

The sweep works in single precision on straight lines r0 + v0 t from the clock's base and is only a
sieve: with a margin for its rounding it never misses a contact, and what it lets through is decided
in double precision (pairs.py). So neither its precision nor its order shows in the results.

For each pair, with x the separation at mid-interval (nearest image) and u the relative velocity,
the line passes within a diameter s if |x cross u| <= s |u|, and does so within the interval of
half-length h if |x.u| <= u.u h + s |u|. Pairs too fast for one image are let through.
"""

import math

import numpy as np

from roughgas.kernel import hooks
from roughgas.kernel.agenda import clear_contacts
from roughgas.kernel.arithmetic import multiply_add
from roughgas.kernel.flight import whereabouts
from roughgas.kernel.hooks import unless_absent
from roughgas.kernel.images import exceeds, image_numbers, shifted, slid, speed_limit
from roughgas.kernel.jit import jit, overload
from roughgas.kernel.pairs import DIAMETER
from roughgas.kernel.shortlist import decide
from roughgas.kernel.state import EXTENT, LONGEST_HORIZON, SPAN, TYPICAL_SPEED
from roughgas.kernel.unroll import unrolled
from roughgas.kernel.vectors import add_scaled, column, cross_squared, dot, read, subtract

ROUNDING = 2.0**-24  # half the spacing of single precision just above 1


def find_by_sweep(cells, state, scene, i, time):
    """Foresee particle i's contacts with all others up to its horizon."""
    redraw_line(state, scene, i)
    end = time + horizon(state, scene, i)
    half = 0.5 * (end - time)
    mark_candidates(state, scene, i, time + half, half)
    clear_contacts(state.agenda, i, end)
    number = collect_candidates(state.sweep, i, state.shortlist.found)
    decide(state, scene, i, number, time, end, end)


@jit
def horizon(state, scene, i):
    """How far ahead particle i's contacts are foreseen; any positive time gives the same events,
    to rounding."""
    v = read(state.trajectory, i, len(scene.box), scene.box)
    speed = math.sqrt(dot(v, v)) + 2.0 * state.clock[TYPICAL_SPEED]
    if speed == 0.0:
        return state.clock[SPAN]
    return min((scene.extent - 2.0 * DIAMETER) / speed, state.clock[LONGEST_HORIZON])


@jit
def redraw_line(state, scene, i):
    """Renew particle i's single-precision line after its velocity has changed.

    Under gravity the lines are those seen from a frame that falls with it from the clock's base:
    r(t) = r0 + v0 t - g t^2/2 with the same last term for all, so that pairs never see gravity.
    """
    start, velocity = whereabouts(state, scene, i, 0.0)
    lines = state.sweep.lines
    extent = 0.0
    for k in range(len(start)):
        lines[k, i] = start[k]
        lines[k + len(start), i] = velocity[k]
        extent += abs(start[k]) + 3.0 * state.clock[SPAN] * abs(velocity[k])
    state.clock[EXTENT] = max(state.clock[EXTENT], extent)


@jit
def mark_candidates(state, scene, i, middle, half):
    """Set state.sweep.marks of every particle that i may touch within `half` of time `middle`."""
    clock = state.clock
    margin = DIAMETER + 16.0 * ROUNDING * clock[EXTENT]
    speed = max(clock[TYPICAL_SPEED], 1e-30)
    # s |u| <= (s / 2) (u.u / w + w) for any speed w, which saves a root per pair
    reach = half + 0.55 * margin / speed
    slide = slid(hooks.sliding(scene.effects, None, state), middle)
    _sweep(
        state.sweep.lines,
        state.sweep.marks,
        i,
        single(scene.box),
        single(slide),
        _single(speed_limit(scene.box, half)),
        np.float32(middle),
        np.float32(reach),
        np.float32(0.55 * margin * speed),
        np.float32(margin * margin),
    )


@jit
def _sweep(lines, marks, i, box, slide, limit, middle, reach, spare, square):
    x_i = column(lines, i, 0, box)
    u_i = column(lines, i, len(box), box)
    for j in range(marks.size):
        u = subtract(column(lines, j, len(box), box), u_i)
        x = add_scaled(subtract(column(lines, j, 0, box), x_i), u, middle)
        x, u = shifted(x, u, image_numbers(x, box, slide), box, slide)
        uu = dot(u, u)
        passes = cross_squared(x, u) <= square * uu
        soon = abs(dot(x, u)) <= multiply_add(uu, reach, spare)
        marks[j] = (passes & soon) | exceeds(uu, limit)


@jit
def collect_candidates(sweep, i, found):
    """List the marked particles but i in `found`; return their number."""
    number = 0
    _pack(sweep.words, sweep.bits)
    for word in range(sweep.bit_words.size):
        rest = sweep.bit_words[word]
        while rest != 0:
            j = 64 * word + trailing_zeros(rest)
            found[number] = j
            number += j != i
            rest &= rest - np.uint64(1)
    return number


@jit
def _pack(words, bits):
    """Pack eight marks into bits: the product moves bit 8k of a word to bit 56 + k."""
    for word in range(words.size):
        bits[word] = (words[word] * np.uint64(0x0102040810204080)) >> np.uint64(56)


def trailing_zeros(word):
    """Return the number of zeros below the lowest bit of a word that is set."""
    return (int(word) & -int(word)).bit_length() - 1


@overload(trailing_zeros)
def _compiled_trailing_zeros(word):
    from roughgas.kernel.compiler import trailing_zeros

    return lambda word: trailing_zeros(word)


@unrolled
def single(numbers):
    """Return a tuple in single precision; None stays None, inside and out."""
    if numbers is None:
        return None
    else:
        return tuple(_single(numbers[k]) for k in range(len(numbers)))


@unless_absent
def _single(x):
    return np.float32(x)
