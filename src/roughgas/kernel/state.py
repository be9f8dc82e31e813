"""The mutable state of a simulation: particles, clock, agenda and energy balance.

NamedTuples of arrays. Times are relative to a base that is moved along with the simulation
(`clock[BASE]`), so that their resolution does not degrade. Names of fields are also the names of
arrays in checkpoints and datasets (simulation/state_encoding.py).

The number of particles decides how contacts and the next event are found: all pairs of few
particles are swept (State.sweep, queue Blocks), many particles are sorted into cells (State.cells,
queue Calendar). The fields of the unused scheme are None, and compiled away.
"""

from typing import NamedTuple

import numpy as np

from roughgas.kernel.hooks import CODES

Limit = int | np.ndarray
# Entries of State.clock
BASE, NOW, ORIGIN, SPAN, TYPICAL_SPEED, LONGEST_HORIZON, EXTENT, INSTANT_END = range(8)
COUNTS = 13
# Entries of State.counts
(
    COLLISIONS,
    BOUNDARY_HITS,
    PREDICTIONS,
    STALE_PREDICTIONS,
    ALTERED_RESTITUTIONS,
    SINCE_REBASE,
    SIMULTANEOUS_EVENTS,
    SLOW_CONTACTS,
    STARTED,
    EXPONENT,
    LAST_FIRST,
    LAST_SECOND,
    ALIGNED,
) = range(COUNTS)
# Kinds of event in Agenda.kind: the number of a contact slot, HORIZON, BOUNDARY or NOTHING
HORIZON, BOUNDARY, NOTHING = -1, -2, -3
NOBODY = -1  # ends a linked list of particles


class Bodies(NamedTuple):
    """Radius, mass, moment of inertia and species of each particle, where particles differ."""

    radius: np.ndarray  # (N,) in a
    mass: np.ndarray  # (N,) in m
    inertia: np.ndarray  # (N,) q = I/(m a^2), with the particle's own mass and radius
    species: np.ndarray  # (N,) counted from 0
    largest: np.ndarray  # (1,) largest radius
    pairs: np.ndarray  # (species, species + 1, 3) r, beta and mu of contacts between species; in
    # the last column contacts with walls, only with mu; mu is NaN without friction


class Agenda(NamedTuple):
    """The upcoming events of each particle; the time of the earliest is its key in the queue."""

    key: np.ndarray  # (N,) time of the next event; inf: no event
    kind: np.ndarray  # (N,) of the next event: the slot of a contact, HORIZON, BOUNDARY or NOTHING
    slot_time: np.ndarray  # (N, slots) times of contacts, unordered; inf in free slots
    slot_partner: np.ndarray  # (N, slots)
    slot_change: np.ndarray  # (N, slots) the partner's `changes` when the contact was predicted
    complete_until: np.ndarray  # (N,) no contact before this time is missing from the slots
    boundary_time: np.ndarray | None  # (N,); None in a scene without boundaries
    boundary_code: np.ndarray | None  # (N,) CODES * account of the effect + its event code


class Blocks(NamedTuple):
    """Two-level queue for few particles: keys in blocks, and each block's minimum and its owner."""

    keys: np.ndarray  # (blocks, BLOCK) the memory of Agenda.key
    least: np.ndarray  # (blocks padded / BLOCK, BLOCK) minimum of each block
    whose: np.ndarray  # (blocks,) the particle with that key


class Calendar(NamedTuple):
    """Queue for many particles, listed by the day of their next event; days repeat yearly."""

    first: np.ndarray  # (days,) first particle of each day's list
    later: np.ndarray  # (N,) the next particle of the same list
    pace: np.ndarray  # (1,) days per time
    today: np.ndarray  # (1,) the day of the last event that was taken from the queue
    since: np.ndarray  # (1,) the day on which the count of events began
    events: np.ndarray  # (1,) number of events since


class Sweep(NamedTuple):
    """Single-precision trajectories r0 + v0 t for the all-pairs sweep."""

    lines: np.ndarray  # (2 D, N padded) r0 and v0 at the clock's base; NaN in the padding
    sizes: np.ndarray | None  # (1, N padded) radii, rounded up; None where all are 1


class Neighbours(NamedTuple):
    """Neighbour list of each particle, valid as long as the particle stays in its region."""

    middle: np.ndarray  # (N, D) centre of the region, in the frame that moves with the regions
    sides: tuple[float, ...]  # of the region, in a
    members: np.ndarray  # (N, LIST_CAPACITY) neighbours: particles whose regions are in reach
    number: np.ndarray  # (N,) of neighbours; above LIST_CAPACITY the list is incomplete
    frame: np.ndarray  # (2,) of the regions' motion along the last axis: displacement at the
    # clock's base, and velocity


class SizeClasses(NamedTuple):
    """A grid of cells for each class of radii, from the smallest to the largest particles."""

    radius: np.ndarray  # (classes,) largest radius of each, in a
    level: np.ndarray  # (classes,) a cell consists of 2^level cells of the finest grid on each axis
    origin: np.ndarray  # (classes,) of the cells, in their widths
    first_cell: np.ndarray  # (classes,) index in Cells.first of the first cell of each grid
    reach: np.ndarray  # (classes, classes, D) near cells have fewer finest cells between them


class Cells(NamedTuple):
    """Linked lists of the particles in each cell; cells repeat along every axis, open or not."""

    counts: tuple[int, ...]  # cells along each axis; of the finest grid, if there are several
    widths: tuple[float, ...]  # of such a cell, in a
    periods: tuple[float, ...]  # counts * widths
    first: np.ndarray  # (cells,) first particle of each cell's list
    following: np.ndarray  # (N,) the next particle of the same list
    home: np.ndarray  # (N,) index of the particle's cell, the first axis running fastest
    leave: np.ndarray  # (N,) when the particle leaves its cell, or its region
    heading: np.ndarray  # (N,) its side in the direction of motion: 2 * axis, plus 1 if upwards
    neighbours: Neighbours | None  # None where candidates are taken from the adjacent cells
    classes: SizeClasses | None  # None where all particles are in one grid


class Shortlist(NamedTuple):
    """Candidates for contacts with each of two particles, and scratch memory for their times."""

    found: np.ndarray  # (2 room,) candidates; the second particle's begin half-way
    beyond: np.ndarray  # (2,) index after the last candidate of each of the two
    when: np.ndarray  # (1, 8) times of contact, for processing one by one


class Log(NamedTuple):
    """Ring buffer of the last contacts; effects/contacts.py documents the columns."""

    rows: np.ndarray  # (contacts, columns)
    made: np.ndarray  # (1,) number of logged contacts


class PathCounts(NamedTuple):
    """Net crossings of the box, and rotation, of each particle, up to its last event.

    Both count from the start; rows are in the particles' initial order.
    """

    crossings: np.ndarray  # (N, D) periods along each axis; 0 along an open one
    rotation: np.ndarray | None  # (N,) rad, anticlockwise; None unless disks spin


class State(NamedTuple):
    """Everything that a simulation changes."""

    trajectory: np.ndarray  # (N, 2 D + 1): position and velocity, and their time
    spin: np.ndarray | None  # (N, 2 D - 3) surface velocity a w; None without spin
    bodies: Bodies | None  # None where all particles are alike: radius and mass are 1
    particle_times: tuple  # an Effects: for each effect with this hook, a time per particle (N,)
    changes: np.ndarray  # (N,) number of changes of each particle's velocity
    label: np.ndarray  # (N,) the particle's initial index: many particles are re-sorted at times
    phase: np.ndarray | None  # (accounts,) the phase of each effect with an account, at the clock's
    # base; None where no effect has a phase
    ledger: np.ndarray  # (2, accounts + 1, 2) energy gained from each effect with an account, and
    # last from contacts, in translation and rotation: [0] in current units, [1] before a rescaling
    sums: tuple | None  # an Effects: for each effect with running sums, (3, sums): [0] in current
    # units, [1] before a rescaling, [2] the power of velocity in each; None without such effects
    log: Log | None  # None without the effect contact_log
    paths: PathCounts | None  # None without the effect paths
    random: np.ndarray | None  # (1,) of the generator; None where no effect draws random numbers
    clock: np.ndarray
    counts: np.ndarray
    agenda: Agenda
    queue: Blocks | Calendar
    sweep: Sweep | None
    cells: Cells | None
    shortlist: Shortlist


SAVED_NAMES = {"particle_times": "moments"}
"""Names of arrays in checkpoints and datasets, where they differ from those of fields."""
CONSTANTS = {"classes"}
"""Fields whose arrays follow from the scene and its bodies, and are not saved."""
MAX_CHANGES = 2**31 - 1  # of a particle's velocity
MAX_EVENTS = 2**60  # more than in any run; sums of a few still fit in 64 bits
FARTHEST_DAY = 2**62  # of a calendar
MAX_HALVINGS = 2**20  # of velocities; also of doublings


def integer_ranges(state: State) -> dict[str, tuple[Limit, Limit]]:
    """Return the minimum and maximum legal value of each integer array of a state, by dotted name.

    A name is as "cells.home". The kernel uses most of these integers as indices, unchecked. The
    limits of `counts` are arrays, with an entry for each count.
    """
    last = len(state.changes) - 1
    ranges: dict[str, tuple[Limit, Limit]] = {
        "changes": (0, MAX_CHANGES),
        "label": (0, last),
        "random": (0, 2**64 - 1),
        "counts": _ranges_of_counts(last),
        "agenda.kind": (NOTHING, state.agenda.slot_time.shape[1] - 1),
        "agenda.slot_partner": (0, last),
        "agenda.slot_change": (0, MAX_CHANGES),
        "agenda.boundary_code": (0, CODES * len(state.particle_times) - 1),
        "shortlist.found": (0, last),
        "shortlist.beyond": (0, len(state.shortlist.found)),
        "log.made": (0, MAX_EVENTS),
    }
    if state.bodies is not None:
        ranges["bodies.species"] = (0, len(state.bodies.pairs) - 1)
    if isinstance(state.queue, Blocks):
        ranges["queue.whose"] = (0, last)
    else:
        ranges |= _ranges_of_calendar(state.queue, last)
    return ranges if state.cells is None else ranges | _ranges_of_cells(state.cells, last)


def _ranges_of_counts(last: int) -> tuple[np.ndarray, np.ndarray]:
    """Return the limits of State.counts, two arrays; `last` is the last particle."""
    lower, upper = np.zeros(COUNTS, np.int64), np.full(COUNTS, MAX_EVENTS)
    lower[EXPONENT], upper[EXPONENT] = 1 - MAX_HALVINGS, MAX_HALVINGS - 1
    upper[STARTED] = 1
    upper[[LAST_FIRST, LAST_SECOND]] = last
    return lower, upper


def _ranges_of_calendar(queue: Calendar, last: int) -> dict[str, tuple[Limit, Limit]]:
    """Return limits of a calendar's integers by dotted name; `last` is the last particle."""
    return {
        "queue.first": (NOBODY, last),
        "queue.later": (NOBODY, last),
        "queue.today": (-FARTHEST_DAY, FARTHEST_DAY),
        "queue.since": (-FARTHEST_DAY, FARTHEST_DAY),
        "queue.events": (-last - 1, queue.first.size),
    }


def _ranges_of_cells(cells: Cells, last: int) -> dict[str, tuple[Limit, Limit]]:
    """Return limits of the cells' integers by dotted name; `last` is the last particle."""
    ranges: dict[str, tuple[Limit, Limit]] = {
        "cells.first": (NOBODY, last),
        "cells.following": (NOBODY, last),
        "cells.home": (0, cells.first.size - 1),
        "cells.heading": (0, 2 * len(cells.counts) - 1),
    }
    if cells.neighbours is not None:
        ranges["cells.neighbours.members"] = (0, last)
        ranges["cells.neighbours.number"] = (0, cells.neighbours.members.shape[1] + 1)
    return ranges
