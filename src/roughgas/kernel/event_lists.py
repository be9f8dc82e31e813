"""What comes next: the upcoming events of each particle, and whose event is the earliest.

A particle's events are a short list of contacts, a boundary, and the end of its foresight. The
earliest of them is its entry in the queue: blocks of keys for few particles, a calendar for many.
"""

import math

from roughgas.compiling.jit import compiled, jit
from roughgas.compiling.lanes import (
    bits,
    choose,
    index,
    least,
    load,
    order,
    prefetch,
    store,
    trailing_zeros,
)
from roughgas.kernel.memory import BLOCK, SLOTS_OF_FEW
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

FETCHED = 8  # of a particle's list, about all that are on it
FIT_IN_CACHE = 2048  # particles, for whose memory no event has to wait
FLIGHTS = 2.5  # mean free flights to foresee
LAST_DAY = 2.0**62
EVENTS_A_DAY = 2.0  # this many make a day's list short and empty days rare
GREATEST_CHANGE = 8.0  # of the days' length at once
MOST_DAYS = 2.0**40  # in a span: events at one instant tell nothing of how long a day should be

# ------------------------------------------------------------------ what to fetch ahead


@jit
def prefetch_calendar(state, day):
    """Ask the memory for what the events after `day` need, so that they need not wait for it.

    A read that the caches cannot answer takes as long as a hundred additions, and an event has some
    twenty of them. Only what has arrived can tell what is needed next: first the particles on a
    day's list, a day later their partners and the lists of the cells around, then who is on these.
    Particle 0 stands for one that is not there, since the processor could not foresee a branch.
    """
    queue = state.queue
    _fetch(state, _first_of(queue, day + 5))
    first = _first_of(queue, day + 4)
    _fetch(state, _or_zero(queue.later[first]))
    _fetch_next(state, first)
    first = _first_of(queue, day + 3)
    second = _or_zero(queue.later[first])
    _fetch(state, _or_zero(queue.later[second]))
    _fetch_next(state, second)
    _fetch_around(state, first)
    _fetch_around(state, _or_zero(queue.later[_first_of(queue, day + 2)]))


@jit
def _first_of(queue, day):
    return _or_zero(queue.first[index(day & (queue.first.size - 1))])


@jit
def _or_zero(i):
    return max(int(i), 0)


@jit
def _fetch(state, i):
    """Ask for particle i."""
    prefetch(state.agenda.key, i)
    prefetch(state.trajectory, i)
    if len(state.cells.counts) == 3:  # a disk has these in the same line
        prefetch(state.label, i)
        if state.spin is not None:
            prefetch(state.spin, i)
    if state.cells.neighbours is not None:
        prefetch(state.cells.neighbours.members, i)


@jit
def _fetch_next(state, i):
    """Ask for the partner of particle i, and for which particles are first in the cells around."""
    agenda, cells = state.agenda, state.cells
    partner = int(agenda.slot_partner[i, _or_zero(agenda.kind[i])])
    _fetch(state, partner if agenda.kind[i] >= 0 else i)
    if cells.neighbours is None:
        rows = _rows_around(state, i)
        for k in range(len(rows)):
            prefetch(cells.first, rows[k])


@jit
def _fetch_around(state, i):
    """Ask for those on the list of particle i, or first in the cells around."""
    cells = state.cells
    if cells.neighbours is not None:
        for k in range(FETCHED):
            prefetch(state.trajectory, cells.neighbours.members[i, k])
        return
    rows = _rows_around(state, i)
    for k in range(len(rows)):
        for along in range(3):
            prefetch(state.trajectory, int(cells.first[rows[k] + along]))


@jit
def _rows_around(state, i):
    """Return the first cells of the rows of three around where the next event of particle i is: at
    home, or in the cell that it enters. At the edges of the box they are others."""
    cells, heading, flat = state.cells, int(state.cells.heading[i]), len(state.cells.counts) == 2
    row, level = cells.counts[0], cells.counts[0] * cells.counts[1]
    stride = 1 if heading < 2 else row if heading < 4 else level
    step = stride if heading % 2 == 1 else -stride
    begin = cells.home[i] - 1 + (step if state.agenda.kind[i] < 0 else 0)
    return tuple(
        max(0, min(begin + (k % 3 - 1) * row + (k // 3 - 1 + flat) * level, cells.first.size - 3))
        for k in range(3 if flat else 9)
    )


# ------------------------------------------------------------------ linked lists


@jit
def enter(first, following, place, i):
    """Put particle i first on the list of a place."""
    following[i] = first[place]
    first[place] = i


@jit
def unlink(first, following, place, i):
    """Take particle i off the list of a place."""
    before = index(int(first[place]))
    if before == i:
        first[place] = following[i]
        return
    after = index(int(following[before]))
    while after != i:
        before = after
        after = index(int(following[before]))
    following[before] = following[i]


# ------------------------------------------------------------------ the queue


@jit
def enter_in_queue(state, i, time):
    """Let the next event of particle i be at a time, inf if there is none."""
    if state.cells is None:
        _enter_in_blocks(state, i, time)
    else:
        _enter_in_calendar(state, i, time)


@jit
def earliest(state):
    """Return whose event comes first."""
    return _earliest_in_blocks(state) if state.cells is None else _earliest_in_calendar(state)


@jit
def _enter_in_blocks(state, i, time):
    queue, block = state.queue, i // BLOCK
    keys = _with(queue.keys, block, i % BLOCK, time)
    first = least(keys)
    queue.whose[block] = BLOCK * block + trailing_zeros(bits(keys == first))
    _with(queue.least, block // BLOCK, block % BLOCK, first)


@jit
def _with(blocks, block, place, time):
    """Put a time in its place in a block, and return the block.

    It is stored as a whole, as it is read: a read of several stores at once has to wait for them.
    """
    times = choose(order(BLOCK) == place, time, load(blocks, block, 0, BLOCK))
    store(blocks, block, 0, times)
    return times


@jit
def _earliest_in_blocks(state):
    queue = state.queue
    first, block = math.inf, 0
    for k in range(len(queue.least)):
        candidates = load(queue.least, k, 0, BLOCK)
        if least(candidates) < first:
            first = least(candidates)
            block = BLOCK * k + trailing_zeros(bits(candidates == first))
    return queue.whose[index(block)]


@jit
def _enter_in_calendar(state, i, time):
    """A day shares its list with the same day of other years. An entry costs the same among a
    thousand particles as among a million."""
    queue, key = state.queue, state.agenda.key
    if key[i] < math.inf:
        place = day_of(queue, key[i]) & (queue.first.size - 1)
        unlink(queue.first, queue.later, place, i)
    key[i] = time
    if time < math.inf:
        day = day_of(queue, time)
        enter(queue.first, queue.later, day & (queue.first.size - 1), i)
        queue.today[0] = min(queue.today[0], day)


@jit
def day_of(queue, time):
    """Return the day of a time; far ones share the last day."""
    return int(min(time * queue.pace[0], LAST_DAY))


@jit
def _earliest_in_calendar(state):
    queue, key = state.queue, state.agenda.key
    queue.events[0] += 1
    days = queue.today[0] - queue.since[0]
    if 4 * queue.events[0] > queue.first.size or days > queue.first.size:
        _keep_pace(state, days)
    day = queue.today[0]
    for _ in range(queue.first.size):
        least, place = math.inf, NOBODY
        i = int(queue.first[index(day & (queue.first.size - 1))])
        while i != NOBODY and least > state.clock[NOW]:  # nothing comes before now
            i = index(i)
            if key[i] < least and day_of(queue, key[i]) <= day:
                least, place = key[i], i
            i = int(queue.later[i])
        if place != NOBODY:
            queue.today[0] = day
            return place
        day += 1
        if queue.first.size > FIT_IN_CACHE:
            prefetch_calendar(state, day)
    return _earliest_of_all(state)


@jit
def _earliest_of_all(state):
    """Return whose event is the earliest when nothing happens for a year."""
    key = state.agenda.key
    place = 0
    for i in range(key.size):
        if key[i] < key[place]:
            place = i
    if key[place] < math.inf:
        state.queue.today[0] = day_of(state.queue, key[place])
    return place


@compiled
def _keep_pace(state, days):
    """Let days be shorter, or longer, if they do not hold about EVENTS_A_DAY each.

    A layer makes most of its contacts within a tenth of a stroke, when it lands.
    """
    queue = state.queue
    change = queue.events[0] / (EVENTS_A_DAY * max(days, 1))
    change = 1.0 if 0.5 < change < 2.0 else min(max(change, 1.0 / GREATEST_CHANGE), GREATEST_CHANGE)
    _set_pace(state, min(queue.pace[0] * change, MOST_DAYS / state.clock[SPAN]))


@jit
def _set_pace(state, pace):
    """Begin to count the events; list all particles anew if days are to be of another length."""
    queue, key = state.queue, state.agenda.key
    if pace != queue.pace[0]:
        queue.pace[0] = pace
        queue.first[:] = NOBODY
        for i in range(key.size):
            if key[i] < math.inf:
                enter(queue.first, queue.later, day_of(queue, key[i]) & (queue.first.size - 1), i)
        queue.today[0] = day_of(queue, state.clock[NOW])
    queue.events[0], queue.since[0] = 0, queue.today[0]


@jit
def clear_calendar(state):
    """Empty the calendar, and set its days to hold about EVENTS_A_DAY each."""
    state.agenda.key[:] = math.inf
    clock = state.clock
    crossings = 2.0 * clock[TYPICAL_SPEED] / max(state.cells.widths)
    contacts = 4.0 * FLIGHTS / clock[LONGEST_HORIZON]  # none where nothing is known yet
    pace = len(state.changes) * (crossings + contacts) / EVENTS_A_DAY
    state.queue.pace[0] = 0.0  # all are to be listed anew
    _set_pace(state, pace if pace > 0.0 else 1.0)
    state.queue.events[0] = -len(state.changes)  # that all is foreseen first takes no time


# ------------------------------------------------------------------ events of a particle


@jit
def clear_contacts(agenda, i, complete_until):
    """Forget particle i's contacts; those added next are complete until the given time."""
    for k in range(agenda.slot_time.shape[1]):
        agenda.slot_time[i, k] = math.inf
    agenda.complete_until[i] = complete_until


@jit
def add_contact(agenda, i, time, partner, change):
    """Put a contact in the place of the latest on particle i's list; of the two the earlier stays.

    A time of inf is no contact, and a slot that holds it is free.
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
def choose_next(state, i):
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
    """Return (time, kind) of particle i's first contact, or of the end of its foresight if that
    comes first."""
    agenda, kind = state.agenda, HORIZON
    times, time = agenda.slot_time, agenda.complete_until[i]
    if state.cells is None:
        slots = load(times, i, 0, SLOTS_OF_FEW)
        first = least(slots)
        slot = trailing_zeros(bits(slots == first))
        return (first, slot) if first <= time else (time, HORIZON)
    time = min(time, state.cells.leave[i])
    for k in range(times.shape[1]):
        earlier = times[i, k] <= time
        time = times[i, k] if earlier else time
        kind = k if earlier else kind
    return time, kind


@jit
def foreseen_until(state, i):
    """Return a time at which particle i's whole future is foreseen again, if not before."""
    until = state.agenda.complete_until[i]
    if state.cells is None or state.cells.neighbours is not None:
        return until  # when it leaves its region may change without that
    return min(until, state.cells.leave[i])
