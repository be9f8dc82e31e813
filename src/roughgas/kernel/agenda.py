"""Upcoming events: a short list of contacts per particle, and the earliest event of all."""

import math

import numpy as np
from numba import types
from numba.extending import intrinsic, overload

from roughgas.kernel.jit import jit
from roughgas.kernel.state import BLOCK, BOUNDARY, HORIZON, NOTHING


@jit
def clear_contacts(agenda, i, complete_until):
    """Forget particle i's contacts; those added next are complete until the given time."""
    agenda.filled[i] = 0
    agenda.complete_until[i] = complete_until


@jit
def add_contact(agenda, i, time, partner, change, wanted):
    """Add a contact to particle i's list if it is wanted; of a full list the latest one drops out.

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
def choose_next(agenda, i):
    """Make the earliest event of particle i its entry in the queue."""
    time = agenda.complete_until[i]
    kind = HORIZON
    for k in range(int(agenda.filled[i])):
        earlier = agenda.slot_time[i, k] <= time
        time = agenda.slot_time[i, k] if earlier else time
        kind = k if earlier else kind
    if agenda.boundary_time[i] < time:
        time = agenda.boundary_time[i]
        kind = BOUNDARY
    if time == math.inf:
        kind = NOTHING
    agenda.kind[i] = kind
    enter_in_queue(agenda, i, time)


@jit
def enter_in_queue(agenda, i, time):
    """Make `time` that of particle i's next event.

    Times are compared as integers, which order like the non-negative doubles they are the bits
    of: integer minima have no NaN to mind and run through the vector registers. What is stored is
    not loaded again at once: the processor would wait for it.
    """
    bits, block = agenda.bits, i // BLOCK
    new = float_bits(time)
    least = new
    for k in range(BLOCK):
        place = BLOCK * block + k
        least = min(least, new if place == i else bits[place])
    bits[i] = new
    agenda.least[block] = least


@jit
def earliest(agenda):
    """The particle whose event comes first; of several at the same instant, the first."""
    least, block = agenda.least[0], 0
    for k in range(1, agenda.least.size):
        earlier = agenda.least[k] < least
        least = agenda.least[k] if earlier else least
        block = k if earlier else block
    place = agenda.key.size
    for k in range(BLOCK * block, BLOCK * (block + 1)):
        place = min(place, k if agenda.bits[k] == least else agenda.key.size)
    return place


def float_bits(x):
    """The bits of a double as an integer."""
    return int(np.float64(x).view(np.int64))


@intrinsic
def _bitcast(context, x):
    def generate(context, builder, signature, arguments):
        return builder.bitcast(arguments[0], context.get_value_type(signature.return_type))

    return types.int64(types.float64), generate


@overload(float_bits)
def _compiled_float_bits(x):
    return lambda x: _bitcast(x)
