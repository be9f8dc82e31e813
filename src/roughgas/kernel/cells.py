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

In a dense layer (Scene.lists) a particle meets those around it many times before any of them has
moved on. There each keeps a list of its neighbours. It has a region, a few tenths of a radius wide,
and on its list are all whose regions are so near that the two may meet while both are in them. One
that leaves its region gets a new one around it, and both its own list and those of its neighbours
are mended. All regions move as the layer does in the mean, so that particles that fly together stay
in theirs. Cells tell who is near: they hold the middles of the regions.

Particles lie in memory in the order of their cells: neighbours are mostly in the cache when they
are needed. As particles move they are numbered anew now and then; State.label keeps the numbers of
the start.
"""

import math

import numpy as np

from roughgas.compiling.jit import compiled, jit
from roughgas.compiling.lanes import (
    bits,
    gather,
    index,
    lanes_of,
    larger,
    numbers_in,
    order,
    trailing_zeros,
)
from roughgas.kernel import hooks
from roughgas.kernel.event_lists import choose_next, clear_contacts, enter, unlink
from roughgas.kernel.hooks import present
from roughgas.kernel.mathematics import dot, read, subtract, write
from roughgas.kernel.memory import NARROWEST, ROOM
from roughgas.kernel.particles import (
    fold_into_box,
    image_numbers,
    largest_of,
    position_and_velocity,
    shifted,
    slid,
)
from roughgas.kernel.state import ALIGNED, NOBODY, PREDICTIONS, SPAN

ALL = -1  # every axis
ORIGIN = 0.38196601125  # where cells begin, in their widths: no lattice has many sites on an edge
ALIGN_EVERY = 2  # predictions of each particle
AT_ONCE = tuple(range(4))  # particles whose followers are read before any is put on a list


@jit
def list_around(state, scene, i, begin, time):
    """List the particles around particle i in the shortlist, from `begin` on; return the end."""
    if state.cells.neighbours is None:
        return _list_in_cells(state, scene, i, begin, time)
    if time >= state.cells.leave[i]:
        _move_region(state, scene, i, begin, time)
    _foresee_exit(state, scene, i, time)
    clear_contacts(state.agenda, i, time + state.clock[SPAN])
    return _members(state, i, begin)


@jit
def _list_in_cells(state, scene, i, begin, time):
    """List those in all cells around; if particle i leaves its cell now, only in the new ones."""
    agenda, cells = state.agenda, state.cells
    moved_on = time >= cells.leave[i]
    axis, step = _move_on(state, scene, i, time) if moved_on else (ALL, 0)
    home = places(cells, i)
    d, u = _in_cell(state, scene, i, time, home)
    cells.leave[i], cells.heading[i] = _exit(scene, time, d, u, cells.widths)
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
    return _collect(state, home, begin, slide, outlook, axis, step)


@jit
def settle(state, scene, i, time):
    """Put particle i on the list of its cell at `time`, and in the middle of its own region."""
    cells = state.cells
    position, velocity = position_and_velocity(state, scene, i, time)
    if cells.neighbours is not None:
        position, velocity = _in_frame(cells.neighbours, position, velocity, time)
        write(cells.neighbours.middle, i, 0, position)
        cells.neighbours.number[i] = 0
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
def _in_cell(state, scene, i, time, home):
    """Return particle i's position relative to the middle of its home, and its velocity there."""
    cells, widths = state.cells, state.cells.widths
    position, velocity = position_and_velocity(state, scene, i, time)
    slide = slid(hooks.sliding(scene.effects, state), time)
    position, velocity = _beside_row(slide, cells, home[1], position, velocity)
    middle = tuple(widths[k] * (home[k] + ORIGIN + 0.5) for k in range(len(widths)))
    d = subtract(position, middle)
    return shifted(d, velocity, image_numbers(d, cells.periods, slide), cells.periods, slide)


@jit
def _beside_row(slide, cells, row, position, velocity):
    """Return position and velocity relative to a row of cells, which slides under shear."""
    if slide is None:
        return position, velocity
    share = (row + ORIGIN + 0.5) / cells.counts[1] - 0.5
    return (
        (position[0] - share * slide[0],) + position[1:],
        (velocity[0] - share * slide[1],) + velocity[1:],
    )


@jit
def places(cells, i):
    """Return which cell along each axis is particle i's home."""
    home, across = index(int(cells.home[i])), index(cells.counts[0])
    level = index(across * cells.counts[1])
    if len(cells.counts) == 2:
        return home % across, home // across
    return home % across, home % level // across, home // level


@jit
def _exit(scene, now, d, u, widths):
    """Return when a particle in free flight leaves its cell, and its heading then."""
    gravity, last = hooks.acceleration(scene.effects), len(d) - 1
    time, up = _fall_out(gravity, d[last], u[last], 0.5 * widths[last])
    axis = last
    for k in range(last):
        other, forward = _fly_out(d[k], u[k], 0.5 * widths[k])
        if other < time:
            time, up, axis = other, forward, k
    return now + time, 2 * axis + int(up)


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
    cells, heading = state.cells, int(state.cells.heading[i])
    axis, step = heading // 2, 2 * (heading % 2) - 1
    unlink(cells.first, cells.following, cells.home[i], i)
    home = places(cells, i)
    cells.home[i] += _along(cells.counts, home, axis, step) - _along(cells.counts, home, axis, 0)
    if axis == 1:
        _find_column(state, scene, i, time)
    enter(cells.first, cells.following, cells.home[i], i)
    return axis, step


@jit
def _find_column(state, scene, i, time):
    """Correct the column of a particle's home, which is in the right row, if rows have slid."""
    if present(scene.effects, "sliding"):
        cells, home = state.cells, places(state.cells, i)
        d, _ = _in_cell(state, scene, i, time, home)
        moved = (home[0] + round(d[0] / cells.widths[0])) % cells.counts[0]
        cells.home[i] += moved - home[0]


@jit
def wrapped(place, count):
    """Return a place that is up to one period off, brought back."""
    return place + count if place < 0 else place - count if place >= count else place


@jit
def _collect(state, home, begin, slide, duration, axis, step):
    """List the particles around a cell in the shortlist, from `begin` on; return the end.

    Take all cells around, or only those a step further along an axis: the first particle of each
    cell, then those that follow the ones on the list, with no branch that depends on what is there.
    """
    cells, found, number = state.cells, state.shortlist.found, begin
    if axis == ALL:
        for along in range(-1, 2):
            number = _list_slab(cells, found, number, home, len(home) - 1, along, slide, duration)
    else:
        number = _list_slab(cells, found, number, home, axis, step, slide, duration)
    k = begin
    while k < number:
        k, number = _append_followers(cells.following, found, number, k, AT_ONCE)
    found[index(number)] = 0  # `decide` reads on to the end of a register
    return number


@jit
def _list_slab(cells, found, number, home, axis, step, slide, duration):
    """List the first particle of each cell of a slab, a step from home along an axis.

    Which axis, the processor could not foresee: there is no branch for it. It is the last where
    rows slide past each other.
    """
    if slide is not None:
        return _list_sliding(cells, found, number, home, step, slide, duration)
    counts, x, y = cells.counts, _beside(cells.counts, home, 0), _beside(cells.counts, home, 1)
    here = _along(counts, home, 0, step) if axis == 0 else _along(counts, home, 1, step)
    across, up = y if axis == 0 else x, (0,)
    if len(home) == 3:
        here = _along(counts, home, 2, step) if axis == 2 else here
        up = y if axis == 2 else _beside(cells.counts, home, 2)
    for n in range(len(up)):
        for m in range(len(across)):
            number = _append(found, number, cells.first[index(here + across[m] + up[n])])
    return number


@jit
def _along(counts, home, axis, step):
    """Return what the place a step from home along an axis adds to the number of a cell."""
    stride = 1
    for k in range(axis):
        stride *= counts[k]
    return stride * wrapped(home[axis] + step, counts[axis])


@jit
def _beside(counts, home, axis):
    """Return what the place before, the same and the next one along an axis add to it."""
    return tuple(_along(counts, home, axis, step) for step in range(-1, 2))


@jit
def _list_sliding(cells, found, number, home, step, slide, duration):
    counts = cells.counts
    level = _along(counts, home, 2, step) if len(home) == 3 else 0
    for up in range(-1, 2) if len(home) == 3 else range(step, step + 1):
        row = level + _along(counts, home, 1, up)
        by = up / (counts[1] * cells.widths[0])
        begin, slip = home[0] - 1 - by * slide[0], by * slide[1] * duration
        first = math.floor(begin - max(slip, 0.0))
        # of a row that has slid, the columns at both ends are beside home in part
        number_of_columns = math.floor(begin + 3 - min(slip, 0.0)) - first + (up != 0)
        first %= counts[0]
        for column in range(first, first + number_of_columns):
            number = _append(found, number, cells.first[index(row + wrapped(column, counts[0]))])
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


# ------------------------------------------------------------------ lists of neighbours


@jit
def _foresee_exit(state, scene, i, time):
    """Note when particle i leaves its region."""
    cells, neighbours = state.cells, state.cells.neighbours
    position, velocity = position_and_velocity(state, scene, i, time)
    position, velocity = _in_frame(neighbours, position, velocity, time)
    d = subtract(position, read(neighbours.middle, i, 0, position))
    d, velocity = shifted(d, velocity, image_numbers(d, scene.box, None), scene.box, None)
    cells.leave[i] = _exit(scene, time, d, velocity, neighbours.sides)[0]


@jit
def _in_frame(neighbours, position, velocity, time):
    """Return position and velocity relative to the frame in which regions rest."""
    frame = neighbours.frame
    height = position[-1] - (frame[0] + frame[1] * time)
    return position[:-1] + (height,), velocity[:-1] + (velocity[-1] - frame[1],)


@jit
def _members(state, i, begin):
    """Put the neighbours of particle i on the shortlist, from `begin` on, and more if its own list
    lacks some; return the end."""
    neighbours, found = state.cells.neighbours, state.shortlist.found
    if neighbours.number[i] > ROOM:
        return _collect(state, places(state.cells, i), begin, None, 0.0, ALL, 0)
    for k in range(ROOM):
        found[begin + k] = neighbours.members[i, k]
    return begin + int(neighbours.number[i])


@compiled
def _move_region(state, scene, i, begin, time):
    """Let the region of particle i be around where it is at `time`."""
    cells = state.cells
    for k in range(begin, _members(state, i, begin)):
        _remove(cells.neighbours, state.shortlist.found[k], i)
    unlink(cells.first, cells.following, cells.home[i], i)
    settle(state, scene, i, time)
    _list_neighbours(state, scene, i, begin, len(state.changes))


@jit
def _list_neighbours(state, scene, i, begin, end):
    """Put those near particle i, of numbers below `end`, on its list, and it on theirs."""
    neighbours, found = state.cells.neighbours, state.shortlist.found
    number = _collect(state, places(state.cells, i), begin, None, 0.0, ALL, 0)
    middle = read(neighbours.middle, i, 0, scene.box)
    reach = NARROWEST * largest_of(state.bodies)
    lanes = lanes_of(state.shortlist.when)
    for first in range(begin, number, lanes):
        others = numbers_in(found, first, lanes)
        x = tuple(gather(neighbours.middle, k, others) - middle[k] for k in range(len(scene.box)))
        x, _ = shifted(x, x, image_numbers(x, scene.box, None), scene.box, None)
        gap = tuple(larger(abs(x[k]) - neighbours.sides[k], 0.0) for k in range(len(scene.box)))
        near = bits((dot(gap, gap) < reach * reach) & (order(lanes) < number - first))
        while near != np.uint64(0):
            j = index(int(found[index(first + trailing_zeros(near))]))
            if (j != i) & (j < end):
                _add(neighbours, i, j)
                _add(neighbours, j, i)
            near &= near - np.uint64(1)


@jit
def _add(neighbours, i, j):
    count = neighbours.number[i]
    if count < ROOM:
        neighbours.members[i, count] = j
    neighbours.number[i] = min(count + 1, ROOM + 1)


@jit
def _remove(neighbours, i, j):
    """Take j off the list of particle i. One that lacks some stays so until i moves its region."""
    count, members = neighbours.number[i], neighbours.members
    if count > ROOM:
        return
    for k in range(count):
        if members[i, k] == j:
            members[i, k] = members[i, count - 1]
            neighbours.number[i] = count - 1
            return


@jit
def align_now_and_then(state, scene, time):
    """Let the regions of neighbour lists, if there are any, go on moving as the particles do."""
    if state.cells.neighbours is None:
        return
    counts = state.counts
    if counts[PREDICTIONS] - counts[ALIGNED] > ALIGN_EVERY * len(state.changes):
        _align(state, scene, time)
        for i in range(len(state.changes)):
            choose_next(state, i)


@compiled
def _align(state, scene, time):
    frame, total = state.cells.neighbours.frame, 0.0
    for i in range(len(state.changes)):
        total += position_and_velocity(state, scene, i, time)[1][-1]
    velocity = total / len(state.changes)
    frame[0] += (frame[1] - velocity) * time  # where regions are now does not change
    frame[1] = velocity
    for i in range(len(state.changes)):
        _foresee_exit(state, scene, i, time)
    state.counts[ALIGNED] = state.counts[PREDICTIONS]


# ------------------------------------------------------------------ particles in order


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
    if cells.neighbours is not None:
        _align(state, scene, time)
        for i in range(len(state.changes)):
            _list_neighbours(state, scene, i, 0, i)


@jit
def _settle_all(state, scene, time):
    cells = state.cells
    if cells.neighbours is not None:
        cells.neighbours.frame[:] = 0.0
    cells.first[:] = NOBODY
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
