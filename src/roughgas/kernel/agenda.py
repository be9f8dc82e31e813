"""Upcoming events of each particle: a short list of contacts, a boundary, the end of foresight."""

import math

from roughgas.kernel.hooks import either
from roughgas.kernel.jit import jit
from roughgas.kernel.lanes import bits, least, load, store, trailing_zeros
from roughgas.kernel.layout import SLOTS_OF_FEW
from roughgas.kernel.queue import enter_in_queue
from roughgas.kernel.state import BOUNDARY, HORIZON, NOTHING


@jit
def clear_contacts(agenda, i, complete_until):
    """Forget particle i's contacts; those added next are complete until the given time."""
    for k in range(agenda.slot_time.shape[1]):
        agenda.slot_time[i, k] = math.inf
    agenda.complete_until[i] = complete_until


@jit
def set_contacts(agenda, i, first, times, partners, changes):
    """Fill particle i's list from slot `first` on with lanes, one to a slot; inf is no contact."""
    store(agenda.slot_time, i, first, times)
    store(agenda.slot_partner, i, first, partners)
    store(agenda.slot_change, i, first, changes)


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
def drop_contact(agenda, i, slot):
    """Take a contact off particle i's list."""
    agenda.slot_time[i, slot] = math.inf


@jit
def choose_next(state, i):
    """Make the earliest event of particle i its entry in the queue."""
    agenda = state.agenda
    time, kind = _with_contact(state.cells, agenda, i, _foresight(state.cells, agenda, i))
    time, kind = _with_boundary(agenda.boundary_time, i, time, kind)
    if time == math.inf:
        kind = NOTHING
    agenda.kind[i] = kind
    enter_in_queue(state.cells, state, i, time)


def _of_two(cells, agenda, i, time):
    kind = HORIZON
    for k in range(agenda.slot_time.shape[1]):
        earlier = agenda.slot_time[i, k] <= time
        time = agenda.slot_time[i, k] if earlier else time
        kind = k if earlier else kind
    return time, kind


def _of_eight(cells, agenda, i, time):
    times = load(agenda.slot_time, i, 0, SLOTS_OF_FEW)
    first = least(times)
    slot = trailing_zeros(bits(times == first))
    return (first, slot) if first <= time else (time, HORIZON)


_with_contact = either(_of_two, _of_eight)

_foresight = either(
    lambda cells, agenda, i: min(agenda.complete_until[i], cells.leave[i]),
    lambda cells, agenda, i: agenda.complete_until[i],
)


def _sooner_of(boundary_time, i, time, kind):
    if boundary_time[i] < time:
        return boundary_time[i], BOUNDARY
    return time, kind


_with_boundary = either(_sooner_of, lambda boundary_time, i, time, kind: (time, kind))
