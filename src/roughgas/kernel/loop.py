"""The event loop: take the earliest event, carry it out, foresee the next ones."""

import math

from roughgas.kernel import hooks
from roughgas.kernel.agenda import (
    choose_next,
    clear_contacts,
    drop_contact,
    earliest,
    enter_in_queue,
)
from roughgas.kernel.clock import horizon, rebase
from roughgas.kernel.contact import collide
from roughgas.kernel.jit import compiled, jit
from roughgas.kernel.shortlist import decide
from roughgas.kernel.state import (
    BASE,
    BOUNDARY,
    COLLISIONS,
    HORIZON,
    NOW,
    PREDICTIONS,
    SINCE_REBASE,
    SPAN,
    STALE,
)
from roughgas.kernel.sweep import collect_candidates, mark_candidates, redraw_line

# A span is about the time to cross the box: this many contacts a particle within it is collapse
COLLAPSE = 100_000


@jit
def advance(state, scene, until, collisions):
    """Run to the absolute time `until`, or until so many pair collisions have been made in all.

    Returns False when the work per simulated time diverges (inelastic collapse), else True.
    """
    clock, counts, agenda = state.clock, state.counts, state.agenda
    while counts[COLLISIONS] < collisions:
        i = earliest(agenda)
        time = agenda.key[i]
        if time > until - clock[BASE] or time == math.inf:
            clock[NOW] = until - clock[BASE]
            break
        clock[NOW] = time
        affected = carry_out(state, scene, i, int(agenda.kind[i]), time)
        for k in range(2):
            if affected[k] >= 0:
                foresee(state, scene, affected[k], time)
        if time >= clock[SPAN]:
            rebase(state, scene)
        elif counts[SINCE_REBASE] > COLLAPSE * len(state.changes):
            return False
    return True


@jit
def carry_out(state, scene, i, kind, time):
    """One event of particle i; returns the particles whose future is to be foreseen anew, or -1."""
    agenda = state.agenda
    if kind == HORIZON:
        return i, -1
    if kind == BOUNDARY:
        hooks.resolve_boundary(scene.effects, agenda.boundary_code[i], state, scene, i, time)
        return i, -1
    partner = int(agenda.slot_partner[i, kind])
    if agenda.slot_change[i, kind] != state.changes[partner]:  # its path is another by now
        state.counts[STALE] += 1
        drop_contact(agenda, i, kind)
        choose_next(agenda, i)
        return -1, -1
    collide(state, scene, i, partner, time)
    state.counts[SINCE_REBASE] += 1
    return i, partner


@jit
def foresee(state, scene, i, time):
    """Predict all events of particle i: its next meeting with a boundary, and its contacts."""
    agenda = state.agenda
    state.counts[PREDICTIONS] += 1
    redraw_line(state, scene, i)
    boundary = hooks.next_boundary(scene.effects, (math.inf, 0), state, scene, i)
    agenda.boundary_time[i], agenda.boundary_code[i] = boundary
    end = time + horizon(state, scene, i)
    half = 0.5 * (end - time)
    mark_candidates(state, scene, i, time + half, half)
    clear_contacts(agenda, i, end)
    number = collect_candidates(state.sweep, i, state.shortlist.found)
    decide(state, scene, i, number, time, end, end)
    choose_next(agenda, i)


@compiled
def start(state, scene):
    """Have everything foreseen again, after velocities were set from outside."""
    rebase(state, scene)
    agenda = state.agenda
    for i in range(len(state.changes)):
        agenda.kind[i] = HORIZON
        enter_in_queue(agenda, i, state.clock[NOW])
