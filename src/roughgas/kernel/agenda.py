"""Upcoming events of each particle: a short list of contacts, a boundary, the end of foresight."""

import math

from roughgas.kernel.hooks import either
from roughgas.kernel.jit import jit
from roughgas.kernel.queue import enter_in_queue
from roughgas.kernel.state import BOUNDARY, HORIZON, NOTHING


@jit
def clear_contacts(agenda, i, complete_until):
    """Forget particle i's contacts; those added next are complete until the given time."""
    agenda.filled[i] = 0
    agenda.complete_until[i] = complete_until


@jit
def add_contact(agenda, i, time, partner, change, wanted):
    """Add a contact to particle i's list if it is wanted; a full list drops its latest one.

    Whether it is wanted is a number to add, not a branch to take: the processor could not foresee
    which of the candidates it is.
    """
    filled = int(agenda.filled[i])
    if filled == agenda.slot_time.shape[1]:
        if wanted:
            _replace_latest(agenda, i, time, partner, change)
        return
    agenda.slot_time[i, filled] = time
    agenda.slot_partner[i, filled] = partner
    agenda.slot_change[i, filled] = change
    agenda.filled[i] = filled + wanted


@jit
def _replace_latest(agenda, i, time, partner, change):
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
    last = int(agenda.filled[i]) - 1
    agenda.slot_time[i, slot] = agenda.slot_time[i, last]
    agenda.slot_partner[i, slot] = agenda.slot_partner[i, last]
    agenda.slot_change[i, slot] = agenda.slot_change[i, last]
    agenda.filled[i] = last


@jit
def choose_next(state, i):
    """Make the earliest event of particle i its entry in the queue."""
    agenda = state.agenda
    time = _foresight(state.cells, agenda, i)
    kind = HORIZON
    for k in range(int(agenda.filled[i])):
        earlier = agenda.slot_time[i, k] <= time
        time = agenda.slot_time[i, k] if earlier else time
        kind = k if earlier else kind
    time, kind = _with_boundary(agenda.boundary_time, i, time, kind)
    if time == math.inf:
        kind = NOTHING
    agenda.kind[i] = kind
    enter_in_queue(state.cells, state, i, time)


_foresight = either(
    lambda cells, agenda, i: min(agenda.complete_until[i], cells.leave[i]),
    lambda cells, agenda, i: agenda.complete_until[i],
)


def _sooner_of(boundary_time, i, time, kind):
    if boundary_time[i] < time:
        return boundary_time[i], BOUNDARY
    return time, kind


_with_boundary = either(_sooner_of, lambda boundary_time, i, time, kind: (time, kind))
