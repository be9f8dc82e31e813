"""Choice of size classes and of their cells, by an estimate of the time that predictions take.

In a dilute gas in equilibrium the rates of contacts and of changes of cell follow from radii and
masses. At each of them a particle's candidates are listed anew. The constants of the estimate were
fitted to runs of mixtures on an Intel Xeon of 2023 (benchmarks/sizes.py); only their ratios
matter. The choice depends on the particles and the box alone, and is the same on all machines.

V. Ogarko and S. Luding, Comput. Phys. Commun. 183, 931 (2012), likewise choose numbers of levels
and sizes of cells by an estimate, and decide between several grids and one.
"""

import math
from typing import NamedTuple

import numpy as np

from roughgas.kernel.size_classes import ORIGIN
from roughgas.kernel.state import SizeClasses

CONTACT, CROSSING = 150.0, 120.0  # ns for a contact of a particle, and for a change of cell
CELL, CANDIDATE, CLASS = 3.0, 10.0, 20.0  # ns for a near cell, a candidate, and a further class
WORTHWHILE = 0.9  # maximum time with several classes, relative to a single grid
WIDTHS = tuple(2.0 ** (k / 12.0) for k in range(13))  # tried, over the smallest possible width
COARSENESS = (0, 1, 2, 3)  # tried: how often cells of larger particles are halved


class Composition(NamedTuple):
    """Particles in ascending order of their radii."""

    radius: np.ndarray  # (N,) in a
    sums: np.ndarray  # (2, N) of radius and mass, up to each particle, in a and m
    density: float  # in particles per a^D


class Hierarchy(NamedTuple):
    """Size classes of a Composition, and their cells."""

    counts: tuple[int, ...]  # of the finest cells along each axis
    widths: tuple[float, ...]  # of the finest cells, in a
    ends: np.ndarray  # (classes,) index after the last particle of each class
    level: np.ndarray  # (classes,) as in SizeClasses
    reach: np.ndarray  # (classes, classes, D) as in SizeClasses


def composition(bodies, density):
    """Return the Composition of particles with these Bodies, at a density per a^D."""
    order = np.argsort(bodies.radius, kind="stable")
    sums = np.cumsum([bodies.radius[order], bodies.mass[order]], axis=1)
    return Composition(bodies.radius[order], sums, density)


def single_grid(gas, counts, widths):
    """Return a Hierarchy of one class, in which only adjacent cells are near."""
    adjacent = np.ones((1, 1, len(counts)), np.int64)
    return Hierarchy(counts, widths, np.array([len(gas.radius)]), np.zeros(1, np.int64), adjacent)


def fastest(gas, grid_with, margin):
    """Return the Hierarchy of several classes with the least estimated time, None without any.

    `grid_with` returns numbers and widths of cells along each axis, from their minimum width.
    Particles may touch within `margin`/2 times the sum of their radii.
    """
    narrowest = min(grid_with(margin * gas.radius[0])[1])
    hierarchies = [
        _hierarchy(gas, *grid_with(narrowest * width), coarseness, margin)
        for width in WIDTHS
        for coarseness in COARSENESS
    ]
    possible = [hierarchy for hierarchy in hierarchies if hierarchy is not None]
    return min(possible, key=lambda hierarchy: estimated_time(gas, hierarchy), default=None)


def _hierarchy(gas, counts, widths, coarseness, margin):
    """Return the Hierarchy of several classes with finest cells of about these widths, or None.

    The diameters of class k are up to 2^k finest widths; its cells have the level k - `coarseness`,
    or 0. None for a single class, and in a narrow box: cells that are near each other should span
    at most half of it, so that only one image of a particle can be met.
    """
    limits = min(widths) / margin * 2.0 ** np.arange(64)
    ends = np.searchsorted(gas.radius, limits, side="right")
    (classes,) = np.nonzero(np.diff(ends, prepend=0))
    level, ends = np.maximum(classes - coarseness, 0), ends[classes]
    size = 1 << int(level[-1])
    whole = tuple(count // size * size for count in counts)
    if len(classes) == 1 or classes[0] > 0 or 0 in whole:
        return None
    widths = tuple(n * width / m for n, width, m in zip(counts, widths, whole, strict=True))
    largest = gas.radius[ends - 1]
    distance = 0.5 * margin * (largest[:, None] + largest)
    reach = np.ceil(distance[:, :, None] / np.array(widths)).astype(np.int64)
    if (2 * (2 * size + reach[-1, -1]) > np.array(whole)).any():
        return None
    return Hierarchy(whole, widths, ends, level, reach)


def estimated_time(gas, hierarchy):
    """Return the estimated time that predictions take, in ns per contact of a particle."""
    dimension, cell_size = len(hierarchy.counts), 2.0**hierarchy.level
    numbers = np.diff(hierarchy.ends, prepend=0)
    radius, mass = np.diff(gas.sums[:, hierarchy.ends - 1], prepend=0.0) / numbers
    density = gas.density * numbers / len(gas.radius)
    speed = np.sqrt(1.0 / mass[:, None] + 1.0 / mass)
    cross_section = (radius[:, None] + radius) ** (dimension - 1)
    contacts = (dimension - 1) * math.sqrt(2.0 * math.pi) * (cross_section * speed) @ density
    width = math.prod(hierarchy.widths) ** (1.0 / dimension) * cell_size
    crossings = dimension * np.sqrt(2.0 / (math.pi * mass)) / width
    spans = (cell_size[:, None, None] - 1.0 + 2.0 * hierarchy.reach) / cell_size[:, None] + 1.0
    near = spans.prod(axis=2)
    entered = (near[:, :, None] / spans).mean(axis=2) * cell_size[:, None] / cell_size
    per_cell = CELL + CANDIDATE * density * width**dimension
    further = CLASS * (len(numbers) - 1)
    time = contacts * (CONTACT + further + near @ per_cell)
    time += crossings * (CROSSING + further + entered @ per_cell)
    return (density @ time) / (density @ contacts)


def is_worthwhile(gas, hierarchy, single):
    """Return whether a Hierarchy of several classes clearly saves time beside a single grid."""
    return estimated_time(gas, hierarchy) < WORTHWHILE * estimated_time(gas, single)


def size_classes(gas, hierarchy):
    """Return the SizeClasses of a Hierarchy, and the number of cells of all grids."""
    level, counts = hierarchy.level, hierarchy.counts
    numbers = [math.prod(n >> k for n in counts) for k in level.tolist()]
    first_cell = np.cumsum([0, *numbers])
    largest, origin = gas.radius[hierarchy.ends - 1], ORIGIN / 2.0**level
    classes = SizeClasses(largest, level, origin, first_cell[:-1], hierarchy.reach)
    return classes, int(first_cell[-1])
