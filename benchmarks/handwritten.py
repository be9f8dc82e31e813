"""A cooling gas of up to 700 rough disks, as one would write it by hand for this scene alone.

The algorithm is that of roughgas.kernel, though its vectors are what LLVM makes of loops (and its
candidates are listed by a loop), and the results are the same to the last bit; but nothing here
could do anything else. Two dimensions, both periodic, are written out; there are no effects, nor a
place where one could act. What the kernel's generality costs is the difference in speed
(benchmarks/generality.py). Compiled in the same way, with the same decorators.

Who meets whom, when, and what becomes of it, is in handwritten_contacts.py.
"""

import math
from typing import NamedTuple

import numpy as np

from benchmarks.handwritten_contacts import (
    ROUNDING,
    TOGETHER,
    collect,
    collide,
    decide,
    mark,
    meeting_of_any_image,
    redraw_line,
)
from roughgas.compiling.jit import compiled, entry, jit

NOW, SPAN, SPEED, LONGEST, INSTANT_END = range(5)  # of Gas.clock
MADE, SINCE_REBASE, AT_ONCE, SPENT, STARTED = range(5)  # of Gas.counts
HORIZON, NOTHING = -1, -3
SLOTS, BLOCK, LANES = 8, 16, 16  # contacts kept of each disk, disks to a block, and swept at once


class Gas(NamedTuple):
    """All that there is; lengths in radii."""

    width: float
    height: float
    r: float
    beta: float
    q: float
    path: np.ndarray  # (N, 5) x, y, their velocities, and the time at which these hold
    spin: np.ndarray  # (N,) surface velocity
    changes: np.ndarray  # (N,) collisions made
    key: np.ndarray  # (N padded,) time of the next event
    bits: np.ndarray  # the same memory as integers, which order alike
    least: np.ndarray  # (blocks,) of each block of bits
    kind: np.ndarray  # (N,) slot of the next contact, or HORIZON or NOTHING
    slot_time: np.ndarray  # (N, 8) upcoming contacts
    slot_partner: np.ndarray  # (N, 8)
    slot_change: np.ndarray  # (N, 8) `changes` of the partner when it was foreseen
    filled: np.ndarray  # (N,) slots in use
    complete_until: np.ndarray  # (N,) no contact before then is missing
    lines: np.ndarray  # (4, N padded) x, y and velocities at time 0, in single precision
    marks: np.ndarray  # (N padded,) who may be met
    words: np.ndarray  # the same memory, eight at a time
    packed: np.ndarray  # a bit for each mark
    packed_words: np.ndarray  # the same memory
    found: np.ndarray  # (room,) candidates
    near: np.ndarray  # (5, room) their paths
    when: np.ndarray  # (room,) when they are met
    clock: np.ndarray
    counts: np.ndarray
    extent: np.ndarray  # (1,) bound of the lines' numbers
    account: np.ndarray | None  # (2,) energy that collisions put into translation, rotation


def gas(trajectory, spin, box, r, beta, q, books=True) -> Gas:
    """At time 0, from paths (N, 5), spins (N, 1) and the box's two sides. Without `books` what
    collisions do to the energy is not summed up."""
    number = len(spin)
    padded, room = -(-number // LANES) * LANES, -(-number // TOGETHER) * TOGETHER
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
        least=key[::BLOCK].copy().view(np.int64),
        kind=np.full(number, NOTHING, np.int8),
        slot_time=np.zeros((number, SLOTS)),
        slot_partner=np.zeros((number, SLOTS), np.int32),
        slot_change=np.zeros((number, SLOTS), np.int32),
        filled=np.zeros(number, np.int8),
        complete_until=np.zeros(number),
        lines=np.full((4, padded), np.nan, np.float32),
        marks=marks,
        words=marks.view(np.uint64),
        packed=packed,
        packed_words=packed.view(np.uint64),
        found=np.zeros(room, np.int64),
        near=np.zeros((5, room)),
        when=np.zeros(room),
        clock=clock,
        counts=np.zeros(5, np.int64),
        extent=np.zeros(1),
        account=np.zeros(2) if books else None,
    )


@entry
def run(gas, collisions):
    """Go on until so many collisions have been made in all; False where the gas collapses."""
    clock, counts = gas.clock, gas.counts
    if counts[STARTED] == 0:
        start(gas)
    while counts[MADE] < collisions:
        i = earliest(gas.bits, gas.least)
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
    """One event; whose future is to be foreseen anew, or -1."""
    if kind == HORIZON:
        return i, -1
    j = int(gas.slot_partner[i, kind])
    if gas.slot_change[i, kind] != gas.changes[j]:  # j has gone another way
        last = int(gas.filled[i]) - 1
        gas.slot_time[i, kind] = gas.slot_time[i, last]
        gas.slot_partner[i, kind] = gas.slot_partner[i, last]
        gas.slot_change[i, kind] = gas.slot_change[i, last]
        gas.filled[i] = last
        choose_next(gas, i)
        return -1, -1
    spent = collide(gas, i, j, time, 1e-10 * gas.clock[SPEED])
    gas.changes[i] += 1
    gas.changes[j] += 1
    gas.counts[SPENT] += spent
    gas.counts[MADE] += 1
    gas.counts[SINCE_REBASE] += 1
    return i, j


@jit
def check_collapse(clock, counts, time, number):
    """False where events accumulate as if time stood still."""
    if time > clock[INSTANT_END]:
        clock[INSTANT_END] = time + 2.0**-30 * clock[SPAN]
        counts[AT_ONCE] = 0
        counts[SPENT] = 0
    counts[AT_ONCE] += 1
    return (counts[SPENT] < 10) & (counts[AT_ONCE] < 100_000 + 10 * number)


@jit
def predict_events(gas, i, time):
    """All contacts of disk i up to its horizon."""
    clock, path = gas.clock, gas.path
    redraw_line(path, gas.lines, gas.extent, clock[SPAN], i)
    speed = math.sqrt(path[i, 3] * path[i, 3] + path[i, 2] * path[i, 2])
    speed += 2.0 * clock[SPEED]
    ahead = clock[SPAN]
    if speed != 0.0:
        ahead = min((min(gas.width, gas.height) - 4.0) / speed, clock[LONGEST])
    end = time + ahead
    half, middle = 0.5 * (end - time), time + 0.5 * (end - time)
    margin = 2.0 + 16.0 * ROUNDING * gas.extent[0]
    mark(gas.lines, gas.marks, i, gas.width, gas.height, middle, half, margin, clock[SPEED])
    number = collect(gas.words, gas.packed, gas.packed_words, gas.found, i)
    decide(path, gas.found, gas.near, gas.when, i, number, gas.width, gas.height, time, end)
    gas.filled[i] = 0
    gas.complete_until[i] = end
    for k in range(number):
        j = gas.found[k]
        when = gas.when[k]
        if math.isnan(when):
            when = meeting_of_any_image(path, i, j, gas.width, gas.height, time, end)
        add_contact(gas, i, when, j, when <= end)
    choose_next(gas, i)


@jit
def add_contact(gas, i, time, j, wanted):
    """Add a contact to disk i's list; of a full list the latest one drops out."""
    filled = int(gas.filled[i])
    if filled == SLOTS:
        if wanted:
            replace_latest(gas, i, time, j)
        return
    gas.slot_time[i, filled] = time
    gas.slot_partner[i, filled] = j
    gas.slot_change[i, filled] = gas.changes[j]
    gas.filled[i] = filled + wanted


@jit
def replace_latest(gas, i, time, j):
    """Put a contact in the place of the latest one, if it is sooner."""
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
    """Make the earliest event of disk i its entry in the queue."""
    time, kind = gas.complete_until[i], HORIZON
    for slot in range(int(gas.filled[i])):
        earlier = gas.slot_time[i, slot] <= time
        time = gas.slot_time[i, slot] if earlier else time
        kind = slot if earlier else kind
    if time == math.inf:
        kind = NOTHING
    gas.kind[i] = kind
    enter_in_queue(gas.bits, gas.least, i, time)


@jit
def enter_in_queue(bits, least, i, time):
    """Store disk i's next time, and its block's least."""
    new, block = np.float64(time).view(np.int64), i // BLOCK
    lowest = new
    for k in range(BLOCK):
        place = BLOCK * block + k
        lowest = min(lowest, new if place == i else bits[place])
    bits[i] = new
    least[block] = lowest


@jit
def earliest(bits, least):
    """The disk whose event comes first."""
    lowest, block = least[0], 0
    for k in range(1, least.size):
        earlier = least[k] < lowest
        lowest = least[k] if earlier else lowest
        block = k if earlier else block
    place = bits.size
    for k in range(BLOCK * block, BLOCK * (block + 1)):
        place = min(place, k if bits[k] == lowest else bits.size)
    return place


@compiled
def start(gas):
    """Have all contacts foreseen."""
    gas.counts[STARTED] = 1
    renew(gas)
    for i in range(gas.spin.size):
        gas.kind[i] = HORIZON
        enter_in_queue(gas.bits, gas.least, i, gas.clock[NOW])


@compiled
def renew(gas):
    """Count times from the present on, but for a rest of less than a span."""
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
    clock[LONGEST] = math.inf
    if counts[SINCE_REBASE] > number and step > 0.0:
        clock[LONGEST] = 2.5 * step * number / (2.0 * counts[SINCE_REBASE])
    counts[SINCE_REBASE] = 0
    gas.extent[0] = 0.0
    for i in range(number):
        redraw_line(gas.path, gas.lines, gas.extent, clock[SPAN], i)
        gas.complete_until[i] -= step
        for slot in range(SLOTS):
            gas.slot_time[i, slot] -= step
        enter_in_queue(gas.bits, gas.least, i, gas.key[i] - step)
