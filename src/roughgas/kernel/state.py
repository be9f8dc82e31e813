"""What changes while a scene is simulated: particles, clock, agenda and energy balance.

Arrays only, in NamedTuples. Times are relative to a base that is moved along with the simulation
(`clock[BASE]`), so that their resolution never wears out.

The number of particles decides how contacts, and the next event, are found: a few are all swept at
once (State.sweep, queue Blocks), many are sorted into cells (State.cells, queue Calendar). The
other part is None, and compiled away.
"""

from typing import NamedTuple

import numpy as np

# Entries of State.clock
BASE, NOW, ORIGIN, SPAN, TYPICAL_SPEED, LONGEST_HORIZON, EXTENT, INSTANT_END = range(8)
# Entries of State.counts
(
    COLLISIONS,
    BOUNDARY_HITS,
    PREDICTIONS,
    STALE,
    TOUCHED,
    SINCE_REBASE,
    AT_ONCE,
    SPENT,
    STARTED,
    EXPONENT,
    LAST_FIRST,
    LAST_SECOND,
    ALIGNED,
) = range(13)
# Kinds of event in Agenda.kind: a slot's number, or one of these
HORIZON, BOUNDARY, NOTHING = -1, -2, -3
NOBODY = -1  # ends a linked list of particles


class Bodies(NamedTuple):
    """What each particle is, where they differ; `species` are counted from 0."""

    radius: np.ndarray  # (N,) in a
    mass: np.ndarray  # (N,) in m
    inertia: np.ndarray  # (N,) q = I/(m a^2), of its own mass and radius
    species: np.ndarray  # (N,)
    largest: np.ndarray  # (1,) radius
    pairs: np.ndarray  # (species, species + 1, 3) r, beta and mu of their contacts, mu NaN without
    # friction; last those with walls, of which only mu is used


class Agenda(NamedTuple):
    """The upcoming events of each particle, and the earliest of them as the queue's key."""

    key: np.ndarray  # (N,) time of the next event, inf where there is none
    kind: np.ndarray  # (N,) the slot of the contact that comes next, or HORIZON or BOUNDARY
    slot_time: np.ndarray  # (N, slots) times of contacts, in no order; inf in those that are free
    slot_partner: np.ndarray  # (N, slots)
    slot_change: np.ndarray  # (N, slots) the partner's `changes` when the contact was predicted
    complete_until: np.ndarray  # (N,) no contact before this time is missing from the slots
    boundary_time: np.ndarray | None  # (N,); None in a scene without boundaries
    boundary_code: np.ndarray | None  # (N,) which effect, and what of it


class Blocks(NamedTuple):
    """A queue of few: the keys in blocks, and the least of each block, in blocks again, and whose
    it is."""

    keys: np.ndarray  # (blocks, BLOCK) the memory of Agenda.key
    least: np.ndarray  # (blocks padded / BLOCK, BLOCK)
    whose: np.ndarray  # (blocks,) particle with the least key of a block


class Calendar(NamedTuple):
    """A queue of many: the particles listed by the day of their next event; days repeat yearly."""

    first: np.ndarray  # (days,) first particle of each day's list
    later: np.ndarray  # (N,) the next particle of the same list
    pace: np.ndarray  # (1,) days per time
    today: np.ndarray  # (1,) the day on which the earliest event was found
    since: np.ndarray  # (1,) the day from which on events are counted
    events: np.ndarray  # (1,) how many there were


class Sweep(NamedTuple):
    """Single-precision trajectories r0 + v0 t, which the all-pairs sweep tries."""

    lines: np.ndarray  # (2 D, N padded) r0 and v0 at the clock's base; NaN in the padding
    sizes: np.ndarray | None  # (1, N padded) radii, rounded up; None where all are 1


class Neighbours(NamedTuple):
    """A list for each particle of those near it, good for as long as it stays in its region."""

    middle: np.ndarray  # (N, D) of the region, as the frame moves
    sides: tuple[float, ...]  # of the region, in a
    members: np.ndarray  # (N, ROOM) who can be met while both are in their regions
    number: np.ndarray  # (N,) how many there are; above ROOM the list lacks some
    frame: np.ndarray  # (2,) along the last axis: how far all regions have moved at the clock's
    # base, and how fast they do


class Cells(NamedTuple):
    """The particles listed by their cell; cells repeat along every axis, open ones included."""

    counts: tuple[int, ...]  # cells along each axis
    widths: tuple[float, ...]  # of a cell, in a
    periods: tuple[float, ...]  # counts * widths
    first: np.ndarray  # (cells,) first particle of each cell's list
    following: np.ndarray  # (N,) the next particle of the same list
    home: np.ndarray  # (N,) number of the cell, the first axis running fastest
    leave: np.ndarray  # (N,) when the particle leaves it, or its region
    heading: np.ndarray  # (N,) into which cell: twice the axis, and 1 more if upwards
    neighbours: Neighbours | None  # None where particles look at all cells around them


class Shortlist(NamedTuple):
    """The candidates for a contact with each of two particles, and what becomes of them."""

    found: np.ndarray  # (2 room,) particles; those for the second begin half-way
    beyond: np.ndarray  # (2,) the place after the last candidate for each of the two
    when: np.ndarray  # (1, 8) times of contact, of those that are looked at one by one


class Log(NamedTuple):
    """The last contacts, in turn; the effect contact_log says what a row holds."""

    rows: np.ndarray  # (contacts, columns)
    made: np.ndarray  # (1,) contacts so far


class PathCounts(NamedTuple):
    """Net crossings of the box, and rotation, of each particle, up to its last event.

    Both count from the start, and the rows are in the order of the start.
    """

    crossings: np.ndarray  # (N, D) periods along each axis; 0 along an open one
    rotation: np.ndarray | None  # (N,) rad, anticlockwise; None unless disks spin


class State(NamedTuple):
    """Everything that a simulation changes."""

    trajectory: np.ndarray  # (N, 2 D + 1): position, velocity, and the time at which they hold
    spin: np.ndarray | None  # (N, 2 D - 3) surface velocity a w; None without spin
    bodies: Bodies | None  # None where all particles are alike: radius and mass are 1
    moments: tuple  # an Effects with, for each effect that keeps one of each particle, times (N,)
    changes: np.ndarray  # (N,) how often each particle's velocity has changed
    label: np.ndarray  # (N,) the particle's number at the start: many are sorted anew now and then
    phase: np.ndarray | None  # (accounts,) the phase of each effect with an account, at the clock's
    # base; None where no effect has a phase
    ledger: np.ndarray  # (2, accounts + 1, 2) energy that each effect that is there, and last the
    # contacts, put into translation and rotation: [0] in present units, [1] before a rescaling
    sums: tuple | None  # an Effects with, for each effect that keeps running sums, (3, sums): [0]
    # in present units, [1] before a rescaling, [2] the power of velocity in each; None without any
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
