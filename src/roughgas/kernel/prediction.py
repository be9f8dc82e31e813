"""When two particles meet; of all candidates for a contact with one particle, several at a time.

The time is exact, in double precision, and a function of the two paths alone. It does not depend on
when it is computed, or for which of the two, so that no choice of the scheduler can change a
trajectory. A path is (position, velocity, time at which they hold), and goes on in free flight.
"""

import math

import numpy as np

from roughgas.compiling.jit import compiled, jit
from roughgas.compiling.lanes import (
    bits,
    choose,
    gather,
    index,
    lanes_of,
    larger,
    load,
    numbers_in,
    order,
    root,
    smaller,
    store,
    trailing_zeros,
)
from roughgas.kernel import hooks
from roughgas.kernel.event_lists import add_contact
from roughgas.kernel.mathematics import add_scaled, cross_squared, dot, subtract
from roughgas.kernel.memory import SLOTS_OF_FEW
from roughgas.kernel.particles import (
    along,
    image_numbers,
    largest_of,
    path_of,
    radius_of,
    reach_of,
    shifted,
    slid,
    speed_limit,
)


@jit
def time_to_contact(x, u, reach):
    """Return the time until two particles at separation x, with relative velocity u, touch, or inf.

    They touch at the distance `reach`.

    Touching or overlapping (by rounding) and approaching is a contact now; receding never is one.
    The smaller root is formed by division, so that it does not cancel when the particles are
    close, and the discriminant from the cross product, so that it does not when they are far. For
    a pair that touches but for a rounding, root - b may be almost 0: a contact is therefore never
    later than the closest approach. Roots and quotients are taken before anything is decided: a
    branch that the processor cannot foresee would cost more, and without branches several pairs
    are done at once.
    """
    b, uu = dot(x, u), dot(u, u)
    c = dot(x, x) - reach * reach
    discriminant = reach * reach * uu - cross_squared(x, u)
    time = larger(c, 0.0) / (root(larger(discriminant, 0.0)) - b)
    time = smaller(time, -b / uu)
    meets = (b < 0.0) & ((discriminant >= 0.0) | (c <= 0.0))
    return choose(meets, time, math.inf)


@jit
def meeting(path_i, path_j, box, gravity, slide, middle, limit, reach):
    """Return the time of the first contact of two paths, and whether a second image might be met.

    The nearest image at `middle` is the only one that can be met as long as the pair moves less
    than half a box, less a diameter, from there: as long as it is not faster than the speed_limit.
    """
    since = larger(path_i[2], path_j[2])
    position_i, velocity_i = along(path_i, since, gravity)
    position_j, velocity_j = along(path_j, since, gravity)
    x = subtract(position_j, position_i)
    u = subtract(velocity_j, velocity_i)
    numbers = image_numbers(add_scaled(x, u, middle - since), box, slid(slide, middle))
    x, u = shifted(x, u, numbers, box, slid(slide, since))
    time = since + time_to_contact(x, u, reach)
    return time, False if limit is None else dot(u, u) > limit


@compiled
def meeting_of_any_image(path_i, path_j, box, gravity, slide, start, end, reach):
    """Return when, between `start` and `end`, any images of two paths first touch, or inf.

    The interval is cut until within each piece the nearest image decides.
    """
    pieces = 2
    k = 0
    while k < pieces:
        length = (end - start) / pieces
        middle = start + (k + 0.5) * length
        limit = speed_limit(box, 0.5 * length, reach)
        time, unsure = meeting(path_i, path_j, box, gravity, slide, middle, limit, reach)
        if unsure:
            pieces *= 2
            k *= 2
        elif time <= start + (k + 1) * length:
            return time
        else:
            k += 1
    return math.inf


@jit
def decide(state, scene, i, begin, beyond, time):
    """Put the contacts of particle i with candidates, from `time` on, on its agenda.

    Candidates are on the shortlist from the place `begin` to the one before `beyond`. After a sweep
    every image counts, up to the particle's horizon; in cells the nearest one. What lies beyond the
    last candidate is a particle's number, too: it is decided and left.
    """
    box, bodies = scene.box, state.bodies
    path = path_of(state.trajectory, i, box)
    gravity = hooks.acceleration(scene.effects)
    slide = hooks.sliding(scene.effects, state)
    middle, end, fastest = time, math.inf, None
    if state.cells is None:
        end = state.agenda.complete_until[i]
        half = 0.5 * (end - time)
        middle, fastest = time + half, speed_limit(box, half, 2.0 * largest_of(bodies))
    first, more, lanes = begin, True, lanes_of(state.shortlist.when)
    while more:  # once mostly, and at least once, so that the processor can foresee it
        others = numbers_in(state.shortlist.found, first, lanes)
        paths = _paths_of(state.trajectory, others, box)
        reach = radius_of(bodies, i) + (1.0 if bodies is None else gather(bodies.radius, 0, others))
        when, unsure = meeting(path, paths, box, gravity, slide, middle, fastest, reach)
        listed = order(lanes) < beyond - first
        candidates = path, first, listed
        when = _of_any_image(fastest, state, scene, i, candidates, time, end, when, unsure)
        if state.cells is None:
            listed = listed & (when <= end)
        when = choose(listed, when, math.inf)
        _note(state, i, first - begin, first, others, when)
        first += lanes
        more = first < beyond


@jit
def _paths_of(trajectory, others, box):
    """Return the paths of other particles, given as lanes."""
    return (
        tuple(gather(trajectory, k, others) for k in range(len(box))),
        tuple(gather(trajectory, len(box) + k, others) for k in range(len(box))),
        gather(trajectory, 2 * len(box), others),
    )


@jit
def _of_any_image(fastest, state, scene, i, candidates, start, end, when, unsure):
    """Return the times of contact, with every image looked at where the nearest may not decide."""
    if fastest is None:
        return when
    path, first, listed = candidates
    undecided = bits(unsure & listed)
    if undecided == 0:
        return when
    shortlist, box = state.shortlist, scene.box
    gravity = hooks.acceleration(scene.effects)
    slide = hooks.sliding(scene.effects, state)
    store(shortlist.when, 0, 0, when)
    while undecided != 0:
        k = trailing_zeros(undecided)
        j = shortlist.found[first + k]
        other = path_of(state.trajectory, j, box)
        reach = reach_of(state.bodies, i, j)
        time = meeting_of_any_image(path, other, box, gravity, slide, start, end, reach)
        shortlist.when[0, k] = time
        undecided &= undecided - np.uint64(1)
    return load(shortlist.when, 0, 0, lanes_of(shortlist.when))


@jit
def _one_by_one(state, i, first, when):
    agenda, shortlist = state.agenda, state.shortlist
    store(shortlist.when, 0, 0, when)
    contacts = bits(when < math.inf)
    while contacts != np.uint64(0):
        k = trailing_zeros(contacts)
        j = index(int(shortlist.found[index(first + k)]))
        add_contact(agenda, i, shortlist.when[0, k], j, state.changes[j])
        contacts &= contacts - np.uint64(1)


@jit
def _note(state, i, slot, first, others, when):
    """Put contacts with candidates on particle i's list: all at once, where they have slots."""
    if state.cells is not None or slot + lanes_of(state.shortlist.when) > SLOTS_OF_FEW:
        _one_by_one(state, i, first, when)
        return
    agenda = state.agenda
    store(agenda.slot_time, i, slot, when)
    store(agenda.slot_partner, i, slot, others)
    store(agenda.slot_change, i, slot, gather(state.changes, 0, others))
