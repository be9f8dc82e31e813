"""Which particles may meet a given one soon: those in its cell and in the cells around it.

A cell is at least a diameter wide, so a particle has to enter a neighbouring cell before it can be
met. Each particle foresees its contacts with the particles around it up to the time at which it
leaves its cell; then it looks around again. A particle that has entered its neighbourhood in the
meantime has looked around, too, and has found it. Paths do not depend on the cells: like the sweep,
they leave no trace in the results.

Cells repeat with a period on each axis. That of an open axis has no meaning: particles a period
away are considered, and never met. Under shear each row of cells moves with the mean flow, row k
of n by about (k + 1/2)/n - 1/2 of what the images above the box have slid: rows slide past each
other slowly, and past the images no faster.

Particles lie in memory in the order of their cells: neighbours are mostly in the cache when they
are needed. As particles move they are numbered anew now and then; State.label keeps the numbers of
the start.
"""

import math
import sys

from roughgas.kernel import hooks
from roughgas.kernel.event_lists import clear_contacts, enter, unlink
from roughgas.kernel.hooks import present
from roughgas.kernel.jit import jit
from roughgas.kernel.mathematics import index, subtract
from roughgas.kernel.particles import (
    fold_into_box,
    image_numbers,
    position_and_velocity,
    shifted,
    slid,
)
from roughgas.kernel.prediction import decide
from roughgas.kernel.state import NOBODY, SPAN

ALL = -1  # every axis
ORIGIN = 0.38196601125  # where cells begin, in their widths: no lattice has many sites on an edge
FARTHEST = sys.float_info.max
AT_ONCE = tuple(range(8))  # particles whose followers are read before any is put on a list


@jit
def find_around(state, scene, i, time):
    """Foresee particle i's contacts with the particles around it; if it leaves its cell now, only
    with those that enter its neighbourhood by that."""
    agenda, cells = state.agenda, state.cells
    moved_on = time >= cells.leave[i]
    axis, step = _move_on(state, scene, i, time) if moved_on else (ALL, 0)
    d, u = _in_cell(state, scene, i, time)
    gravity = hooks.acceleration(scene.effects)
    cells.leave[i] = time + _exit(d, u, cells.widths, gravity)[0]
    slide = slid(hooks.sliding(scene.effects, state), time)
    known = moved_on and state.trajectory[i, 2 * len(scene.box)] < time < agenda.complete_until[i]
    outlook = state.clock[SPAN]
    if present(scene.effects, "sliding"):
        # rows slide past each other by one cell at most; cells of rows that have slid are not in
        # line: one that moves on along them meets newcomers in part of another outlook
        outlook = min(outlook, cells.counts[1] * cells.widths[0] / abs(slide[1]))
        known = known and axis > 1
    if not known:
        axis = ALL
        clear_contacts(agenda, i, time + outlook)
    number = _collect(state, i, slide, outlook, axis, step)
    decide(state, scene, i, number, time, time, FARTHEST)


@jit
def settle(state, scene, i, time):
    """Put particle i on the list of the cell that it is in at `time`."""
    cells = state.cells
    position, velocity = position_and_velocity(state, scene, i, time)
    slide = slid(hooks.sliding(scene.effects, state), time)
    position, velocity = fold_into_box(position, velocity, cells.periods, slide)
    home = 0
    for k in range(len(position) - 1, -1, -1):
        place = math.floor(position[k] / cells.widths[k] - ORIGIN)
        home = home * cells.counts[k] + wrapped(place, cells.counts[k])
    cells.home[i] = home
    _find_column(state, scene, i, time)
    cells.leave[i] = math.inf
    enter(cells.first, cells.following, cells.home[i], i)


@jit
def _in_cell(state, scene, i, time):
    """Return particle i's position relative to the middle of its cell, and its velocity there."""
    cells = state.cells
    position, velocity = position_and_velocity(state, scene, i, time)
    slide = slid(hooks.sliding(scene.effects, state), time)
    position, velocity = _beside_row(slide, cells, cells.home[i], position, velocity)
    place, widths = places(cells.counts, cells.home[i]), cells.widths
    middle = tuple(widths[k] * (place[k] + ORIGIN + 0.5) for k in range(len(widths)))
    d = subtract(position, middle)
    return shifted(d, velocity, image_numbers(d, cells.periods, slide), cells.periods, slide)


@jit
def _beside_row(slide, cells, home, position, velocity):
    """Return position and velocity relative to a row of cells, which slides under shear."""
    if slide is None:
        return position, velocity
    row = home // cells.counts[0] % cells.counts[1]
    share = (row + ORIGIN + 0.5) / cells.counts[1] - 0.5
    return (
        (position[0] - share * slide[0],) + position[1:],
        (velocity[0] - share * slide[1],) + velocity[1:],
    )


@jit
def places(counts, home):
    """Return which cell along each axis the cell with this number is."""
    if len(counts) == 2:
        return home % counts[0], home // counts[0]
    return home % counts[0], home // counts[0] % counts[1], home // (counts[0] * counts[1])


@jit
def _exit(d, u, widths, gravity):
    """Return (time, axis, step) with which a particle in free flight leaves its cell."""
    last = len(d) - 1
    time, up = _fall_out(gravity, d[last], u[last], 0.5 * widths[last])
    axis = last
    for k in range(last):
        other, forward = _fly_out(d[k], u[k], 0.5 * widths[k])
        if other < time:
            time, up, axis = other, forward, k
    return time, axis, 1 if up else -1


@jit
def _fly_out(d, u, half):
    forward = u > 0.0
    gap = max(half - (d if forward else -d), 0.0)
    return (gap / abs(u) if u != 0.0 else math.inf), forward


@jit
def _fall_out(gravity, d, u, half):
    if gravity is None:
        return _fly_out(d, u, half)
    above, below = max(half - d, 0.0), max(half + d, 0.0)
    if u > 0.0 and u * u >= 2.0 * gravity * above:
        return 2.0 * above / (u + math.sqrt(u * u - 2.0 * gravity * above)), True
    root = math.sqrt(u * u + 2.0 * gravity * below)
    if u > 0.0:
        return (u + root) / gravity, False
    return (2.0 * below / (root - u) if below > 0.0 else 0.0), False


@jit
def _move_on(state, scene, i, time):
    """Move particle i into the next cell on its way; return the axis and the step that it takes."""
    cells = state.cells
    d, u = _in_cell(state, scene, i, time)
    _, axis, step = _exit(d, u, cells.widths, hooks.acceleration(scene.effects))
    unlink(cells.first, cells.following, cells.home[i], i)
    cells.home[i] = _next_to(cells.counts, cells.home[i], axis, step)
    if axis == 1:
        _find_column(state, scene, i, time)
    enter(cells.first, cells.following, cells.home[i], i)
    return axis, step


@jit
def _next_to(counts, home, axis, step):
    stride = 1
    for k in range(axis):
        stride *= counts[k]
    place = home // stride % counts[axis]
    return home + stride * (wrapped(place + step, counts[axis]) - place)


@jit
def _find_column(state, scene, i, time):
    """Correct the column of a particle's home, which is in the right row, if rows have slid."""
    if present(scene.effects, "sliding"):
        cells = state.cells
        d, _ = _in_cell(state, scene, i, time)
        place = cells.home[i] % cells.counts[0]
        moved = (place + round(d[0] / cells.widths[0])) % cells.counts[0]
        cells.home[i] += moved - place


@jit
def wrapped(place, count):
    """Return a place that is up to one period off, brought back."""
    return place + count if place < 0 else place - count if place >= count else place


@jit
def _collect(state, i, slide, duration, axis, step):
    """List the particles around particle i in the shortlist; return how many there are.

    Take all cells around, or only those a step further along an axis: the first particle of each
    cell, then those that follow the ones on the list, with no branch that depends on what is there.
    """
    cells, found, number = state.cells, state.shortlist.found, 0
    home = places(cells.counts, cells.home[i])
    for above in range(*_steps(len(home) - 1, axis, step) if len(home) == 3 else (0, 1)):
        level = 0
        if len(home) == 3:
            level = wrapped(home[-1] + above, cells.counts[-1]) * cells.counts[1]
        for up in range(*_steps(1, axis, step)):
            row = wrapped(home[1] + up, cells.counts[1])
            first, last = _columns(slide, cells, home[0], up, duration, _steps(0, axis, step))
            for column in range(first, last):
                cell = wrapped(column, cells.counts[0]) + cells.counts[0] * (row + level)
                number = _append(found, number, cells.first[index(cell)])
    k = 0
    while k < number:
        k, number = _append_followers(cells.following, found, number, k, AT_ONCE)
    found[index(number)] = 0  # `decide` reads on to the end of a register
    return number


@jit
def _append(found, number, j):
    """Return how many are on the list with j, if that is a particle."""
    found[index(number)] = j
    return number + int(j != NOBODY)


@jit
def _append_followers(following, found, number, k, those):
    """Do so with those that follow the k-th on the list and some after it, if these are there.

    Return how far the list is done. Each alone would wait for what was put on the list before it.
    """
    end = number
    behind = tuple(following[index(max(int(found[index(k + m)]), 0))] for m in range(len(those)))
    for m in range(len(those)):
        found[index(number)] = behind[m]
        number += int((behind[m] != NOBODY) & (k + m < end))
    return min(k + len(those), end), number


@jit
def _steps(along, axis, step):
    """Return the first and the end of the steps to take along an axis."""
    return (step, step + 1) if along == axis else (-1, 2)


@jit
def _columns(slide, cells, place, up, duration, steps):
    """Return first and end of the columns to look at in the same row or the next ones."""
    if slide is None or up == 0:
        return place + steps[0], place + steps[1]
    by = up / (cells.counts[1] * cells.widths[0])
    begin, slip = by * slide[0], by * slide[1] * duration
    first = math.floor(place - 1 - begin - max(slip, 0.0))
    last = math.floor(place + 2 - begin - min(slip, 0.0))
    column = first % cells.counts[0]
    return column, column + last - first + 1


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
    bodies = state.bodies
    _exchange_rows(state.trajectory, i, j)
    if state.spin is not None:
        _exchange_rows(state.spin, i, j)
    if bodies is not None:
        _exchange_entries((bodies.radius, bodies.mass, bodies.inertia, bodies.species), i, j)
    _exchange_entries(state.moments, i, j)
    _exchange_entries((state.changes, state.label), i, j)


@jit
def _exchange_rows(array, i, j):
    for k in range(array.shape[1]):
        array[i, k], array[j, k] = array[j, k], array[i, k]


@jit
def _exchange_entries(arrays, i, j):
    for k in range(len(arrays)):
        if arrays[k] is not None:
            arrays[k][i], arrays[k][j] = arrays[k][j], arrays[k][i]
