"""Upcoming events: a short sorted list of contacts per particle, and the earliest event of all."""

import math

from roughgas.kernel.jit import jit
from roughgas.kernel.state import BOUNDARY, HORIZON, NOTHING, SLOTS


@jit
def clear_contacts(agenda, i, complete_until):
    """Forget particle i's contacts; those inserted next are complete until the given time."""
    agenda.filled[i] = 0
    agenda.head[i] = 0
    agenda.complete_until[i] = complete_until


@jit
def insert_contact(agenda, i, time, partner, change):
    """Add a contact to particle i's list in order of time; when it is full the latest one drops."""
    times = agenda.slot_time
    filled = agenda.filled[i]
    if filled == SLOTS:
        if not time < times[i, SLOTS - 1]:
            agenda.complete_until[i] = min(agenda.complete_until[i], time)
            return
        agenda.complete_until[i] = times[i, SLOTS - 1]
        filled -= 1
    k = filled
    while k > 0 and time < times[i, k - 1]:
        times[i, k] = times[i, k - 1]
        agenda.slot_partner[i, k] = agenda.slot_partner[i, k - 1]
        agenda.slot_change[i, k] = agenda.slot_change[i, k - 1]
        k -= 1
    times[i, k] = time
    agenda.slot_partner[i, k] = partner
    agenda.slot_change[i, k] = change
    agenda.filled[i] = filled + 1


@jit
def choose_next(agenda, i, changes):
    """Make the earliest event of particle i that is not stale its entry in the queue."""
    head = agenda.head[i]
    filled = agenda.filled[i]
    while head < filled and agenda.slot_change[i, head] != changes[agenda.slot_partner[i, head]]:
        head += 1
    agenda.head[i] = head
    time = agenda.complete_until[i]
    kind = HORIZON
    if head < filled and agenda.slot_time[i, head] <= time:
        time = agenda.slot_time[i, head]
        kind = agenda.slot_partner[i, head]
    if agenda.boundary_time[i] < time:
        time = agenda.boundary_time[i]
        kind = BOUNDARY
    if time == math.inf:
        kind = NOTHING
    agenda.key[i] = time
    agenda.kind[i] = kind


@jit
def is_stale(agenda, i, changes):
    """Whether particle i's next contact is with a partner whose path has changed since."""
    return agenda.slot_change[i, agenda.head[i]] != changes[agenda.kind[i]]


@jit
def earliest(agenda):
    """The particle whose event comes first; of several at the same instant, the first.

    Times are compared as integers, which order like the non-negative doubles they are the bits
    of: integer minima have no NaN to mind and run through the vector registers.
    """
    bits = agenda.bits
    least = bits[0]
    for i in range(bits.size):
        least = min(least, bits[i])
    place = bits.size
    for i in range(bits.size):
        place = min(place, i if bits[i] == least else bits.size)
    return place
