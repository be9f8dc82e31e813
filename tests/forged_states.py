"""Encoded states that no run has left: some entries of a true one are changed at random."""

import numpy as np

from roughgas.kernel.event_lists import LAST_DAY
from roughgas.kernel.layout import BLOCK
from roughgas.kernel.state import BOUNDARY, FARTHEST_DAY, HORIZON, NOBODY, NOTHING

MAX_CHANGES = 5  # changes
FLOATS = [np.nan, np.inf, -np.inf, 0.0, -0.0, 1e300, -1e300, 1e-300, -1e-300, 2.0**49, -(2.0**49)]


@np.errstate(all="ignore")
def forge(rng, saved):
    """A copy of an encoded state with 1 to MOST changes, and how it was made. In half of them keys
    and lists are made anew, so that they fit the changes."""
    forged = {name: array.copy() for name, array in saved.items()}
    names, changes = [name for name, array in saved.items() if array.size], []
    for _ in range(rng.integers(1, MAX_CHANGES + 1)):
        name = names[rng.integers(len(names))]
        change = CHANGES[rng.integers(len(CHANGES))]
        change(rng, forged[name].reshape(-1))
        changes.append(f"{change.__name__} {name}")
    if rng.integers(2):
        repair(forged)
        changes.append("repaired")
    return forged, ", ".join(changes)


def bytes_at_random(rng, entries):
    k = rng.integers(entries.size)
    entries[k] = np.frombuffer(rng.bytes(entries.itemsize), entries.dtype)[0]


def extreme(rng, entries):
    kind, k = entries.dtype, rng.integers(entries.size)
    if kind.kind == "f":
        size = float(10.0 ** rng.uniform(-30.0, 30.0)) * rng.choice([-1.0, 1.0])
        entries[k] = rng.choice([*FLOATS, size])
        return
    limits = np.iinfo(kind)
    few = [limits.min, limits.max, 0, 1, 2, 3, 40, 700, 2**20, 2**40, 2**59]
    few += [] if kind.kind == "u" else [-1, -2, -3, -(2**40)]
    legal = [number for number in few if limits.min <= number <= limits.max]
    entries[k] = legal[rng.integers(len(legal))]


def near(rng, entries):
    k = rng.integers(entries.size)
    if entries.dtype.kind == "f":
        entries[k] *= 1.0 + rng.normal()
    elif rng.integers(2):
        entries[k] += entries.dtype.type(1)
    else:
        entries[k] -= entries.dtype.type(1)


def scaled(rng, entries):
    k = rng.integers(entries.size)
    if entries.dtype.kind == "f":
        entries[k] *= 2.0 ** rng.integers(-60, 60)
    else:
        entries[k] = entries[k] // 2


def swapped(rng, entries):
    i, j = rng.integers(entries.size, size=2)
    entries[[i, j]] = entries[[j, i]]


def copied(rng, entries):
    i, j = rng.integers(entries.size, size=2)
    entries[i] = entries[j]


def permuted(rng, entries):
    entries[:] = rng.permutation(entries)


CHANGES = [bytes_at_random, extreme, extreme, near, scaled, swapped, copied, permuted]


def repair(saved):
    """Make the keys of an encoded state anew from its agenda, and queues and lists from these."""
    number, event = len(saved["label"]), saved["agenda.kind"]
    slots = saved["agenda.slot_time"].shape[1]
    np.clip(event, NOTHING, slots - 1, out=event)
    at_boundary = event == BOUNDARY
    if "agenda.boundary_time" not in saved:
        event[at_boundary] = HORIZON
    key = saved["agenda.key"][:number].copy()
    contacts = np.flatnonzero(event >= 0)
    key[contacts] = saved["agenda.slot_time"][contacts, event[contacts]]
    if "agenda.boundary_time" in saved:
        key[at_boundary] = saved["agenda.boundary_time"][at_boundary]
    key[event == NOTHING] = np.inf
    event[key == np.inf] = NOTHING
    saved["agenda.key"][:number] = key
    if "queue.keys" in saved:
        _repair_blocks(saved)
    else:
        _repair_lists(saved, key)


def _repair_blocks(saved):
    keys, blocks = saved["queue.keys"], len(saved["queue.keys"])
    keys[:] = saved["agenda.key"].reshape(keys.shape)
    saved["queue.least"].reshape(-1)[:blocks] = keys.min(axis=1)
    saved["queue.whose"][:] = keys.argmin(axis=1) + BLOCK * np.arange(blocks)


def _repair_lists(saved, key):
    first = saved["queue.first"]
    days = np.minimum(key * saved["queue.pace"][0], LAST_DAY).astype(np.int64)
    listed = np.flatnonzero(key < np.inf)
    _list(first, saved["queue.later"], days & (len(first) - 1), listed)
    saved["queue.today"][0] = days[listed].min(initial=FARTHEST_DAY)
    home = saved["cells.home"]
    np.clip(home, 0, len(saved["cells.first"]) - 1, out=home)
    _list(saved["cells.first"], saved["cells.following"], home, np.arange(len(home)))


def _list(first, following, offset, listed):
    first[:] = NOBODY
    for i in listed:
        following[i] = first[offset[i]]
        first[offset[i]] = i
