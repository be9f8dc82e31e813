"""The event loop: take the earliest event, carry it out, foresee the next ones."""

import math

from roughgas.kernel import hooks
from roughgas.kernel.cells import arrange, find_around
from roughgas.kernel.clock import check_collapse, rebase
from roughgas.kernel.contact import collide
from roughgas.kernel.event_lists import (
    choose_next,
    clear_calendar,
    drop_contact,
    earliest,
    enter_in_queue,
)
from roughgas.kernel.jit import compiled, jit
from roughgas.kernel.mathematics import index
from roughgas.kernel.state import (
    BASE,
    BOUNDARY,
    COLLISIONS,
    EXTENT,
    HORIZON,
    NOBODY,
    NOW,
    PREDICTIONS,
    SINCE_REBASE,
    SPAN,
    STALE,
)
from roughgas.kernel.sweep import find_by_sweep, redraw_line

REACHED, COLLAPSED, SILENT = range(3)  # how `advance` ends
# Spans without a collision after which none is waited for any longer: so many in all, divided among
# the particles, and so many at least. A hundred thousand of a gas of 100, a few seconds.
SILENCE = 10_000_000, 1000


@jit
def advance(state, scene, until, collisions):
    """Run to the absolute time `until`, or to a total number of collisions; return the outcome.

    REACHED: at one of the two. COLLAPSED: the work per simulated time diverges (inelastic
    collapse). SILENT: no time was given, and the collisions that were asked for do not come.
    """
    clock, counts, agenda = state.clock, state.counts, state.agenda
    silent, patience = 0, max(SILENCE[0] // len(state.changes), SILENCE[1])
    while counts[COLLISIONS] < collisions:
        i = index(earliest(state))
        time = agenda.key[i]
        if time > until - clock[BASE] or time == math.inf:
            if until == math.inf:
                return SILENT
            clock[NOW] = until - clock[BASE]
            break
        clock[NOW] = time
        affected = execute_event(state, scene, i, int(agenda.kind[i]), time)
        for k in range(2):
            if affected[k] >= 0:
                predict_events(state, scene, index(affected[k]), time)
        if time >= clock[SPAN]:
            silent = 0 if counts[SINCE_REBASE] > 0 else silent + 1
            renew(state, scene)
            if until == math.inf and silent > patience:
                return SILENT
        elif not check_collapse(state, time):
            return COLLAPSED
    return REACHED


@jit
def execute_event(state, scene, i, kind, time):
    """Carry out an event of particle i; return whose future must be foreseen anew, or NOBODY."""
    agenda = state.agenda
    if kind == HORIZON:
        return i, NOBODY
    if agenda.boundary_time is not None and kind == BOUNDARY:
        code = agenda.boundary_code[i]
        return i, hooks.resolve_boundary(scene.effects, code, state, scene, i, time)
    kind = index(kind)
    partner = index(int(agenda.slot_partner[i, kind]))
    if agenda.slot_change[i, kind] != state.changes[partner]:  # its path is another by now
        state.counts[STALE] += 1
        drop_contact(agenda, i, kind)
        choose_next(state, i)
        return NOBODY, NOBODY
    collide(state, scene, i, partner, time)
    state.counts[SINCE_REBASE] += 1
    return i, partner


@jit
def predict_events(state, scene, i, time):
    """Predict all events of particle i: its next meeting with a boundary, and its contacts."""
    agenda = state.agenda
    state.counts[PREDICTIONS] += 1
    if state.cells is None:
        find_by_sweep(state, scene, i, time)
    else:
        find_around(state, scene, i, time)
    if agenda.boundary_time is not None:
        boundary = hooks.next_boundary(scene.effects, state, scene, i)
        agenda.boundary_time[i], agenda.boundary_code[i] = boundary
    choose_next(state, i)


@compiled
def renew(state, scene):
    """Move the clock's base up to the present, and all foreseen times with it."""
    step = rebase(state, scene)
    if state.cells is None:
        _shift_agenda(state, scene, step)
    else:
        arrange(state, scene, state.clock[NOW])
        clear_calendar(state)
        foresee_all(state)


@jit
def _shift_agenda(state, scene, step):
    agenda = state.agenda
    state.clock[EXTENT] = 0.0
    for i in range(len(state.changes)):
        redraw_line(state, scene, i)
        agenda.complete_until[i] -= step
        for k in range(agenda.slot_time.shape[1]):
            agenda.slot_time[i, k] -= step
        if agenda.boundary_time is not None:
            agenda.boundary_time[i] -= step
        enter_in_queue(state, i, agenda.key[i] - step)


@compiled
def start(state, scene):
    """Have everything foreseen again, after velocities were set from outside."""
    renew(state, scene)
    if state.cells is None:  # many are foreseen anew whenever the clock is
        foresee_all(state)


@jit
def foresee_all(state):
    """Let the next event of every particle be that its future is foreseen."""
    for i in range(len(state.changes) - 1, -1, -1):
        state.agenda.kind[i] = HORIZON
        enter_in_queue(state, i, state.clock[NOW])
