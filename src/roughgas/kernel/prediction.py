"""Times of contact of a particle with its candidates, for several candidates at a time.

The time is exact, in double precision, and a function of the two paths alone. It does not depend on
the time of its prediction, nor on the order of the two particles, so that the scheduler cannot
change a trajectory. A path is (position, velocity, their time), continued in free flight.
"""

import math

import numpy as np

from roughgas.compiling.jit import compiled, jit
from roughgas.compiling.lanes import (
    assume_nonnegative,
    bits,
    choose,
    gather,
    gather_rows,
    iota,
    lanes_of,
    larger,
    load,
    load_scalars,
    smaller,
    sqrt,
    store,
    trailing_zeros,
)
from roughgas.kernel import hooks
from roughgas.kernel.event_lists import add_contact
from roughgas.kernel.layout import SWEEP_SLOTS
from roughgas.kernel.mathematics import add_scaled, cross_squared, dot, subtract
from roughgas.kernel.particles import (
    contact_distance,
    free_flight,
    image_numbers,
    image_shift_at,
    largest_of,
    path_of,
    radius_of,
    shifted,
    single_image_limit,
)


@jit
def time_to_contact(x, u, distance):
    """Return the time until two particles touch that are at separation x with relative velocity u.

    They touch at the contact distance `distance`; inf if they never do. The components of x and u,
    and the distance, may be SIMD lanes, for several pairs at once.

    A pair that touches or overlaps (by rounding) collides at once if it approaches, and never if it
    recedes. The smaller root is formed by division, so that no digits cancel when the particles are
    close, and the discriminant from the cross product, so that none cancel when they are far apart.
    For a pair that touches to within rounding, root - b may be almost 0: a contact is therefore
    never later than the closest approach. Roots and quotients are computed unconditionally: a
    mispredicted branch would cost more, and branch-free code handles several pairs at once.
    """
    b, uu = dot(x, u), dot(u, u)
    c = dot(x, x) - distance * distance
    discriminant = distance * distance * uu - cross_squared(x, u)
    time = larger(c, 0.0) / (sqrt(larger(discriminant, 0.0)) - b)
    time = smaller(time, -b / uu)
    meets = (b < 0.0) & ((discriminant >= 0.0) | (c <= 0.0))
    return choose(meets, time, math.inf)


@jit
def first_contact(path_i, path_j, box, gravity, image_shift, middle, limit, distance):
    """Return the time of the first contact of two paths, and whether other images might be met.

    A path is (position, velocity, time), for several particles j in SIMD lanes; the time of contact
    is inf if there is none. `gravity` is the acceleration as in `free_flight`; `distance` is the
    contact distance, `image_shift` holds at the clock's base. Only the nearest image at time
    `middle` can be met as long as the pair moves less than half a box, minus a diameter, from
    there: if its squared relative speed is no more than `limit`, the single_image_limit.
    """
    since = larger(path_i[2], path_j[2])
    position_i, velocity_i = free_flight(path_i, since, gravity)
    position_j, velocity_j = free_flight(path_j, since, gravity)
    x = subtract(position_j, position_i)
    u = subtract(velocity_j, velocity_i)
    numbers = image_numbers(
        add_scaled(x, u, middle - since), box, image_shift_at(image_shift, middle)
    )
    x, u = shifted(x, u, numbers, box, image_shift_at(image_shift, since))
    time = since + time_to_contact(x, u, distance)
    return time, False if limit is None else dot(u, u) > limit


@compiled
def first_contact_of_images(path_i, path_j, box, gravity, image_shift, start, end, distance):
    """Return the time of the first contact of any images of two paths in [start, end], or inf.

    A path is (position, velocity, time). `gravity` is the acceleration as in `free_flight`;
    `distance` is the contact distance of the pair, `image_shift` holds at the clock's base. The
    interval is bisected until in each segment only the nearest image can be met.
    """
    segments = 2
    k = 0
    while k < segments:
        length = (end - start) / segments
        middle = start + (k + 0.5) * length
        limit = single_image_limit(box, 0.5 * length, distance)
        time, ambiguous = first_contact(
            path_i, path_j, box, gravity, image_shift, middle, limit, distance
        )
        if ambiguous:
            segments *= 2
            k *= 2
        elif time <= start + (k + 1) * length:
            return time
        else:
            k += 1
    return math.inf


@jit
def predict_contacts(state, scene, i, begin, beyond, time):
    """Predict the contacts of particle i with its candidates from `time` on, and enter them.

    They are entered on its agenda. Candidates are the entries of the shortlist from index `begin`
    up to, but not including, `beyond`. After a sweep all images count, up to the particle's
    horizon; in cells only the nearest. Entries past the last candidate are valid particle numbers;
    their result is discarded.
    """
    box, bodies = scene.box, state.bodies
    path = path_of(state.trajectory, i, box)
    gravity = hooks.acceleration(scene.effects)
    image_shift = hooks.image_shift(scene.effects, state)
    middle, end, limit = time, math.inf, None
    if state.cells is None:
        end = state.agenda.complete_until[i]
        half = 0.5 * (end - time)
        middle, limit = time + half, single_image_limit(box, half, 2.0 * largest_of(bodies))
    first, unfinished, lanes = begin, True, lanes_of(state.shortlist.when)
    while unfinished:  # at least once, and rarely more often: the branch is well predicted
        partners = load_scalars(state.shortlist.found, first, lanes)
        paths = _paths_of(state.trajectory, partners, box)
        distance = radius_of(bodies, i) + (
            1.0 if bodies is None else gather(bodies.radius, 0, partners)
        )
        when, ambiguous = first_contact(
            path, paths, box, gravity, image_shift, middle, limit, distance
        )
        listed = iota(lanes) < beyond - first
        batch = path, first, listed
        when = _with_all_images(limit, state, scene, i, batch, time, end, when, ambiguous)
        if state.cells is None:
            listed = listed & (when <= end)
        when = choose(listed, when, math.inf)
        _enter_contacts(state, i, first - begin, first, partners, when)
        first += lanes
        unfinished = first < beyond


@jit
def _paths_of(trajectory, particles, box):
    """Return (position, velocity, time) of several particles, in lanes as their numbers are."""
    columns, dimension = gather_rows(trajectory, particles, box + box + (0.0,)), len(box)
    return (
        tuple(columns[k] for k in range(dimension)),
        tuple(columns[dimension + k] for k in range(dimension)),
        columns[2 * dimension],
    )


@jit
def _with_all_images(limit, state, scene, i, batch, start, end, when, ambiguous):
    """Return the times of contact, recomputed for all images where other images might be met.

    `batch` is (path of i, index of its first candidate in the shortlist, mask of true candidates);
    `when` are the times of the batch, `ambiguous` is the mask of pairs that might meet other images
    in [start, end]; `limit` is the single_image_limit, None without periodic axes.
    """
    if limit is None:
        return when
    path, first, listed = batch
    undecided = bits(ambiguous & listed)
    if undecided == 0:
        return when
    shortlist, box = state.shortlist, scene.box
    gravity = hooks.acceleration(scene.effects)
    image_shift = hooks.image_shift(scene.effects, state)
    store(shortlist.when, 0, 0, when)
    while undecided != 0:
        k = trailing_zeros(undecided)
        j = shortlist.found[first + k]
        partner_path = path_of(state.trajectory, j, box)
        distance = contact_distance(state.bodies, i, j)
        time = first_contact_of_images(
            path, partner_path, box, gravity, image_shift, start, end, distance
        )
        shortlist.when[0, k] = time
        undecided &= undecided - np.uint64(1)
    return load(shortlist.when, 0, 0, lanes_of(shortlist.when))


@jit
def _add_contacts(state, i, first, when):
    """Add the contacts at the finite times `when` to particle i's agenda, one by one.

    `first` is the index in the shortlist of the first of these candidates.
    """
    agenda, shortlist = state.agenda, state.shortlist
    store(shortlist.when, 0, 0, when)
    contacts = bits(when < math.inf)
    while contacts != np.uint64(0):
        k = trailing_zeros(contacts)
        j = assume_nonnegative(int(shortlist.found[assume_nonnegative(first + k)]))
        add_contact(agenda, i, shortlist.when[0, k], j, state.changes[j])
        contacts &= contacts - np.uint64(1)


@jit
def _enter_contacts(state, i, slot, first, partners, when):
    """Enter contacts in particle i's slots: a batch at once, where each candidate has a slot.

    `slot` is the first slot, `first` the index of the first candidate in the shortlist; `partners`
    are the candidates' numbers, `when` the times of contact, inf for none, in lanes.
    """
    if state.cells is not None or slot + lanes_of(state.shortlist.when) > SWEEP_SLOTS:
        _add_contacts(state, i, first, when)
        return
    agenda = state.agenda
    store(agenda.slot_time, i, slot, when)
    store(agenda.slot_partner, i, slot, partners)
    store(agenda.slot_change, i, slot, gather(state.changes, 0, partners))
