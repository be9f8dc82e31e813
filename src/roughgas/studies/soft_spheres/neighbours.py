"""Which pairs may touch soon: a list (Verlet, Phys. Rev. 159, 98 (1967)) made from cells.

It holds until a particle may have travelled half the skin.
"""

import math

from roughgas.kernel.jit import compiled, jit
from roughgas.kernel.particles import periods
from roughgas.kernel.vectors import read, write
from roughgas.studies.soft_spheres.contacts import part
from roughgas.studies.soft_spheres.gas import BUILDS, DIAMETER, FASTEST, NOBODY, PAIRS, TRAVELLED


@jit
def keep_list(gas, spheres, half):
    """Make the list anew if a pair that overlaps within +-half of now could be missing.

    Returns False if there is no room for it.
    """
    if gas.reach[TRAVELLED] + gas.reach[FASTEST] * half <= 0.5 * spheres.skin:
        return True
    return _list_pairs(gas, spheres)


@jit
def survey(gas):
    """Note how fast the fastest particle is."""
    fastest = 0.0
    for velocity in gas.velocity:
        fastest = max(fastest, squares(velocity))
    gas.reach[FASTEST] = math.sqrt(fastest)


@jit
def squares(array):
    """Return the sum of the squares of all elements, in their order."""
    total = 0.0
    for x in array.flat:
        total += x**2
    return total


@compiled
def _list_pairs(gas, spheres):
    kept = _set_aside(gas, spheres)
    _sort_into_cells(gas, spheres)
    survey(gas)
    gas.reach[TRAVELLED] = 0.0
    gas.counts[BUILDS] += 1
    gas.counts[PAIRS] = 0
    for i in range(len(gas.following)):
        if not _list_of(gas, spheres, i):
            return False
    for p in range(gas.counts[PAIRS]):
        for k in range(kept):
            if gas.pair[p, 0] == gas.old_pair[k, 0] and gas.pair[p, 1] == gas.old_pair[k, 1]:
                gas.touching[p] = True
                write(gas.stretch, p, 0, read(gas.old_stretch, k, 0, spheres.box))
    return True


@jit
def _set_aside(gas, spheres):
    """Copy the contacts under way, which are few, and return their number."""
    kept = 0
    for p in range(gas.counts[PAIRS]):
        if gas.touching[p]:
            write(gas.old_pair, kept, 0, (gas.pair[p, 0], gas.pair[p, 1]))
            write(gas.old_stretch, kept, 0, read(gas.stretch, p, 0, spheres.box))
            kept += 1
    return kept


@jit
def _sort_into_cells(gas, spheres):
    """Put particles back into the box, and onto the list of their cell."""
    gas.first[:] = NOBODY
    for i in range(len(gas.following)):
        cell = 0
        for k in range(len(spheres.box)):
            length, count = spheres.box[k], spheres.cells[k]
            inside = gas.position[i, k] - length * math.floor(gas.position[i, k] / length)
            gas.position[i, k] = inside
            cell = cell * count + min(int(inside / length * count), count - 1)
        gas.home[i] = cell
        gas.following[i] = gas.first[cell]
        gas.first[cell] = i


@jit
def _list_of(gas, spheres, i):
    """Add the neighbours of particle i with greater numbers; return False if the list is full."""
    near = (DIAMETER + spheres.skin) ** 2
    home = gas.home[i]
    for place in range(gas.beside.shape[1]):
        j = gas.first[gas.beside[home, place]]
        while j != NOBODY:
            p = gas.counts[PAIRS]
            if j > i and _separation(gas, spheres, i, j, p) <= near:
                if p + 1 >= len(gas.touching):
                    return False
                write(gas.pair, p, 0, (i, j))
                part(gas, spheres.box, p)
                gas.counts[PAIRS] += 1
            j = gas.following[j]
    return True


@jit
def _separation(gas, spheres, i, j, p):
    """Return the square of the distance of the nearest images; note in gas.image[p] which."""
    square = 0.0
    for k in range(len(spheres.box)):
        x = gas.position[i, k] - gas.position[j, k]
        gas.image[p, k] = periods(x, spheres.box[k]) * spheres.box[k]
        square += (x - gas.image[p, k]) ** 2
    return square
