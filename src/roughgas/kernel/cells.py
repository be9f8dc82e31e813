"""Candidates for contacts with a particle: all particles in its cell and in adjacent cells.

A cell is at least a diameter wide, so a particle must enter an adjacent cell before it can be met.
The contacts of a particle with its candidates are predicted until it leaves its cell; then they are
predicted again, with the candidates of its new surroundings. When a particle enters the
surroundings in the meantime, its own prediction covers the pair. Paths do not depend on the cells:
like the sweep, they do not affect the results.

Cells repeat with a period on each axis. On an open axis the period has no physical meaning:
particles a period away are candidates, and never met. Under shear each row of cells moves with the
mean flow, row k of n by about (k + 1/2)/n - 1/2 of the image shift: rows slide past each other
slowly, and past the images no faster.

In a mixture of very different sizes each particle has a cell in the grid of its size class, and its
candidates are all particles in near cells of every grid (size_classes.py).

In a dense layer a particle collides with its neighbours many times before any of them moves away.
With the scheme LISTS each particle has a neighbour list. It is assigned a region, a few tenths of
a radius wide, and its list has all particles with regions so near that the two may meet while both
are inside. A particle that leaves its region gets a new one centred on it, and the neighbour lists
concerned are updated. All regions move with the mean velocity of the layer, so that particles that
fly together stay in theirs. Cells then contain the centres of the regions.

Particles are stored in the order of their cells, so that neighbours are mostly in the cache. As
particles move they are re-sorted from time to time; State.label has their initial numbers.
"""

import math

import numpy as np

from roughgas.compiling.jit import compiled, jit
from roughgas.compiling.lanes import (
    assume_nonnegative,
    bits,
    gather_rows,
    iota,
    lanes_of,
    larger,
    load_scalars,
    trailing_zeros,
)
from roughgas.kernel import hooks
from roughgas.kernel.event_lists import clear_contacts, push_front, queue_next_event, unlink
from roughgas.kernel.hooks import active
from roughgas.kernel.layout import LIST_CAPACITY, MIN_CELL_WIDTH
from roughgas.kernel.mathematics import dot, read, subtract, write
from roughgas.kernel.particles import (
    fold_into_box,
    image_numbers,
    image_shift_at,
    largest_of,
    position_and_velocity,
    radius_of,
    shifted,
)
from roughgas.kernel.size_classes import (
    ORIGIN,
    append_particle,
    grid_of_cell,
    grid_of_radius,
    indices_in,
    list_near_cells,
    wrapped,
)
from roughgas.kernel.state import ALIGNED, NOBODY, PREDICTIONS, SPAN

ALL_AXES = -1
ALIGN_EVERY = 2  # predictions per particle
BATCH = tuple(range(4))  # particles whose followers are read before any is appended to a list


@jit
def list_around(state, scene, i, begin, time):
    """Write particle i's candidates for contacts to the shortlist; return the end index.

    The shortlist is filled from index `begin` on. A particle that leaves its cell or region at
    `time` is first moved to the next one. The predicted contacts that the candidates replace are
    removed.
    """
    if state.cells.neighbours is None:
        return _list_in_cells(state, scene, i, begin, time)
    if time >= state.cells.leave[i]:
        _move_region(state, scene, i, begin, time)
    _predict_exit(state, scene, i, time)
    clear_contacts(state.agenda, i, time + state.clock[SPAN])
    return _list_members(state, i, begin)


@jit
def _list_in_cells(state, scene, i, begin, time):
    """Write the particles in i's cell and all adjacent ones to the shortlist; return the end index.

    The shortlist is filled from index `begin` on. If particle i just leaves its cell, and its
    predicted contacts remain valid, only the particles in cells that become adjacent are written.
    """
    agenda, cells = state.agenda, state.cells
    leaves_cell = time >= cells.leave[i]
    grid = grid_of_cell(cells, cells.home[i])
    axis, step = _change_cell(state, scene, i, time, grid) if leaves_cell else (ALL_AXES, 0)
    home = indices_in(grid, cells.home[i])
    d, u = _relative_to_cell(state, scene, i, time, grid, home)
    cells.leave[i], cells.heading[i] = _exit_from(scene, time, d, u, grid.widths)
    image_shift = image_shift_at(hooks.image_shift(scene.effects, state), time)
    only_new_cells = (
        leaves_cell and state.trajectory[i, 2 * len(scene.box)] < time < agenda.complete_until[i]
    )
    horizon = state.clock[SPAN]
    if active(scene.effects, "image_shift"):
        # rows slide past each other by at most a cell within a horizon; sliding rows are not
        # aligned, so that after a step along a row some new candidates were not in the last list
        horizon = min(horizon, cells.counts[1] * cells.widths[0] / abs(image_shift[1]))
        only_new_cells = only_new_cells and axis > 1
    if not only_new_cells:
        axis = ALL_AXES
        clear_contacts(agenda, i, time + horizon)
    candidates, number = state.shortlist.found, begin
    if grid.size_class == 0:
        number = _list_adjacent(cells, candidates, begin, home, image_shift, horizon, axis, step)
    if cells.classes is not None:
        number = list_near_cells(cells, candidates, number, home, grid.size_class, axis, step)
    return _list_followers(cells, candidates, begin, number)


@jit
def assign_cell(state, scene, i, time):
    """Insert particle i in the linked list of its cell at `time`, and centre its region on it.

    Its own neighbour list is emptied; without neighbour lists there are no regions. The time at
    which it leaves the cell is inf until the next prediction.
    """
    cells = state.cells
    position, velocity = position_and_velocity(state, scene, i, time)
    if cells.neighbours is not None:
        position, velocity = _in_frame(cells.neighbours, position, velocity, time)
        write(cells.neighbours.middle, i, 0, position)
        cells.neighbours.number[i] = 0
    image_shift = image_shift_at(hooks.image_shift(scene.effects, state), time)
    position, velocity = fold_into_box(position, velocity, cells.periods, image_shift)
    grid, home = grid_of_radius(cells, radius_of(state.bodies, i)), 0
    for k in range(len(position) - 1, -1, -1):
        column = math.floor(position[k] / grid.widths[k] - grid.origin)
        home = home * grid.counts[k] + wrapped(column, grid.counts[k])
    cells.home[i] = grid.first_cell + home
    _correct_column(state, scene, i, time, grid)
    cells.leave[i] = math.inf
    push_front(cells.first, cells.following, cells.home[i], i)


@jit
def _relative_to_cell(state, scene, i, time, grid, home):
    """Return particle i's position relative to the centre of its cell, and its velocity, at `time`.

    `home` are the indices of the cell along the axes of its grid. Under shear the velocity is
    relative to the row of cells, which slides.
    """
    cells = state.cells
    position, velocity = position_and_velocity(state, scene, i, time)
    image_shift = image_shift_at(hooks.image_shift(scene.effects, state), time)
    position, velocity = _relative_to_row(image_shift, cells, home[1], position, velocity)
    middle = tuple(grid.widths[k] * (home[k] + grid.origin + 0.5) for k in range(len(scene.box)))
    d = subtract(position, middle)
    return shifted(
        d, velocity, image_numbers(d, cells.periods, image_shift), cells.periods, image_shift
    )


@jit
def _relative_to_row(image_shift, cells, row, position, velocity):
    """Return position and velocity relative to a row of cells, which slides under shear.

    `row` is its index along the second axis; `image_shift` holds at the time of the position.
    """
    if image_shift is None:
        return position, velocity
    height = (row + ORIGIN + 0.5) / cells.counts[1] - 0.5
    return (
        (position[0] - height * image_shift[0],) + position[1:],
        (velocity[0] - height * image_shift[1],) + velocity[1:],
    )


@jit
def _exit_from(scene, now, d, u, widths):
    """Return time and heading of a particle in free flight as it leaves its cell or region.

    At the time `now` the particle is at d relative to the centre, with the velocity u; `widths` are
    the sides of the cell or region. The heading is 2 * axis, plus 1 if upwards, as in
    Cells.heading.
    """
    time, up, axis = _first_exit(hooks.acceleration(scene.effects), d, u, widths)
    return now + time, 2 * axis + int(up)


@jit
def _first_exit(gravity, d, u, widths):
    """Return when d + u t + g t^2/2 leaves a box of these `widths`, whether upwards, and the axis.

    The box is centred on the origin; `gravity` g is None, or the acceleration along each axis, None
    where it vanishes.
    """
    last = len(d) - 1
    time, up = _exit_along(
        None if gravity is None else gravity[last], d[last], u[last], widths[last]
    )
    axis = last
    for k in range(last):
        side_time, upwards = _exit_along(
            None if gravity is None else gravity[k], d[k], u[k], widths[k]
        )
        if side_time < time:
            time, up, axis = side_time, upwards, k
    return time, up, axis


@jit
def _exit_along(g, d, u, width):
    """Return when d + u t + g t^2/2 leaves [-`width`/2, `width`/2], and whether at the upper end.

    The acceleration g is None where it vanishes.
    """
    if g is None:
        return _fly_out(d, u, 0.5 * width)
    downwards = g < 0.0  # else mirrored
    sign = 1.0 if downwards else -1.0
    time, up = _fall_out(-sign * g, sign * d, sign * u, 0.5 * width)
    return time, up == downwards


@jit
def _fly_out(d, u, half):
    """Return when d + u t leaves [-half, half], and whether at the upper end."""
    forward = u > 0.0
    gap = max(half - (d if forward else -d), 0.0)
    return (gap / abs(u) if u != 0.0 else math.inf), forward


@jit
def _fall_out(gravity, d, u, half):
    """Return when d + u t - gravity t^2/2 leaves [-half, half], and whether at the upper end."""
    above, below = max(half - d, 0.0), max(half + d, 0.0)
    if u > 0.0 and u * u >= 2.0 * gravity * above:
        return 2.0 * above / (u + math.sqrt(u * u - 2.0 * gravity * above)), True
    root = math.sqrt(u * u + 2.0 * gravity * below)
    if u > 0.0:
        return (u + root) / gravity, False
    return (2.0 * below / (root - u) if below > 0.0 else 0.0), False


@jit
def _change_cell(state, scene, i, time, grid):
    """Move particle i to the adjacent cell of its grid that it enters at `time`.

    Return the axis and the step, -1 or 1.
    """
    cells, heading = state.cells, int(state.cells.heading[i])
    axis, step = heading // 2, 2 * (heading % 2) - 1
    unlink(cells.first, cells.following, cells.home[i], i)
    home, counts = indices_in(grid, cells.home[i]), grid.counts
    cells.home[i] += _index_term(counts, home, axis, step) - _index_term(counts, home, axis, 0)
    if axis == 1:
        _correct_column(state, scene, i, time, grid)
    push_front(cells.first, cells.following, cells.home[i], i)
    return axis, step


@jit
def _correct_column(state, scene, i, time, grid):
    """Correct the column of particle i's cell at `time`, after a change of row, where rows
    slide."""
    if active(scene.effects, "image_shift"):
        cells, home = state.cells, indices_in(grid, state.cells.home[i])
        d, _ = _relative_to_cell(state, scene, i, time, grid, home)
        column = (home[0] + round(d[0] / cells.widths[0])) % cells.counts[0]
        cells.home[i] += column - home[0]


@jit
def _list_surroundings(state, i, begin):
    """Write the particles in i's cell and all adjacent ones to the shortlist; return the end index.

    The shortlist is filled from index `begin` on.
    """
    cells, candidates = state.cells, state.shortlist.found
    home = indices_in(grid_of_cell(cells, cells.home[i]), cells.home[i])
    number = _list_adjacent(cells, candidates, begin, home, None, 0.0, ALL_AXES, 0)
    return _list_followers(cells, candidates, begin, number)


@jit
def _list_adjacent(cells, candidates, begin, home, image_shift, duration, axis, step):
    """Write the first particle of each cell around a cell to the candidates; return the end index.

    The candidates are filled from index `begin` on. The cells are `home` (indices along the axes)
    and all adjacent ones, if `axis` is ALL_AXES, else only the adjacent ones a `step` further along
    the axis. Under shear rows slide by `image_shift`, and candidates hold for `duration` from now.
    """
    if axis != ALL_AXES:
        return _list_slab(cells, candidates, begin, home, axis, step, image_shift, duration)
    number, last = begin, len(home) - 1
    for slab in range(-1, 2):
        number = _list_slab(cells, candidates, number, home, last, slab, image_shift, duration)
    return number


@jit
def _list_followers(cells, candidates, begin, number):
    """Append all followers of the candidates from index `begin` to `number`; return the end.

    The first particle of each cell is followed by the others without data-dependent branches.
    """
    k = begin
    while k < number:
        k, number = _append_followers(cells.following, candidates, number, k, BATCH)
    candidates[assume_nonnegative(number)] = 0  # `predict_contacts` reads to the end of a register
    return number


@jit
def _list_slab(cells, candidates, number, home, axis, step, image_shift, duration):
    """Append the first particle of each cell of a slab to the candidates; return the new end index.

    The slab is a `step` away from the cell `home` along the axis; `number` is the end index before.
    The axis selects values without a branch, which would be mispredicted. Where rows slide past
    each other it is the last axis; their candidates hold for `duration`.
    """
    if image_shift is not None:
        return _list_sliding(cells, candidates, number, home, step, image_shift, duration)
    counts, x, y = (
        cells.counts,
        _index_terms(cells.counts, home, 0),
        _index_terms(cells.counts, home, 1),
    )
    slab_term = (
        _index_term(counts, home, 0, step) if axis == 0 else _index_term(counts, home, 1, step)
    )
    terms_across, terms_up = y if axis == 0 else x, (0,)
    if len(home) == 3:
        slab_term = _index_term(counts, home, 2, step) if axis == 2 else slab_term
        terms_up = y if axis == 2 else _index_terms(cells.counts, home, 2)
    for n in range(len(terms_up)):
        for m in range(len(terms_across)):
            number = append_particle(
                candidates,
                number,
                cells.first[assume_nonnegative(slab_term + terms_across[m] + terms_up[n])],
            )
    return number


@jit
def _index_term(counts, home, axis, step):
    """Return the term of a flat cell index for the cell a `step` from `home` along an axis.

    `counts` are the numbers of cells along the axes, `home` the indices of a cell.
    """
    stride = 1
    for k in range(axis):
        stride *= counts[k]
    return stride * wrapped(home[axis] + step, counts[axis])


@jit
def _index_terms(counts, home, axis):
    """Return the terms of flat cell indices for the steps -1, 0 and 1 along an axis.

    The arguments are as in _index_term.
    """
    return tuple(_index_term(counts, home, axis, step) for step in range(-1, 2))


@jit
def _list_sliding(cells, candidates, number, home, step, image_shift, duration):
    """Append the first particle of each cell that slides past `home` within `duration`.

    Arguments and result are as in _list_slab.
    """
    counts = cells.counts
    level = _index_term(counts, home, 2, step) if len(home) == 3 else 0
    for row_step in range(-1, 2) if len(home) == 3 else range(step, step + 1):
        row = level + _index_term(counts, home, 1, row_step)
        shift_of_row = row_step / (counts[1] * cells.widths[0])
        begin, relative_shift = (
            home[0] - 1 - shift_of_row * image_shift[0],
            shift_of_row * image_shift[1] * duration,
        )
        first = math.floor(begin - max(relative_shift, 0.0))
        # in a row that slides, four columns overlap the three around home
        number_of_columns = (
            math.floor(begin + 3 - min(relative_shift, 0.0)) - first + (row_step != 0)
        )
        first %= counts[0]
        for column in range(first, first + number_of_columns):
            number = append_particle(
                candidates,
                number,
                cells.first[assume_nonnegative(row + wrapped(column, counts[0]))],
            )
    return number


@jit
def _append_followers(following, entries, length, k, batch):
    """Append the followers in their cells of a batch of listed particles, from entry k on.

    Return the next entry to process, and the new length; the batch ends at the present `length`.
    One by one, each entry would wait for the append before it. `batch` is a tuple with as many
    members as particles are processed together; `following` is Cells.following.
    """
    end = length
    followers = tuple(
        following[assume_nonnegative(max(int(entries[assume_nonnegative(k + m)]), 0))]
        for m in range(len(batch))
    )
    for m in range(len(batch)):
        entries[assume_nonnegative(length)] = followers[m]
        length += int((followers[m] != NOBODY) & (k + m < end))
    return min(k + len(batch), end), length


# ------------------------------------------------------------------ lists of neighbours


@jit
def _predict_exit(state, scene, i, time):
    """Store the exit time of particle i, in free flight from `time` on, from its region."""
    cells, neighbours = state.cells, state.cells.neighbours
    position, velocity = position_and_velocity(state, scene, i, time)
    position, velocity = _in_frame(neighbours, position, velocity, time)
    d = subtract(position, read(neighbours.middle, i, 0, position))
    d, velocity = shifted(d, velocity, image_numbers(d, scene.box, None), scene.box, None)
    cells.leave[i] = _exit_from(scene, time, d, velocity, neighbours.sides)[0]


@jit
def _in_frame(neighbours, position, velocity, time):
    """Return position and velocity at `time` relative to the frame that moves with the regions."""
    frame = neighbours.frame
    height = position[-1] - (frame[0] + frame[1] * time)
    return position[:-1] + (height,), velocity[:-1] + (velocity[-1] - frame[1],)


@jit
def _list_members(state, i, begin):
    """Write the neighbours of particle i to the shortlist, from index `begin` on; return the end.

    All particles around its cell are written if its neighbour list is incomplete.
    """
    neighbours, candidates = state.cells.neighbours, state.shortlist.found
    if neighbours.number[i] > LIST_CAPACITY:
        return _list_surroundings(state, i, begin)
    for k in range(LIST_CAPACITY):
        candidates[begin + k] = neighbours.members[i, k]
    return begin + int(neighbours.number[i])


@compiled
def _move_region(state, scene, i, begin, time):
    """Centre the region of particle i on its position at `time`, and update neighbour lists.

    The shortlist from index `begin` on is scratch memory.
    """
    cells = state.cells
    for k in range(begin, _list_members(state, i, begin)):
        _remove_neighbour(cells.neighbours, state.shortlist.found[k], i)
    unlink(cells.first, cells.following, cells.home[i], i)
    assign_cell(state, scene, i, time)
    _list_neighbours(state, scene, i, begin, len(state.changes))


@jit
def _list_neighbours(state, scene, i, begin, end):
    """Enter particle i and each near particle with a number below `end` in each other's list.

    Two particles are near if they can touch while both stay in their regions. The shortlist from
    index `begin` on is scratch memory.
    """
    neighbours, candidates = state.cells.neighbours, state.shortlist.found
    number = _list_surroundings(state, i, begin)
    middle = read(neighbours.middle, i, 0, scene.box)
    distance = MIN_CELL_WIDTH * largest_of(state.bodies)
    lanes = lanes_of(state.shortlist.when)
    for first in range(begin, number, lanes):
        particles = load_scalars(candidates, first, lanes)
        x = subtract(gather_rows(neighbours.middle, particles, scene.box), middle)
        x, _ = shifted(x, x, image_numbers(x, scene.box, None), scene.box, None)
        gap = tuple(larger(abs(x[k]) - neighbours.sides[k], 0.0) for k in range(len(scene.box)))
        near = bits((dot(gap, gap) < distance * distance) & (iota(lanes) < number - first))
        while near != np.uint64(0):
            j = assume_nonnegative(
                int(candidates[assume_nonnegative(first + trailing_zeros(near))])
            )
            if (j != i) & (j < end):
                _add_neighbour(neighbours, i, j)
                _add_neighbour(neighbours, j, i)
            near &= near - np.uint64(1)


@jit
def _add_neighbour(neighbours, i, j):
    """Append particle j to the neighbour list of i; a full list is marked as incomplete instead."""
    count = neighbours.number[i]
    if count < LIST_CAPACITY:
        neighbours.members[i, count] = j
    neighbours.number[i] = min(count + 1, LIST_CAPACITY + 1)


@jit
def _remove_neighbour(neighbours, i, j):
    """Remove particle j from the neighbour list of i.

    An incomplete list stays as it is until i moves its region.
    """
    count, members = neighbours.number[i], neighbours.members
    if count > LIST_CAPACITY:
        return
    for k in range(count):
        if members[i, k] == j:
            members[i, k] = members[i, count - 1]
            neighbours.number[i] = count - 1
            return


@jit
def align_regions_if_due(state, scene, time):
    """Set the velocity of all regions to the particles' mean velocity at `time`, if it is due.

    It is due every ALIGN_EVERY predictions per particle. All particles are then queued anew.
    Without neighbour lists nothing happens.
    """
    if state.cells.neighbours is None:
        return
    counts = state.counts
    if counts[PREDICTIONS] - counts[ALIGNED] > ALIGN_EVERY * len(state.changes):
        _align_regions(state, scene, time)
        for i in range(len(state.changes)):
            queue_next_event(state, i)


@compiled
def _align_regions(state, scene, time):
    """Set the velocity of all regions to the particles' mean along the last axis at `time`.

    The exits of all particles from their regions are predicted anew.
    """
    frame, total = state.cells.neighbours.frame, 0.0
    for i in range(len(state.changes)):
        total += position_and_velocity(state, scene, i, time)[1][-1]
    velocity = total / len(state.changes)
    frame[0] += (frame[1] - velocity) * time  # the regions' present positions do not change
    frame[1] = velocity
    for i in range(len(state.changes)):
        _predict_exit(state, scene, i, time)
    state.counts[ALIGNED] = state.counts[PREDICTIONS]


# ------------------------------------------------------------------ order of particles in memory


@jit
def sort_particles(state, scene, time):
    """Sort the particles in memory by their cells at `time`, and rebuild cells and neighbour lists.

    The calendar's lists are overwritten.
    """
    _assign_all_cells(state, scene, time)
    order, cells = state.queue.later, state.cells
    number = 0
    for cell in range(cells.first.size):
        i = cells.first[cell]
        while i != NOBODY:
            order[number] = i
            number += 1
            i = cells.following[i]
    for i in range(number):
        k = i
        while order[k] != i:  # a cycle of the permutation
            source = order[k]
            _exchange(state, k, source)
            order[k] = k
            k = source
        order[k] = k
    _assign_all_cells(state, scene, time)
    if cells.neighbours is not None:
        _align_regions(state, scene, time)
        for i in range(len(state.changes)):
            _list_neighbours(state, scene, i, 0, i)


@jit
def _assign_all_cells(state, scene, time):
    """Insert all particles in their cells at `time`; regions are centred on them, and rest."""
    cells = state.cells
    if cells.neighbours is not None:
        cells.neighbours.frame[:] = 0.0
    cells.first[:] = NOBODY
    for i in range(len(state.changes) - 1, -1, -1):
        assign_cell(state, scene, i, time)


@jit
def _exchange(state, i, j):
    """Exchange particles i and j in memory: paths, spins, bodies, times, changes and labels."""
    bodies = state.bodies
    _exchange_rows(state.trajectory, i, j)
    if state.spin is not None:
        _exchange_rows(state.spin, i, j)
    if bodies is not None:
        _exchange_entries((bodies.radius, bodies.mass, bodies.inertia, bodies.species), i, j)
    _exchange_entries(state.particle_times, i, j)
    _exchange_entries((state.changes, state.label), i, j)


@jit
def _exchange_rows(array, i, j):
    """Exchange rows i and j of an array (N, columns)."""
    for k in range(array.shape[1]):
        array[i, k], array[j, k] = array[j, k], array[i, k]


@jit
def _exchange_entries(arrays, i, j):
    """Exchange entries i and j of each array (N,) of a tuple; None stands for a missing array."""
    for k in range(len(arrays)):
        if arrays[k] is not None:
            arrays[k][i], arrays[k][j] = arrays[k][j], arrays[k][i]
