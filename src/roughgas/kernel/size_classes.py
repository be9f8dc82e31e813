"""Size classes: a grid of cells for each, where radii differ much.

In a single grid the cells are as wide as the largest diameter, and hold many small particles. Here
each class of radii has a separate grid, a hierarchical grid as of V. Ogarko and S. Luding, Comput.
Phys. Commun. 183, 931 (2012). A cell of a class consists of 2^level cells of the finest grid along
each axis; the level grows with the radius. Each particle has one cell, in the grid of its class.

Two cells are near if particles of their classes may touch while both stay inside: if fewer than
`reach` finest cells are between them along each axis. A prediction lists the particles in all near
cells of every grid. Nearness is symmetric, in whole numbers: both particles of a pair list each
other, and a cell becomes near for both at once.
"""

from typing import NamedTuple

from roughgas.compiling.jit import jit
from roughgas.compiling.lanes import assume_nonnegative
from roughgas.kernel.state import NOBODY

ORIGIN = 0.38196601125  # of the cells, in finest widths: no lattice has many sites on their edges


class Grid(NamedTuple):
    """The cells of a size class, or all cells where there are no classes."""

    counts: tuple[int, ...]  # cells along each axis
    widths: tuple[float, ...]  # of a cell, in a
    origin: float  # of the cells, in their widths
    first_cell: int  # index of the first cell in Cells.first
    size_class: int  # its number


@jit
def grid_of_cell(cells, cell):
    """Return the Grid to which a cell belongs, by its index in Cells.first."""
    if cells.classes is None:
        return Grid(cells.counts, cells.widths, ORIGIN, 0, 0)
    number = 0
    for k in range(1, len(cells.classes.first_cell)):
        number += int(cell >= cells.classes.first_cell[k])
    return _grid(cells, number)


@jit
def grid_of_radius(cells, radius):
    """Return the Grid of particles with this radius, in particle radii a."""
    if cells.classes is None:
        return Grid(cells.counts, cells.widths, ORIGIN, 0, 0)
    number = 0
    for k in range(len(cells.classes.radius) - 1):
        number += int(radius > cells.classes.radius[k])
    return _grid(cells, number)


@jit
def _grid(cells, number):
    """Return the Grid of the size class with this number."""
    classes, level = cells.classes, cells.classes.level[number]
    return Grid(
        tuple(cells.counts[k] >> level for k in range(len(cells.counts))),
        tuple(cells.widths[k] * (1 << level) for k in range(len(cells.counts))),
        classes.origin[number],
        classes.first_cell[number],
        number,
    )


@jit
def indices_in(grid, cell):
    """Return the index of a cell along each axis of its Grid, D integers."""
    number, across = (
        assume_nonnegative(int(cell - grid.first_cell)),
        assume_nonnegative(grid.counts[0]),
    )
    level = assume_nonnegative(across * grid.counts[1])
    if len(grid.counts) == 2:
        return number % across, number // across
    return number % across, number % level // across, number // level


@jit
def list_near_cells(cells, candidates, begin, home, home_class, axis, step):
    """Write the first particle of each cell near a cell to the candidates; return the end index.

    The candidates are filled from index `begin` on; `home` are the indices of the cell along the
    axes of the grid of its class. If a particle has just entered it by a `step` along `axis`, only
    cells that become near are listed; all near cells are listed if `axis` is negative.
    """
    number = begin
    for k in range(int(home_class == 0), len(cells.classes.level)):
        number = _list_class(cells, candidates, number, home, home_class, k, axis, step)
    return number


@jit
def _list_class(cells, candidates, number, home, home_class, other_class, axis, step):
    """Append the first particle of each near cell of another class; return the new end index.

    The arguments are as in `list_near_cells`. There is a single loop: the ends of three nested
    loops would be mispredicted.
    """
    grid, first = _grid(cells, other_class), cells.first
    ranges = tuple(
        _near_range(cells.classes, home_class, other_class, k, home[k], step if k == axis else 0)
        for k in range(len(home))
    )
    listed = 1
    for k in range(len(home)):
        listed *= ranges[k][1] - ranges[k][0]
    across, up, level = ranges[0][0], ranges[1][0], 0
    if len(home) == 3:
        level = ranges[2][0]
    for _ in range(listed):
        cell = grid.first_cell + wrapped(across, grid.counts[0])
        cell += grid.counts[0] * wrapped(up, grid.counts[1])
        if len(home) == 3:
            cell += grid.counts[0] * grid.counts[1] * wrapped(level, grid.counts[2])
        number = append_particle(candidates, number, first[assume_nonnegative(cell)])
        is_last = across + 1 == ranges[0][1]
        across = ranges[0][0] if is_last else across + 1
        up += int(is_last)
        if len(home) == 3:
            is_last = up == ranges[1][1]
            up = ranges[1][0] if is_last else up
            level += int(is_last)
    return number


@jit
def _near_range(classes, home_class, other_class, axis, home, step):
    """Return the indices of the first near cell of another class along an axis, and after the last.

    `home` is the index along the axis of a cell of the class `home_class`. With a `step` the cells
    are left out that were near before the step to this cell.
    """
    level, other_level = classes.level[home_class], classes.level[other_class]
    reach = classes.reach[home_class, other_class, axis]
    begin = ((home << level) - reach) >> other_level
    end = ((((home + 1) << level) - 1 + reach) >> other_level) + 1
    begin_before = (((home - step) << level) - reach) >> other_level
    end_before = ((((home - step + 1) << level) - 1 + reach) >> other_level) + 1
    return (end_before if step > 0 else begin), (begin_before if step < 0 else end)


@jit
def wrapped(k, count):
    """Return cell index k wrapped into [0, count), along an axis of `count` cells.

    k may be out of this range by up to one period.
    """
    return k + count if k < 0 else k - count if k >= count else k


@jit
def append_particle(entries, length, j):
    """Append particle j to the entries, unless it is NOBODY; return the new length."""
    entries[assume_nonnegative(length)] = j
    return length + int(j != NOBODY)
