"""The event loop: take the earliest event, carry it out, predict the next ones; and the clock."""

import math

from roughgas.compiling.jit import compiled, jit
from roughgas.compiling.lanes import assume_nonnegative
from roughgas.kernel import hooks
from roughgas.kernel.cells import align_regions_if_due, list_around, sort_particles
from roughgas.kernel.contact import collide
from roughgas.kernel.event_lists import (
    FLIGHTS_AHEAD,
    clear_calendar,
    clear_contacts,
    earliest,
    enter_in_queue,
    queue_next_event,
)
from roughgas.kernel.hooks import CODES, active
from roughgas.kernel.mathematics import dot
from roughgas.kernel.particles import path_of
from roughgas.kernel.prediction import predict_contacts
from roughgas.kernel.state import (
    BASE,
    BOUNDARY,
    BOUNDARY_HITS,
    COLLISIONS,
    EXTENT,
    HORIZON,
    INSTANT_END,
    LONGEST_HORIZON,
    NOBODY,
    NOW,
    PREDICTIONS,
    SIMULTANEOUS_EVENTS,
    SINCE_REBASE,
    SLOW_CONTACTS,
    SPAN,
    STALE_PREDICTIONS,
    TYPICAL_SPEED,
)
from roughgas.kernel.sweep import horizon, line_of, list_by_sweep, store_line

REACHED, COLLAPSED, NO_COLLISIONS, TRAPPED = range(4)  # outcomes of `advance`
# Limit of consecutive spans without a collision: SILENT_PARTICLE_SPANS divided by the number of
# particles, but at least MIN_SILENT_SPANS. For 100 particles they take a few seconds.
SILENT_PARTICLE_SPANS, MIN_SILENT_SPANS = 10_000_000, 1000
CELLS_PER_SPAN = 16.0  # cells that a typical particle crosses before all are re-sorted
INSTANT = 2.0**-30  # of a span: events within it count as simultaneous
MAX_SLOW_CONTACTS = 10  # simultaneous contacts of particles that hardly approach
# Limit of the number of simultaneous events: a constant, and a multiple of the number of particles
MAX_SIMULTANEOUS, MAX_SIMULTANEOUS_PER_PARTICLE = 100_000, 10


@jit
def advance(state, scene, until, collisions, hits):
    """Run the gas to the absolute time `until`, or to a number of collisions; return the outcome.

    `until` is in current units, and counts from the last rescaling; `collisions` and `hits` are
    totals since the start. Outcomes: REACHED: run to either. COLLAPSED: the work per simulated time
    diverges (inelastic collapse). NO_COLLISIONS: `until` is inf, and collisions have ceased.
    TRAPPED: there have been more than `hits` contacts with walls and floor.
    """
    clock, counts, agenda = state.clock, state.counts, state.agenda
    silent_spans = 0
    max_silent_spans = max(SILENT_PARTICLE_SPANS // len(state.changes), MIN_SILENT_SPANS)
    while counts[COLLISIONS] < collisions:
        i = assume_nonnegative(earliest(state))
        time = agenda.key[i]
        if time > until - clock[BASE] or time == math.inf:
            if until == math.inf:
                return NO_COLLISIONS
            clock[NOW] = until - clock[BASE]
            break
        clock[NOW] = time
        affected = execute_event(state, scene, i, int(agenda.kind[i]), time)
        predict_events(state, scene, affected, time)
        if agenda.boundary_time is not None and counts[BOUNDARY_HITS] > hits:
            return TRAPPED
        if state.cells is not None:
            align_regions_if_due(state, scene, time)
        if time >= clock[SPAN]:
            silent_spans = 0 if counts[SINCE_REBASE] > 0 else silent_spans + 1
            renew(state, scene)
            if until == math.inf and silent_spans > max_silent_spans:
                return NO_COLLISIONS
        elif not check_collapse(state, time):
            return COLLAPSED
    return REACHED


@jit
def execute_event(state, scene, i, kind, time):
    """Carry out an event of particle i at `time`; return the two particles to predict anew.

    NOBODY stands for a missing one. `kind` is a contact slot, HORIZON or BOUNDARY, as in
    Agenda.kind. A contact whose partner has changed its path in the meantime is dropped.
    """
    agenda = state.agenda
    if kind == HORIZON:
        return i, NOBODY
    if agenda.boundary_time is not None and kind == BOUNDARY:
        return i, _resolve_boundary(state, scene, i, agenda.boundary_code[i], time)
    kind = assume_nonnegative(kind)
    partner = assume_nonnegative(int(agenda.slot_partner[i, kind]))
    if agenda.slot_change[i, kind] != state.changes[partner]:  # its path has changed since
        state.counts[STALE_PREDICTIONS] += 1
        agenda.slot_time[i, kind] = math.inf
        queue_next_event(state, i)
        return NOBODY, NOBODY
    collide(state, scene, i, partner, time)
    state.counts[SINCE_REBASE] += 1
    return i, partner


@jit
def _resolve_boundary(state, scene, i, code, time):
    """Carry out an effect's event; return a second particle of changed velocity, or NOBODY.

    `code` is CODES * account + the effect's own event code, as in Agenda.boundary_code.
    """
    for hook in active(scene.effects, "resolve"):
        if code // CODES == hook.account:
            effect = scene.effects[hook.effect_index]
            return hook.function(effect, hook.account, code % CODES, state, scene, i, time)
    return NOBODY


@jit
def predict_events(state, scene, affected, time):
    """Predict all events of up to two particles from `time` on: contacts, and events of effects.

    `affected` is a pair of particles; the first or the second may be NOBODY. Each step is done for
    both particles before the next step: while one particle's result is pending, the processor works
    on the other.
    """
    number = int(affected[0] != NOBODY) + int(affected[1] != NOBODY)
    state.counts[PREDICTIONS] += number
    shortlist, room = state.shortlist, len(state.shortlist.found) // 2
    if state.cells is None:
        for k in range(number):
            i = assume_nonnegative(affected[k])
            clear_contacts(state.agenda, i, time + horizon(state, scene, i))
    for k in range(number):
        i = assume_nonnegative(affected[k])
        if state.cells is None:
            shortlist.beyond[k] = list_by_sweep(state, scene, i, k * room, time)
        else:
            shortlist.beyond[k] = list_around(state, scene, i, k * room, time)
    for k in range(number):
        beyond = assume_nonnegative(shortlist.beyond[k])
        predict_contacts(state, scene, assume_nonnegative(affected[k]), k * room, beyond, time)
    for k in range(number):
        i = assume_nonnegative(affected[k])
        if state.agenda.boundary_time is not None:
            _predict_boundary(state, scene, i)
        queue_next_event(state, i)


@jit
def _predict_boundary(state, scene, i):
    """Store time and code of the earliest event of an effect for particle i on the agenda."""
    agenda, effects = state.agenda, scene.effects
    earliest_time, earliest_code = math.inf, 0
    for hook in active(effects, "predict"):
        time, event_code = hook.function(effects[hook.effect_index], hook.account, state, scene, i)
        if time < earliest_time:
            earliest_time, earliest_code = time, CODES * hook.account + event_code
    agenda.boundary_time[i], agenda.boundary_code[i] = earliest_time, earliest_code


@compiled
def renew(state, scene):
    """Move the clock's base up to the present, and all predicted times with it.

    In cells the particles are sorted anew, and all their events predicted again.
    """
    step = rebase(state, scene)
    if state.cells is None:
        _shift_agenda(state, scene, step)
    else:
        sort_particles(state, scene, state.clock[NOW])
        clear_calendar(state)
        repredict_all(state)


@jit
def _shift_agenda(state, scene, step):
    """Reduce all times on the agenda by `step`; store the lines for the sweep from the new base."""
    agenda = state.agenda
    state.clock[EXTENT] = 0.0
    for i in range(len(state.changes)):
        line, velocity = line_of(state, scene, i)
        store_line(state, i, line, velocity)
        agenda.complete_until[i] -= step
        for k in range(agenda.slot_time.shape[1]):
            agenda.slot_time[i, k] -= step
        if agenda.boundary_time is not None:
            agenda.boundary_time[i] -= step
        enter_in_queue(state, i, agenda.key[i] - step)


@compiled
def restart(state, scene):
    """Re-predict all events, after velocities were changed from outside."""
    renew(state, scene)
    if state.cells is None:  # with cells, `renew` does it
        repredict_all(state)


@jit
def repredict_all(state):
    """Schedule an immediate re-prediction for every particle."""
    for i in range(len(state.changes) - 1, -1, -1):
        state.agenda.kind[i] = HORIZON
        enter_in_queue(state, i, state.clock[NOW])


@jit
def check_collapse(state, time):
    """Count an event at `time`; return False if events accumulate without progress in time.

    In an inelastic collapse infinitely many contacts of a few particles occur in a finite time, at
    decreasing speeds. It is detected by MAX_SLOW_CONTACTS contacts at almost zero speed (STICKING
    in contact.py) within an instant. Symmetry can make a few events per particle simultaneous; more
    than MAX_SIMULTANEOUS, and MAX_SIMULTANEOUS_PER_PARTICLE for each particle, are a fault, and
    without this limit the run would never end.
    """
    clock, counts = state.clock, state.counts
    if time > clock[INSTANT_END]:
        clock[INSTANT_END] = time + INSTANT * clock[SPAN]
        counts[SIMULTANEOUS_EVENTS] = 0
        counts[SLOW_CONTACTS] = 0
    counts[SIMULTANEOUS_EVENTS] += 1
    max_events = MAX_SIMULTANEOUS + MAX_SIMULTANEOUS_PER_PARTICLE * len(state.changes)
    return (counts[SLOW_CONTACTS] < MAX_SLOW_CONTACTS) & (counts[SIMULTANEOUS_EVENTS] < max_events)


@jit
def rebase(state, scene):
    """Move the base up to the present, by an integer number of spans; return its displacement.

    Span and longest horizon are updated. A span is a power of two, so that the base stays exact,
    and about the time that a typical particle takes to cross the box, or CELLS_PER_SPAN cells. The
    times on the agenda still count from the old base.
    """
    clock, particle_times = state.clock, state.particle_times
    step = math.floor(clock[NOW] / clock[SPAN]) * clock[SPAN]
    clock[NOW] -= step
    clock[INSTANT_END] -= step
    for i in range(len(state.changes)):
        state.trajectory[i, 2 * len(scene.box)] -= step
        for k in range(len(particle_times)):
            if particle_times[k] is not None:
                particle_times[k][i] -= step
    clock[BASE] += step
    for hook in active(scene.effects, "phase"):
        state.phase[hook.account] = hook.function(
            scene.effects[hook.effect_index], hook.account, clock[BASE]
        )
    _update_span_and_horizon(state, scene, step)
    return step


@jit
def _update_span_and_horizon(state, scene, elapsed):
    """Set the clock's typical speed, span and longest horizon, `elapsed` after the last update."""
    clock, counts = state.clock, state.counts
    number = len(state.changes)
    total = 0.0
    image_shift = hooks.image_shift(scene.effects, state)
    for i in range(number):
        x, v, _ = path_of(state.trajectory, i, scene.box)
        if active(scene.effects, "image_shift"):  # relative to the mean flow, up to a constant
            v = (v[0] - image_shift[1] * (x[1] / scene.box[1] - 0.5),) + v[1:]
        total += dot(v, v)
    speed = math.sqrt(total / number)
    clock[TYPICAL_SPEED] = speed
    if speed > 0.0:
        distance = scene.extent
        if state.cells is not None:
            distance = min(distance, CELLS_PER_SPAN * max(state.cells.widths))
        clock[SPAN] = math.ldexp(0.5, math.frexp(distance / speed)[1])
    clock[LONGEST_HORIZON] = math.inf
    if counts[SINCE_REBASE] > number and elapsed > 0.0:
        clock[LONGEST_HORIZON] = FLIGHTS_AHEAD * elapsed * number / (2.0 * counts[SINCE_REBASE])
    counts[SINCE_REBASE] = 0
