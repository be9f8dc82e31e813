"""Event lists: the upcoming events of each particle, and a queue for the earliest of all events.

A particle's events are a few contacts, an event of an effect (boundary), and the end of the time
for which its contacts are predicted (horizon). The earliest of them is its entry in the queue:
blocks of keys for few particles, a calendar for many.
"""

import math

from roughgas.compiling.jit import compiled, jit
from roughgas.compiling.lanes import (
    assume_nonnegative,
    bits,
    choose,
    horizontal_min,
    iota,
    load,
    prefetch,
    store,
    trailing_zeros,
)
from roughgas.kernel.layout import BLOCK, SWEEP_SLOTS
from roughgas.kernel.size_classes import grid_of_cell
from roughgas.kernel.state import (
    BOUNDARY,
    HORIZON,
    LONGEST_HORIZON,
    NOBODY,
    NOTHING,
    NOW,
    SPAN,
    TYPICAL_SPEED,
)

PREFETCHED = 10  # entries of a neighbour list, most of them
FIT_IN_CACHE = 2048  # days of a calendar: prefetching gains nothing for fewer
FLIGHTS_AHEAD = 2.5  # mean free flights within the horizon
LAST_DAY = 2.0**62
EVENTS_A_DAY = 2.0  # on average: day lists are short, and empty days rare
MAX_PACE_FACTOR = 8.0  # change of the pace at once
MAX_DAYS = 2.0**40  # in a span: simultaneous events do not determine a pace

# ------------------------------------------------------------------ prefetching


@jit
def prefetch_calendar(state, day):
    """Prefetch the memory that events after `day`, a day's number in the calendar, need.

    A cache miss takes as long as a hundred additions, and an event has some twenty. Each stage
    follows references that an earlier stage has fetched: first the particles on a day's list, a day
    later their partners and the heads of the adjacent cells' lists, then the particles on those.
    Particle 0 stands for a missing particle: a branch would be mispredicted.
    """
    queue = state.queue
    _prefetch_particle(state, _first_of(queue, day + 5))
    first = _first_of(queue, day + 4)
    _prefetch_particle(state, _or_zero(queue.later[first]))
    _prefetch_partner(state, first)
    first = _first_of(queue, day + 3)
    second = _or_zero(queue.later[first])
    _prefetch_particle(state, _or_zero(queue.later[second]))
    _prefetch_partner(state, second)
    _prefetch_surroundings(state, first)
    _prefetch_surroundings(state, _or_zero(queue.later[_first_of(queue, day + 2)]))


@jit
def _first_of(queue, day):
    """Return the first particle on a day's list, 0 if the list is empty."""
    return _or_zero(queue.first[assume_nonnegative(day & (queue.first.size - 1))])


@jit
def _or_zero(i):
    """Return particle i, or particle 0 in place of NOBODY."""
    return max(int(i), 0)


@jit
def _prefetch_particle(state, i):
    """Prefetch the path, spin and events of particle i."""
    prefetch(state.agenda.key, i)
    prefetch(state.trajectory, i)
    if len(state.cells.counts) == 3:  # of a disk they are in the trajectory's cache line
        prefetch(state.label, i)
        if state.spin is not None:
            prefetch(state.spin, i)
    if state.cells.neighbours is not None:  # a row has two cache lines
        prefetch(state.cells.neighbours.middle, i)
        prefetch(state.cells.neighbours.number, i)


@jit
def _prefetch_partner(state, i):
    """Prefetch the partner in particle i's next contact, and the heads of adjacent cells' lists."""
    cells = state.cells
    _prefetch_particle(state, _partner_of(state, i))
    if cells.neighbours is None:
        rows = _rows_around(state, i)
        for k in range(len(rows)):
            prefetch(cells.first, rows[k])


@jit
def _partner_of(state, i):
    """Return the partner in particle i's next contact; i itself if it has another event next."""
    agenda = state.agenda
    partner = int(agenda.slot_partner[i, _or_zero(agenda.kind[i])])
    return partner if agenda.kind[i] >= 0 else i


@jit
def _prefetch_surroundings(state, i):
    """Prefetch the particles on the neighbour lists of particle i and its next partner.

    Without lists the first particles in adjacent cells are prefetched.
    """
    cells = state.cells
    if cells.neighbours is not None:
        j = _partner_of(state, i)
        for k in range(PREFETCHED):
            prefetch(state.trajectory, cells.neighbours.members[i, k])
            prefetch(state.trajectory, cells.neighbours.members[j, k])
        return
    rows = _rows_around(state, i)
    for k in range(len(rows)):
        for along in range(3):
            prefetch(state.trajectory, int(cells.first[rows[k] + along]))


@jit
def _rows_around(state, i):
    """Return the first cell of each row of three adjacent cells around the cell of i's next event.

    The cell is the particle's home, or the cell that it enters. Approximate at the edges of the
    box.
    """
    cells, heading, flat = state.cells, int(state.cells.heading[i]), len(state.cells.counts) == 2
    counts = grid_of_cell(cells, cells.home[i]).counts
    row, level = counts[0], counts[0] * counts[1]
    stride = 1 if heading < 2 else row if heading < 4 else level
    step = stride if heading % 2 == 1 else -stride
    begin = cells.home[i] - 1 + (step if state.agenda.kind[i] < 0 else 0)
    return tuple(
        max(0, min(begin + (k % 3 - 1) * row + (k // 3 - 1 + flat) * level, cells.first.size - 3))
        for k in range(3 if flat else 9)
    )


# ------------------------------------------------------------------ linked lists


@jit
def push_front(first, following, k, i):
    """Insert particle i at the head of linked list k.

    `first` has the head of each list, `following` (N,) the next particle on the list of each
    particle.
    """
    following[i] = first[k]
    first[k] = i


@jit
def unlink(first, following, k, i):
    """Remove particle i from linked list k; `first` and `following` are as in `push_front`."""
    before = assume_nonnegative(int(first[k]))
    if before == i:
        first[k] = following[i]
        return
    after = assume_nonnegative(int(following[before]))
    while after != i:
        before = after
        after = assume_nonnegative(int(following[before]))
    following[before] = following[i]


# ------------------------------------------------------------------ the queue


@jit
def enter_in_queue(state, i, time):
    """Set the time of particle i's next event in the queue; inf if it has none."""
    if state.cells is None:
        _enter_in_blocks(state, i, time)
    else:
        _enter_in_calendar(state, i, time)


@jit
def earliest(state):
    """Return the number of the particle with the earliest event in the queue."""
    return _earliest_in_blocks(state) if state.cells is None else _earliest_in_calendar(state)


@jit
def _enter_in_blocks(state, i, time):
    """Set the time of particle i's next event in its block, and the block's minimum."""
    queue, block = state.queue, i // BLOCK
    keys = _store_key(queue.keys, block, i % BLOCK, time)
    first = horizontal_min(keys)
    queue.whose[block] = BLOCK * block + trailing_zeros(bits(keys == first))
    _store_key(queue.least, block // BLOCK, block % BLOCK, first)


@jit
def _store_key(blocks, block, k, time):
    """Store a time as entry k of a block, and return the block's times.

    `blocks` has the shape (blocks, BLOCK). The block is stored as one vector, as it is loaded: a
    vector load right after scalar stores would stall.
    """
    times = choose(iota(BLOCK) == k, time, load(blocks, block, 0, BLOCK))
    store(blocks, block, 0, times)
    return times


@jit
def _earliest_in_blocks(state):
    """Return the particle with the earliest event, from the minima of the blocks."""
    queue = state.queue
    first, block = math.inf, 0
    for k in range(len(queue.least)):
        candidates = load(queue.least, k, 0, BLOCK)
        if horizontal_min(candidates) < first:
            first = horizontal_min(candidates)
            block = BLOCK * k + trailing_zeros(bits(candidates == first))
    return queue.whose[assume_nonnegative(block)]


@jit
def _enter_in_calendar(state, i, time):
    """Set the time of particle i in the calendar, at a cost independent of the number of particles.

    A day shares its list with the same day of other years.
    """
    queue, key = state.queue, state.agenda.key
    if key[i] < math.inf:
        list_index = day_of(queue, key[i]) & (queue.first.size - 1)
        unlink(queue.first, queue.later, list_index, i)
    key[i] = time
    if time < math.inf:
        day = day_of(queue, time)
        push_front(queue.first, queue.later, day & (queue.first.size - 1), i)
        queue.today[0] = min(queue.today[0], day)


@jit
def day_of(queue, time):
    """Return the number of the calendar's day for a time; all late times share LAST_DAY."""
    return int(min(time * queue.pace[0], LAST_DAY))


@jit
def _earliest_in_calendar(state):
    """Return the particle with the earliest event, by a search from today's list on."""
    queue, key = state.queue, state.agenda.key
    queue.events[0] += 1
    days = queue.today[0] - queue.since[0]
    if 4 * queue.events[0] > queue.first.size or days > queue.first.size:
        _adjust_pace(state, days)
    day = queue.today[0]
    for _ in range(queue.first.size):
        earliest_time, particle = math.inf, NOBODY
        i = int(queue.first[assume_nonnegative(day & (queue.first.size - 1))])
        while i != NOBODY and earliest_time > state.clock[NOW]:  # nothing comes before now
            i = assume_nonnegative(i)
            if key[i] < earliest_time and day_of(queue, key[i]) <= day:
                earliest_time, particle = key[i], i
            i = int(queue.later[i])
        if particle != NOBODY:
            queue.today[0] = day
            return particle
        day += 1
        if queue.first.size > FIT_IN_CACHE:
            prefetch_calendar(state, day)
    return _earliest_of_all(state)


@jit
def _earliest_of_all(state):
    """Return the particle with the earliest event, by a search over all, for an empty year."""
    key = state.agenda.key
    particle = 0
    for i in range(key.size):
        if key[i] < key[particle]:
            particle = i
    if key[particle] < math.inf:
        state.queue.today[0] = day_of(state.queue, key[particle])
    return particle


@compiled
def _adjust_pace(state, days):
    """Change the length of days if they do not hold about EVENTS_A_DAY each.

    `days` have passed since the count of events began. Event rates vary: a layer makes most of its
    contacts within a tenth of a stroke, when it lands.
    """
    queue = state.queue
    factor = queue.events[0] / (EVENTS_A_DAY * max(days, 1))
    factor = 1.0 if 0.5 < factor < 2.0 else min(max(factor, 1.0 / MAX_PACE_FACTOR), MAX_PACE_FACTOR)
    _set_pace(state, min(queue.pace[0] * factor, MAX_DAYS / state.clock[SPAN]))


@jit
def _set_pace(state, pace):
    """Set the number of days per time, `pace`, and restart the count of events.

    All particles are listed anew if it has changed.
    """
    queue, key = state.queue, state.agenda.key
    if pace != queue.pace[0]:
        queue.pace[0] = pace
        queue.first[:] = NOBODY
        for i in range(key.size):
            if key[i] < math.inf:
                push_front(
                    queue.first, queue.later, day_of(queue, key[i]) & (queue.first.size - 1), i
                )
        queue.today[0] = day_of(queue, state.clock[NOW])
    queue.events[0], queue.since[0] = 0, queue.today[0]


@jit
def clear_calendar(state):
    """Empty the calendar, and set the length of days to about EVENTS_A_DAY each."""
    state.agenda.key[:] = math.inf
    clock = state.clock
    crossings = 2.0 * clock[TYPICAL_SPEED] / max(state.cells.widths)
    contacts = 4.0 * FLIGHTS_AHEAD / clock[LONGEST_HORIZON]  # 0 before any horizon is set
    pace = len(state.changes) * (crossings + contacts) / EVENTS_A_DAY
    state.queue.pace[0] = 0.0  # a change, so that all particles are re-listed
    _set_pace(state, pace if pace > 0.0 else 1.0)
    state.queue.events[0] = -len(state.changes)  # the first predictions of all are simultaneous


# ------------------------------------------------------------------ events of a particle


@jit
def clear_contacts(agenda, i, complete_until):
    """Remove particle i's contacts; the contacts added next are complete until the given time.

    `agenda` is State.agenda.
    """
    for k in range(agenda.slot_time.shape[1]):
        agenda.slot_time[i, k] = math.inf
    agenda.complete_until[i] = complete_until


@jit
def add_contact(agenda, i, time, partner, change):
    """Store a contact in the slot of particle i's latest contact, if the new one is earlier.

    `agenda` is State.agenda, `time` the time of the contact, `partner` the other particle, `change`
    the partner's State.changes at the prediction. A time of inf is no contact, and marks a free
    slot.
    """
    times = agenda.slot_time
    latest = 0
    for k in range(1, times.shape[1]):
        if times[i, k] > times[i, latest]:
            latest = k
    agenda.complete_until[i] = min(agenda.complete_until[i], max(time, times[i, latest]))
    if time < times[i, latest]:
        times[i, latest] = time
        agenda.slot_partner[i, latest] = partner
        agenda.slot_change[i, latest] = change


@jit
def queue_next_event(state, i):
    """Make the earliest event of particle i its entry in the queue."""
    agenda = state.agenda
    time, kind = next_contact(state, i)
    if agenda.boundary_time is not None and agenda.boundary_time[i] < time:
        time, kind = agenda.boundary_time[i], BOUNDARY
    if time == math.inf:
        kind = NOTHING
    agenda.kind[i] = kind
    enter_in_queue(state, i, time)


@jit
def next_contact(state, i):
    """Return (time, kind) of particle i's first contact, or of its horizon if that comes first.

    The horizon is the end of the time for which its contacts are predicted. The kind is a contact
    slot, or HORIZON, as in Agenda.kind.
    """
    agenda, kind = state.agenda, HORIZON
    times, time = agenda.slot_time, agenda.complete_until[i]
    if state.cells is None:
        slots = load(times, i, 0, SWEEP_SLOTS)
        first = horizontal_min(slots)
        slot = trailing_zeros(bits(slots == first))
        return (first, slot) if first <= time else (time, HORIZON)
    time = min(time, state.cells.leave[i])
    for k in range(times.shape[1]):
        earlier = times[i, k] <= time
        time = times[i, k] if earlier else time
        kind = k if earlier else kind
    return time, kind


@jit
def predicted_until(state, i):
    """Return an upper bound of the time of particle i's next prediction."""
    until = state.agenda.complete_until[i]
    if state.cells is None or state.cells.neighbours is not None:
        return until  # the time of leaving a region may change without a prediction
    return min(until, state.cells.leave[i])
