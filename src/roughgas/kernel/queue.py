"""Which particle's event comes first: blocks of keys for few particles, a calendar for many."""

import math

from roughgas.kernel.arithmetic import choose
from roughgas.kernel.clock import FLIGHTS
from roughgas.kernel.fetching import fetch_ahead
from roughgas.kernel.hooks import either
from roughgas.kernel.jit import jit
from roughgas.kernel.lanes import bits, least, load, order, store, trailing_zeros
from roughgas.kernel.layout import BLOCK
from roughgas.kernel.links import enter, strike_out
from roughgas.kernel.state import LONGEST_HORIZON, NOBODY, NOW, TYPICAL_SPEED

LAST_DAY = 2.0**62
EVENTS_A_DAY = 2.0  # this many make a day's list short and empty days rare


def _enter_in_blocks(cells, state, i, time):
    queue, block = state.queue, i // BLOCK
    keys = _with(queue.keys, block, i % BLOCK, time)
    _with(queue.least, block // BLOCK, block % BLOCK, least(keys))


@jit
def _with(blocks, block, place, time):
    """Put a time in its place in a block, and return the block.

    It is stored as a whole, as it is read: a read of several stores at once has to wait for them.
    """
    times = choose(order(BLOCK) == place, time, load(blocks, block, 0, BLOCK))
    store(blocks, block, 0, times)
    return times


def _earliest_in_blocks(cells, state):
    queue = state.queue
    first, block = math.inf, 0
    for k in range(len(queue.least)):
        candidates = load(queue.least, k, 0, BLOCK)
        if least(candidates) < first:
            first = least(candidates)
            block = BLOCK * k + trailing_zeros(bits(candidates == first))
    keys = load(queue.keys, block, 0, BLOCK)
    return BLOCK * block + trailing_zeros(bits(keys == first))


def _enter_in_calendar(cells, state, i, time):
    """A day shares its list with the same day of other years. An entry costs the same among a
    thousand particles as among a million."""
    queue, key = state.queue, state.agenda.key
    if key[i] < math.inf:
        place = day_of(queue, key[i]) & (queue.first.size - 1)
        strike_out(queue.first, queue.later, queue.sooner, place, i)
    key[i] = time
    if time < math.inf:
        day = day_of(queue, time)
        enter(queue.first, queue.later, queue.sooner, day & (queue.first.size - 1), i)
        queue.today[0] = min(queue.today[0], day)


@jit
def day_of(queue, time):
    """Return the day of a time; far ones share the last day."""
    return int(min(time * queue.pace[0], LAST_DAY))


def _earliest_in_calendar(cells, state):
    queue, key = state.queue, state.agenda.key
    day = queue.today[0]
    for _ in range(queue.first.size):
        least, place = math.inf, NOBODY
        i = queue.first[day & (queue.first.size - 1)]
        while i != NOBODY and least > state.clock[NOW]:  # nothing comes before now
            if key[i] < least and day_of(queue, key[i]) <= day:
                least, place = key[i], i
            i = queue.later[i]
        if place != NOBODY:
            queue.today[0] = day
            return place
        day += 1
        fetch_ahead(state, day)
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


@jit
def clear_calendar(state, cells, scene):
    """Empty the calendar, and set its days to hold about EVENTS_A_DAY each."""
    queue = state.queue
    for place in range(queue.first.size):
        queue.first[place] = NOBODY
    for i in range(len(state.changes)):
        state.agenda.key[i] = math.inf
    clock = state.clock
    crossings = 2.0 * clock[TYPICAL_SPEED] / max(cells.widths)
    contacts = 4.0 * FLIGHTS / clock[LONGEST_HORIZON]  # none where nothing is known yet
    pace = len(state.changes) * (crossings + contacts) / EVENTS_A_DAY
    queue.pace[0] = pace if pace > 0.0 else 1.0
    queue.today[0] = day_of(queue, clock[NOW])


enter_in_queue = either(_enter_in_calendar, _enter_in_blocks)
earliest = either(_earliest_in_calendar, _earliest_in_blocks)
