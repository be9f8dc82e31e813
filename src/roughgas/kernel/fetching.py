"""Among many particles, ask the memory ahead for what the events of the calendar's next days need.

A read that the caches cannot answer takes as long as a hundred additions, and an event has some
twenty of them. Nothing here has an effect on any result.
"""

from roughgas.kernel.jit import jit
from roughgas.kernel.lanes import prefetch


@jit
def fetch_ahead(state, day):
    """Ask the memory for what the events after `day` need, so that they need not wait for it.

    Only what has arrived can tell what is needed next: first the particles that come first and
    second on a day's list, a day later their partners and the cells around them. Particle 0 stands
    for one that is not there, since the processor could not foresee a branch.
    """
    queue = state.queue
    _fetch(state, _first_of(queue, day + 4))
    first = _first_of(queue, day + 3)
    _fetch(state, _or_zero(queue.later[first]))
    _fetch(state, _partner(state.agenda, first))
    first = _first_of(queue, day + 2)
    second = _or_zero(queue.later[first])
    _fetch(state, _partner(state.agenda, second))
    _fetch_around(state, first)
    _fetch_around(state, _or_zero(queue.later[_first_of(queue, day + 1)]))


@jit
def _first_of(queue, day):
    return _or_zero(queue.first[day & (queue.first.size - 1)])


@jit
def _or_zero(i):
    return max(int(i), 0)


@jit
def _partner(agenda, i):
    return _or_zero(agenda.slot_partner[i, _or_zero(agenda.kind[i])])


@jit
def _fetch(state, i):
    prefetch(state.agenda.key, i)
    prefetch(state.trajectory, i)


@jit
def _fetch_around(state, i):
    """Ask for those in the cells before and behind; those beside i are near it in memory, too."""
    cells = state.cells
    for step in (-1, 1):
        cell = cells.home[i] + step * cells.counts[0]
        cell = max(0, min(cell, cells.first.size - 1))
        prefetch(state.trajectory, _or_zero(cells.first[cell]))
