"""Early ends of calls of the kernel: limits of collisions and hits, and errors with advice.

A hit is a contact of a particle with a wall or a floor.
"""

import math

import numpy as np

from roughgas.base import CollapseError, EndedEarlyError, JammedError, SilentError
from roughgas.kernel.loop import COLLAPSED, INSTANT, TRAPPED
from roughgas.kernel.record import UNLIMITED
from roughgas.kernel.state import (
    BASE,
    COLLISIONS,
    EXPONENT,
    LAST_FIRST,
    LAST_SECOND,
    NOW,
    ORIGIN,
    SPAN,
    State,
)
from roughgas.scene import Scene, walls_of

JAM_COLLISIONS = 50_000  # per particle in a sample, or in 1 T if that is longer
HIT_LIMIT = 1_000_000  # hits of walls and floor per particle in 1 T, or in a shorter call
NAMED_PARTICLES = 8  # in the message on a collapse


def time_of(state: State) -> float:
    """Return the present time of the kernel's `state`, in T since the start."""
    clock, unit = state.clock, 2.0 ** -int(state.counts[EXPONENT])
    return float(clock[ORIGIN] + (clock[BASE] + clock[NOW]) * unit)


def jam_limit(interval: float, particles: int) -> int:
    """Return the number of collisions in a sample that makes a gas count as jammed.

    `interval` is the length of the sample in T, and `particles` is N.
    """
    return math.ceil(particles / 2 * JAM_COLLISIONS * max(1.0, interval))


def hit_limit(samples: int, interval: float, particles: int) -> int:
    """Return the number of hits in a call of the kernel above which particles count as trapped.

    The call has this number of `samples`, `interval` T apart; a sample without an interval (inf)
    counts as 1 T. `particles` is N.
    """
    length = max(1.0, samples * (interval if math.isfinite(interval) else 1.0))
    return math.ceil(min(HIT_LIMIT * particles * length, UNLIMITED))


def early_end_error(ended: int, state: State, scene: Scene) -> EndedEarlyError:
    """Return the error for a call of the kernel that ended early, for the reason `ended`.

    Reasons are COLLAPSED, NO_COLLISIONS and TRAPPED (see roughgas.kernel.loop).
    """
    if ended == COLLAPSED:
        return collapse_error(state, scene)
    if ended == TRAPPED:
        return _trapped_error(state)
    collisions, remedy = (
        int(state.counts[COLLISIONS]),
        "raise the packing, or the number of particles",
    )
    instant = f"at t = {time_of(state):.6g} T, after {collisions} collisions"
    return SilentError(f"particles do not meet any longer {instant}: {remedy}")


def jam_error(state: State, interval: float) -> JammedError:
    """Return the error for a jammed gas: too many collisions in a sample of `interval` T."""
    limit = f"{JAM_COLLISIONS} collisions of each particle within {max(1.0, interval):g} T"
    remedy = "the gas is jammed: give it more room, raise r, or sample it more often"
    return JammedError(f"more than {limit}, at t = {time_of(state):.6g} T: {remedy}")


def _trapped_error(state: State) -> JammedError:
    """Return the error for particles that are trapped at a wall or floor."""
    limit = f"{HIT_LIMIT} hits of walls and floor by each particle within a T"
    remedy = "make walls and floor smoother, or raise their r"
    return JammedError(f"more than {limit}, at t = {time_of(state):.6g} T: some are held: {remedy}")


def collapse_error(state: State, scene: Scene) -> CollapseError:
    """Return the error for a gas whose contacts accumulate without end.

    Its text has the numbers of the colliding particles.
    """
    names = [str(label) for label in _collapsing_labels(state)]
    rest = f" and {len(names) - NAMED_PARTICLES} more" if len(names) > NAMED_PARTICLES else ""
    effects, remedy = scene.effects, "raise r, or the duration of contact_time"
    if effects.contact_time is None:
        remedy = "add the contact_time effect to the experiment, or raise r"
    elif walls_of(effects):
        remedy = "raise r, or make floor or walls smoother, between which a particle may be held"
    # in a very slow gas all instants may be equal: no particle is the last one
    partners = f" of particles {', '.join(names[:NAMED_PARTICLES])}{rest}" if names else ""
    return CollapseError(f"inelastic collapse at t = {time_of(state):.6g} T{partners}: {remedy}")


def _collapsing_labels(state):
    """Return the numbers of the particles whose last contact is simultaneous with the present.

    After a refresh, which brings all particles to the present, these are the last two partners.
    """
    last = state.clock[NOW] - INSTANT * state.clock[SPAN]
    labels = state.label[state.trajectory[:, -1] >= last]
    refreshed = len(labels) == len(state.label)
    return np.sort(state.counts[[LAST_FIRST, LAST_SECOND]] if refreshed else labels)
