"""A cooling gas of up to 700 rough disks, written by hand for this scene alone.

It has the algorithm of roughgas.kernel, and the same results to the last bit, but vectors are left
to LLVM, and candidates are listed by a loop. Two periodic dimensions are written out, and
there are no hooks for effects. The difference in speed is the cost of the kernel's generality
(benchmarks/generality.py). It is compiled with the same decorators.

Candidates, contact times and collisions are in handwritten_contacts.py.
"""

import math
from typing import NamedTuple

import numpy as np

from benchmarks.handwritten_contacts import (
    BATCH,
    ROUNDING,
    collide,
    contact_time_of_any_image,
    contact_times,
    list_candidates,
    mark_candidates,
    update_line,
)
from roughgas.compiling.jit import compiled, entry, jit

NOW, SPAN, SPEED, MAX_HORIZON, INSTANT_END = range(5)  # of Gas.clock
COLLISIONS_MADE, SINCE_REBASE, SIMULTANEOUS_EVENTS, SLOW_CONTACTS, IS_STARTED = range(
    5
)  # of Gas.counts
HORIZON, NOTHING = -1, -3
SLOTS, BLOCK, LANES = 8, 16, 16  # contacts stored per disk, disks per block, per vector


class Gas(NamedTuple):
    """State of the gas; lengths in radii."""

    width: float
    height: float
    r: float
    beta: float
    q: float
    path: np.ndarray  # (N, 5) x, y, velocities, and the time of this position
    spin: np.ndarray  # (N,) surface velocity
    changes: np.ndarray  # (N,) number of collisions
    key: np.ndarray  # (N padded,) time of the next event
    bits: np.ndarray  # the same memory as integers, which have the same order
    block_minima: np.ndarray  # (blocks,) smallest of each block of bits
    kind: np.ndarray  # (N,) slot of the next contact, or HORIZON or NOTHING
    slot_time: np.ndarray  # (N, 8) upcoming contacts
    slot_partner: np.ndarray  # (N, 8)
    slot_change: np.ndarray  # (N, 8) `changes` of the partner at the prediction
    filled: np.ndarray  # (N,) slots in use
    complete_until: np.ndarray  # (N,) time before which no contact is missing
    lines: np.ndarray  # (4, N padded) x, y and velocities at time 0, in single precision
    marks: np.ndarray  # (N padded,) whether the disk is a candidate
    mark_words: np.ndarray  # the same memory, eight at a time
    packed: np.ndarray  # a bit for each mark
    packed_words: np.ndarray  # the same memory
    candidates: np.ndarray  # (capacity,)
    candidate_paths: np.ndarray  # (5, capacity)
    contact_time: np.ndarray  # (capacity,) of candidates
    clock: np.ndarray
    counts: np.ndarray
    extent: np.ndarray  # (1,) bound of the numbers in `lines`
    account: np.ndarray | None  # (2,) energy that collisions add to translation, rotation


def gas(trajectory, spin, box, r, beta, q, has_account=True) -> Gas:
    """Return a gas at time 0, from paths (N, 5), spins (N, 1) and the two sides of the box.

    Without an account, the energy of collisions is not summed.
    """
    number = len(spin)
    padded, capacity = -(-number // LANES) * LANES, -(-number // BATCH) * BATCH
    key, marks = np.full(padded, np.inf), np.zeros(padded, np.uint8)
    packed = np.zeros(-(-number // 64) * 8, np.uint8)
    clock = np.zeros(5)
    clock[SPAN] = 1.0
    return Gas(
        *(float(value) for value in (*box, r, beta, q)),
        path=trajectory.copy(),
        spin=spin.flatten(),
        changes=np.zeros(number, np.int32),
        key=key,
        bits=key.view(np.int64),
        block_minima=key[::BLOCK].copy().view(np.int64),
        kind=np.full(number, NOTHING, np.int8),
        slot_time=np.zeros((number, SLOTS)),
        slot_partner=np.zeros((number, SLOTS), np.int32),
        slot_change=np.zeros((number, SLOTS), np.int32),
        filled=np.zeros(number, np.int8),
        complete_until=np.zeros(number),
        lines=np.full((4, padded), np.nan, np.float32),
        marks=marks,
        mark_words=marks.view(np.uint64),
        packed=packed,
        packed_words=packed.view(np.uint64),
        candidates=np.zeros(capacity, np.int64),
        candidate_paths=np.zeros((5, capacity)),
        contact_time=np.zeros(capacity),
        clock=clock,
        counts=np.zeros(5, np.int64),
        extent=np.zeros(1),
        account=np.zeros(2) if has_account else None,
    )


@entry
def run(gas, collisions):
    """Run until `collisions` collisions in total; return False if the gas collapses."""
    clock, counts = gas.clock, gas.counts
    if counts[IS_STARTED] == 0:
        start(gas)
    while counts[COLLISIONS_MADE] < collisions:
        i = earliest(gas.bits, gas.block_minima)
        time = gas.key[i]
        if time == math.inf:
            break
        clock[NOW] = time
        affected = execute_event(gas, i, int(gas.kind[i]), time)
        for k in range(2):
            if affected[k] >= 0:
                predict_events(gas, affected[k], time)
        if time >= clock[SPAN]:
            renew(gas)
        elif not check_collapse(clock, counts, time, gas.spin.size):
            return False
    return True


@jit
def execute_event(gas, i, kind, time):
    """Execute an event; return the two disks to predict anew, -1 for none."""
    if kind == HORIZON:
        return i, -1
    j = int(gas.slot_partner[i, kind])
    if gas.slot_change[i, kind] != gas.changes[j]:  # j has collided since
        last_slot = int(gas.filled[i]) - 1
        gas.slot_time[i, kind] = gas.slot_time[i, last_slot]
        gas.slot_partner[i, kind] = gas.slot_partner[i, last_slot]
        gas.slot_change[i, kind] = gas.slot_change[i, last_slot]
        gas.filled[i] = last_slot
        choose_next(gas, i)
        return -1, -1
    is_slow = collide(gas, i, j, time, 1e-10 * gas.clock[SPEED])
    gas.changes[i] += 1
    gas.changes[j] += 1
    gas.counts[SLOW_CONTACTS] += is_slow
    gas.counts[COLLISIONS_MADE] += 1
    gas.counts[SINCE_REBASE] += 1
    return i, j


@jit
def check_collapse(clock, counts, time, number):
    """Return False if events accumulate without progress of time."""
    if time > clock[INSTANT_END]:
        clock[INSTANT_END] = time + 2.0**-30 * clock[SPAN]
        counts[SIMULTANEOUS_EVENTS] = 0
        counts[SLOW_CONTACTS] = 0
    counts[SIMULTANEOUS_EVENTS] += 1
    return (counts[SLOW_CONTACTS] < 10) & (counts[SIMULTANEOUS_EVENTS] < 100_000 + 10 * number)


@jit
def predict_events(gas, i, time):
    """Predict all contacts of disk i up to its horizon."""
    clock, path = gas.clock, gas.path
    update_line(path, gas.lines, gas.extent, clock[SPAN], i)
    speed = math.sqrt(path[i, 3] * path[i, 3] + path[i, 2] * path[i, 2])
    speed += 2.0 * clock[SPEED]
    duration = clock[SPAN]
    if speed != 0.0:
        duration = min((min(gas.width, gas.height) - 4.0) / speed, clock[MAX_HORIZON])
    end = time + duration
    half_duration, middle = 0.5 * (end - time), time + 0.5 * (end - time)
    margin = 2.0 + 16.0 * ROUNDING * gas.extent[0]
    mark_candidates(
        gas.lines, gas.marks, i, gas.width, gas.height, middle, half_duration, margin, clock[SPEED]
    )
    number = list_candidates(gas.mark_words, gas.packed, gas.packed_words, gas.candidates, i)
    contact_times(
        path,
        gas.candidates,
        gas.candidate_paths,
        gas.contact_time,
        i,
        number,
        gas.width,
        gas.height,
        time,
        end,
    )
    gas.filled[i] = 0
    gas.complete_until[i] = end
    for k in range(number):
        j = gas.candidates[k]
        time_of_contact = gas.contact_time[k]
        if math.isnan(time_of_contact):
            time_of_contact = contact_time_of_any_image(
                path, i, j, gas.width, gas.height, time, end
            )
        add_contact(gas, i, time_of_contact, j, time_of_contact <= end)
    choose_next(gas, i)


@jit
def add_contact(gas, i, time, j, is_added):
    """Add a contact to the list of disk i; a full list loses its latest contact."""
    filled = int(gas.filled[i])
    if filled == SLOTS:
        if is_added:
            replace_latest(gas, i, time, j)
        return
    gas.slot_time[i, filled] = time
    gas.slot_partner[i, filled] = j
    gas.slot_change[i, filled] = gas.changes[j]
    gas.filled[i] = filled + is_added


@jit
def replace_latest(gas, i, time, j):
    """Replace the latest contact in the list by an earlier one."""
    times, latest = gas.slot_time, 0
    for slot in range(1, SLOTS):
        if times[i, slot] > times[i, latest]:
            latest = slot
    gas.complete_until[i] = min(gas.complete_until[i], max(time, times[i, latest]))
    if time < times[i, latest]:
        times[i, latest] = time
        gas.slot_partner[i, latest] = j
        gas.slot_change[i, latest] = gas.changes[j]


@jit
def choose_next(gas, i):
    """Enter the earliest event of disk i in the queue."""
    time, kind = gas.complete_until[i], HORIZON
    for slot in range(int(gas.filled[i])):
        earlier = gas.slot_time[i, slot] <= time
        time = gas.slot_time[i, slot] if earlier else time
        kind = slot if earlier else kind
    if time == math.inf:
        kind = NOTHING
    gas.kind[i] = kind
    enter_in_queue(gas.bits, gas.block_minima, i, time)


@jit
def enter_in_queue(bits, block_minima, i, time):
    """Store the next time of disk i, and the minimum of its block."""
    new_bits, block = np.float64(time).view(np.int64), i // BLOCK
    minimum = new_bits
    for k in range(BLOCK):
        index = BLOCK * block + k
        minimum = min(minimum, new_bits if index == i else bits[index])
    bits[i] = new_bits
    block_minima[block] = minimum


@jit
def earliest(bits, block_minima):
    """Return the disk with the earliest event."""
    minimum, block = block_minima[0], 0
    for k in range(1, block_minima.size):
        earlier = block_minima[k] < minimum
        minimum = block_minima[k] if earlier else minimum
        block = k if earlier else block
    index = bits.size
    for k in range(BLOCK * block, BLOCK * (block + 1)):
        index = min(index, k if bits[k] == minimum else bits.size)
    return index


@compiled
def start(gas):
    """Schedule a prediction for each disk."""
    gas.counts[IS_STARTED] = 1
    renew(gas)
    for i in range(gas.spin.size):
        gas.kind[i] = HORIZON
        enter_in_queue(gas.bits, gas.block_minima, i, gas.clock[NOW])


@compiled
def renew(gas):
    """Rebase the clock by whole spans, and update speeds, spans and lines."""
    clock, counts, number = gas.clock, gas.counts, gas.spin.size
    step = math.floor(clock[NOW] / clock[SPAN]) * clock[SPAN]
    clock[NOW] -= step
    clock[INSTANT_END] -= step
    total = 0.0
    for i in range(number):
        u, v = gas.path[i, 2], gas.path[i, 3]
        gas.path[i, 4] -= step
        total += v * v + u * u
    clock[SPEED] = math.sqrt(total / number)
    if clock[SPEED] > 0.0:
        crossing = min(gas.width, gas.height) / clock[SPEED]
        clock[SPAN] = math.ldexp(0.5, math.frexp(crossing)[1])
    clock[MAX_HORIZON] = math.inf
    if counts[SINCE_REBASE] > number and step > 0.0:
        clock[MAX_HORIZON] = 2.5 * step * number / (2.0 * counts[SINCE_REBASE])
    counts[SINCE_REBASE] = 0
    gas.extent[0] = 0.0
    for i in range(number):
        update_line(gas.path, gas.lines, gas.extent, clock[SPAN], i)
        gas.complete_until[i] -= step
        for slot in range(SLOTS):
            gas.slot_time[i, slot] -= step
        enter_in_queue(gas.bits, gas.block_minima, i, gas.key[i] - step)
