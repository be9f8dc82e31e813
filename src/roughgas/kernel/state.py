"""What changes while a scene is simulated: particles, clock, agenda and the books kept on them.

Arrays only, in NamedTuples that numba unpacks at compile time. Times are relative to a base that
is moved along with the simulation (`clock[BASE]`), so that their resolution never wears out.
"""

from typing import NamedTuple

import numpy as np

LANES = 16  # the arrays that are swept are padded to whole vector registers
BLOCK = 16  # particles to a block of the queue; divides LANES
TOGETHER = 8  # candidates that are decided at once
SLOTS = 8  # upcoming contacts kept per particle

# Entries of State.clock
BASE, NOW, ORIGIN, SPAN, TYPICAL_SPEED, LONGEST_HORIZON, EXTENT = range(7)
# Entries of State.counts
(
    COLLISIONS,
    BOUNDARY_HITS,
    PREDICTIONS,
    STALE,
    TOUCHED,
    SINCE_REBASE,
    STARTED,
    EXPONENT,
    LAST_FIRST,
    LAST_SECOND,
) = range(10)
# Kinds of event in Agenda.kind: a slot's number, or one of these
HORIZON, BOUNDARY, NOTHING = -1, -2, -3


class Agenda(NamedTuple):
    """The upcoming events of each particle, and the earliest of them as the queue's key."""

    key: np.ndarray  # (N padded,) time of the next event, inf where there is none
    bits: np.ndarray  # the same memory as integers, which order like the times
    least: np.ndarray  # the least of each BLOCK of them
    kind: np.ndarray  # (N,) the slot of the contact that comes next, or HORIZON or BOUNDARY
    slot_time: np.ndarray  # (N, SLOTS) times of contacts, in no order
    slot_partner: np.ndarray  # (N, SLOTS)
    slot_change: np.ndarray  # (N, SLOTS) the partner's `changes` when the contact was predicted
    filled: np.ndarray  # (N,) slots in use
    complete_until: np.ndarray  # (N,) no contact before this time is missing from the slots
    boundary_time: np.ndarray  # (N,)
    boundary_code: np.ndarray  # (N,) which effect, and what of it


class Sweep(NamedTuple):
    """Single-precision trajectories r0 + v0 t, and the marks that the all-pairs sweep leaves."""

    lines: np.ndarray  # (2 D, N padded) r0 and v0 at the clock's base; NaN in the padding
    marks: np.ndarray  # (N padded,) one byte a particle
    words: np.ndarray  # the same memory, eight marks a word
    bits: np.ndarray  # the marks packed, eight to a byte
    bit_words: np.ndarray  # the same memory, 64 marks a word


class Shortlist(NamedTuple):
    """The candidates and what becomes of them; its room is a multiple of TOGETHER."""

    found: np.ndarray  # (room,) numbers of particles
    paths: np.ndarray  # (2 D + 1, room) their positions, velocities, and times at which these hold
    when: np.ndarray  # (room,) times of contact


class State(NamedTuple):
    """Everything that a simulation changes."""

    trajectory: np.ndarray  # (N, 2 D + 1): position, velocity, and the time at which they hold
    spin: np.ndarray | None  # (N, 2 D - 3) surface velocity a w; None without spin
    last_contact: np.ndarray | None  # (N,) time of the previous contact; None without TC model
    changes: np.ndarray  # (N,) how often each particle's velocity has changed
    phase: np.ndarray  # (effects,) each effect's own phase at the clock's base
    ledger: np.ndarray  # (2, effects + 1, 2) energy that each effect, and last the contacts, put
    # into translation and rotation: [0] in present units, [1] before the last rescaling
    clock: np.ndarray
    counts: np.ndarray
    agenda: Agenda
    sweep: Sweep
    shortlist: Shortlist


def new_state(scene, position, velocity, spin):
    """A state at time 0 from positions (N, D) in a, velocities (N, D) and spins (N, D') in a/T.

    The spin is left out where the scene has none.
    """
    number, dimension = position.shape
    trajectory = np.zeros((number, 2 * dimension + 1))
    trajectory[:, :dimension] = position
    trajectory[:, dimension:-1] = velocity
    effects = scene.effects
    clock = np.zeros(7)
    clock[SPAN] = 1.0
    return State(
        trajectory=trajectory,
        spin=None if effects.spin is None else np.array(spin, dtype=float),
        last_contact=None if effects.contact_time is None else np.full(number, -np.inf),
        changes=np.zeros(number, np.int32),
        phase=np.zeros(len(effects)),
        ledger=np.zeros((2, len(effects) + 1, 2)),
        clock=clock,
        counts=np.zeros(10, np.int64),
        agenda=_empty_agenda(number),
        sweep=_empty_sweep(number, dimension),
        shortlist=_empty_shortlist(number, dimension),
    )


def _padded(number):
    return -(-number // LANES) * LANES


def _empty_agenda(number):
    key = np.full(_padded(number), np.inf)
    return Agenda(
        key=key,
        bits=key.view(np.int64),
        least=key[::BLOCK].copy().view(np.int64),
        kind=np.full(number, NOTHING, np.int8),
        slot_time=np.full((number, SLOTS), np.inf),
        slot_partner=np.zeros((number, SLOTS), np.int32),
        slot_change=np.zeros((number, SLOTS), np.int32),
        filled=np.zeros(number, np.int8),
        complete_until=np.full(number, np.inf),
        boundary_time=np.full(number, np.inf),
        boundary_code=np.zeros(number, np.int32),
    )


def _empty_sweep(number, dimension):
    marks = np.zeros(_padded(number), np.uint8)
    bits = np.zeros(-(-number // 64) * 8, np.uint8)
    return Sweep(
        lines=np.full((2 * dimension, _padded(number)), np.nan, np.float32),
        marks=marks,
        words=marks.view(np.uint64),
        bits=bits,
        bit_words=bits.view(np.uint64),
    )


def _empty_shortlist(number, dimension):
    room = -(-number // TOGETHER) * TOGETHER
    return Shortlist(
        found=np.zeros(room, np.int64),
        paths=np.zeros((2 * dimension + 1, room)),
        when=np.zeros(room),
    )
