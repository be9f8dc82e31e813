"""The order in which many particles lie in memory: that of their cells.

Neighbours in space are then neighbours in memory, and mostly in the cache when they are needed. As
particles move they are numbered anew now and then; State.label keeps the numbers of the start.
"""

from roughgas.kernel.cells import settle
from roughgas.kernel.hooks import unless_absent
from roughgas.kernel.jit import jit
from roughgas.kernel.state import NOBODY
from roughgas.kernel.unroll import unrolled


@jit
def arrange(state, scene, time):
    """Number the particles anew, in the order of their cells. The calendar's lists are lost."""
    _settle_all(state, scene, time)
    order, cells = state.queue.later, state.cells
    number = 0
    for cell in range(cells.first.size):
        i = cells.first[cell]
        while i != NOBODY:
            order[number] = i
            number += 1
            i = cells.following[i]
    for i in range(number):
        place = i
        while order[place] != i:  # a cycle of the permutation
            source = order[place]
            _exchange(state, place, source)
            order[place] = place
            place = source
        order[place] = place
    _settle_all(state, scene, time)


@jit
def _settle_all(state, scene, time):
    cells = state.cells
    for cell in range(cells.first.size):
        cells.first[cell] = NOBODY
    for i in range(len(state.changes) - 1, -1, -1):
        settle(state, scene, i, time)


@jit
def _exchange(state, i, j):
    _exchange_rows(state.trajectory, i, j)
    _exchange_spins(state.spin, i, j)
    _exchange_bodies(state.bodies, i, j)
    _exchange_moments(state.moments, i, j)
    _exchange_entries(state.changes, i, j)
    _exchange_entries(state.label, i, j)


@jit
def _exchange_rows(array, i, j):
    for k in range(array.shape[1]):
        array[i, k], array[j, k] = array[j, k], array[i, k]


_exchange_spins = unless_absent(_exchange_rows.py_func)


@jit
def _exchange_entries(array, i, j):
    array[i], array[j] = array[j], array[i]


@unless_absent
def _exchange_bodies(bodies, i, j):
    _exchange_entries(bodies.radius, i, j)
    _exchange_entries(bodies.mass, i, j)
    _exchange_entries(bodies.inertia, i, j)
    _exchange_entries(bodies.species, i, j)


@unrolled
def _exchange_moments(moments, i, j):
    for k in range(len(moments)):
        if moments[k] is not None:
            _exchange_entries(moments[k], i, j)
