"""The event loop: take the earliest event, carry it out, foresee the next ones; and the clock."""

import math

from roughgas.compiling.jit import compiled, jit
from roughgas.compiling.lanes import index
from roughgas.kernel import hooks
from roughgas.kernel.cells import align_now_and_then, arrange, list_around
from roughgas.kernel.contact import collide
from roughgas.kernel.event_lists import (
    FLIGHTS,
    choose_next,
    clear_calendar,
    clear_contacts,
    earliest,
    enter_in_queue,
)
from roughgas.kernel.hooks import CODES, present
from roughgas.kernel.mathematics import dot
from roughgas.kernel.particles import path_of
from roughgas.kernel.prediction import decide
from roughgas.kernel.state import (
    AT_ONCE,
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
    SINCE_REBASE,
    SPAN,
    SPENT,
    STALE,
    TYPICAL_SPEED,
)
from roughgas.kernel.sweep import draw_line, horizon, line_of, list_by_sweep

REACHED, COLLAPSED, SILENT, HELD = range(4)  # how `advance` ends
# Spans without a collision after which none is waited for any longer: so many in all, divided among
# the particles, and so many at least. A hundred thousand of a gas of 100, a few seconds.
SILENCE = 10_000_000, 1000
CELLS = 16.0  # cells that a particle crosses before all are sorted anew
INSTANT = 2.0**-30  # of a span; events as close as this count as simultaneous
COLLAPSE = 10  # simultaneous contacts of particles that hardly approach
STANDSTILL = 100_000, 10  # simultaneous events, and as many more for each particle


@jit
def advance(state, scene, until, collisions, hits):
    """Run to the absolute time `until`, or to a total number of collisions; return the outcome.

    REACHED: at one of the two. COLLAPSED: the work per simulated time diverges (inelastic
    collapse). SILENT: no time was given, and the collisions that were asked for do not come. HELD:
    there were more than `hits` of walls and floor in all.
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
        predict_events(state, scene, affected, time)
        if agenda.boundary_time is not None and counts[BOUNDARY_HITS] > hits:
            return HELD
        if state.cells is not None:
            align_now_and_then(state, scene, time)
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
        return i, _resolve_boundary(state, scene, i, agenda.boundary_code[i], time)
    kind = index(kind)
    partner = index(int(agenda.slot_partner[i, kind]))
    if agenda.slot_change[i, kind] != state.changes[partner]:  # its path is another by now
        state.counts[STALE] += 1
        agenda.slot_time[i, kind] = math.inf
        choose_next(state, i)
        return NOBODY, NOBODY
    collide(state, scene, i, partner, time)
    state.counts[SINCE_REBASE] += 1
    return i, partner


@jit
def _resolve_boundary(state, scene, i, code, time):
    """Let an effect carry its event out; return another particle whose velocity has changed."""
    for part in present(scene.effects, "resolve"):
        if code // CODES == part.rank:
            effect = scene.effects[part.place]
            return part.own(effect, part.rank, code % CODES, state, scene, i, time)
    return NOBODY


@jit
def predict_events(state, scene, affected, time):
    """Predict all events of up to two particles: their meetings with boundaries, and contacts.

    Each step is done for both before the next, which waits for its result: the processor fills the
    wait of one particle with the work for the other.
    """
    number = int(affected[0] != NOBODY) + int(affected[1] != NOBODY)
    state.counts[PREDICTIONS] += number
    shortlist, room = state.shortlist, len(state.shortlist.found) // 2
    if state.cells is None:
        for k in range(number):
            i = index(affected[k])
            clear_contacts(state.agenda, i, time + horizon(state, scene, i))
    for k in range(number):
        i = index(affected[k])
        if state.cells is None:
            shortlist.beyond[k] = list_by_sweep(state, scene, i, k * room, time)
        else:
            shortlist.beyond[k] = list_around(state, scene, i, k * room, time)
    for k in range(number):
        beyond = index(shortlist.beyond[k])
        decide(state, scene, index(affected[k]), k * room, beyond, time)
    for k in range(number):
        i = index(affected[k])
        if state.agenda.boundary_time is not None:
            _predict_boundary(state, scene, i)
        choose_next(state, i)


@jit
def _predict_boundary(state, scene, i):
    agenda, effects = state.agenda, scene.effects
    first, code = math.inf, 0
    for part in present(effects, "predict"):
        when, what = part.own(effects[part.place], part.rank, state, scene, i)
        if when < first:
            first, code = when, CODES * part.rank + what
    agenda.boundary_time[i], agenda.boundary_code[i] = first, code


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
        line, velocity = line_of(state, scene, i)
        draw_line(state, i, line, velocity)
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


@jit
def check_collapse(state, time):
    """Note an event at `time`; return False where events accumulate as if time stood still.

    In an inelastic collapse infinitely many contacts of a few particles are made in a finite time,
    at less and less speed: contacts at almost no speed are its sign. Symmetry can make a few events
    per particle simultaneous; many more are a fault, which must not hang.
    """
    clock, counts = state.clock, state.counts
    if time > clock[INSTANT_END]:
        clock[INSTANT_END] = time + INSTANT * clock[SPAN]
        counts[AT_ONCE] = 0
        counts[SPENT] = 0
    counts[AT_ONCE] += 1
    many = STANDSTILL[0] + STANDSTILL[1] * len(state.changes)
    return (counts[SPENT] < COLLAPSE) & (counts[AT_ONCE] < many)


@jit
def rebase(state, scene):
    """Move the base up to the present, by a whole number of spans, and look at the gas afresh.

    A span is a power of two, so that the base stays exact, and about the time in which a typical
    particle crosses the box, or CELLS cells. Returns how far the base has moved; the times
    on the agenda still count from the old one.
    """
    clock, moments = state.clock, state.moments
    step = math.floor(clock[NOW] / clock[SPAN]) * clock[SPAN]
    clock[NOW] -= step
    clock[INSTANT_END] -= step
    for i in range(len(state.changes)):
        state.trajectory[i, 2 * len(scene.box)] -= step
        for k in range(len(moments)):
            if moments[k] is not None:
                moments[k][i] -= step
    clock[BASE] += step
    for part in present(scene.effects, "phase"):
        state.phase[part.rank] = part.own(scene.effects[part.place], part.rank, clock[BASE])
    _survey(state, scene, step)
    return step


@jit
def _survey(state, scene, elapsed):
    clock, counts = state.clock, state.counts
    number = len(state.changes)
    total = 0.0
    slide = hooks.sliding(scene.effects, state)
    for i in range(number):
        x, v, _ = path_of(state.trajectory, i, scene.box)
        if present(scene.effects, "sliding"):  # relative to the mean flow, up to a constant
            v = (v[0] - slide[1] * (x[1] / scene.box[1] - 0.5),) + v[1:]
        total += dot(v, v)
    speed = math.sqrt(total / number)
    clock[TYPICAL_SPEED] = speed
    if speed > 0.0:
        way = scene.extent
        if state.cells is not None:
            way = min(way, CELLS * max(state.cells.widths))
        clock[SPAN] = math.ldexp(0.5, math.frexp(way / speed)[1])
    clock[LONGEST_HORIZON] = math.inf
    if counts[SINCE_REBASE] > number and elapsed > 0.0:
        clock[LONGEST_HORIZON] = FLIGHTS * elapsed * number / (2.0 * counts[SINCE_REBASE])
    counts[SINCE_REBASE] = 0
