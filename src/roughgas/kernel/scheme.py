"""Choice of the scheme that finds candidates for contacts: a sweep over all, cells, or lists.

The cost of a sweep grows with the number of particles, the cost of cells does not, but in a dilute
gas particles cross many cells between contacts. Kicks of an effect undo this advantage of a sweep:
each predicts the contacts of its particles anew. The break-even numbers are measured by
`python -m benchmarks.schemes`. They are the same on all machines, so that results are, too.
"""

import math
from typing import NamedTuple

import numpy as np

from roughgas.kernel import hooks

SCHEMES = ("cheapest", "sweep", "cells", "lists")  # legal values of the setting `neighbours`
CHEAPEST, SWEEP, CELLS, LISTS = range(4)  # their indices: values of Scene.scheme
MIN_CELLS = 8  # along an axis: with fewer, particles would be met twice
LAYER_COMPRESSION = 4.0  # density where most contacts in a layer occur, over the initial density
PACKINGS = (0.001, 0.01, 0.05, 0.2, 0.5)
BREAK_EVEN = {  # dimension -> N up to which a sweep costs less, at each of PACKINGS
    2: (2500, 1600, 1050, 500, 270),
    3: (2600, 1400, 800, 500, 320),
}
BREAK_EVEN_OF_KICKS = (600, 320, 230, 230, 230)  # with 5 to 30 kicks per contact of a particle
BED_PACKING = 0.2  # for this choice, of a gas with an open top: dense below, dilute above
SIZE_EXPONENT = 0.12  # of the ratio of radii in the break-even number
LISTS_FROM = {2: 0.75, 3: 0.45}  # dimension -> packing from which on lists cost less than cells
# Particles in a cell, where cells are wide enough: a minimum, from the packing DENSE on, and a
# maximum in dilute gases, where cells of more particles are crossed less often.
PER_CELL = {2: (0.6, 3.0), 3: (0.4, 1.0)}
DENSE, GROWTH = 0.05, 0.75  # the number grows as this power of DENSE over the packing


class Grid(NamedTuple):
    """Numbers and widths (in a) of cells along each axis."""

    counts: tuple[int, ...]
    widths: tuple[float, ...]


class Filling(NamedTuple):
    """Particles that fill a box."""

    spans: tuple[float, ...]  # between the outermost centres along each axis, in a
    number: int  # of particles
    packed_volume: float  # of all particles, in a^D
    size_ratio: float  # of the largest radius to the smallest


class Density(NamedTuple):
    """Density of a gas where most of its contacts occur."""

    lengths: tuple[float, ...]  # of the gas along each axis, in a
    number: float  # of particles in a^D
    packing: float  # fraction of the volume that the particles fill


def filling(position, radii):
    """Return the Filling by particles at `position` (N, D) with `radii` (N,), both in a."""
    dimension = position.shape[1]
    unit_sphere = math.pi if dimension == 2 else 4.0 * math.pi / 3.0
    packed_volume = unit_sphere * float(np.sum(radii**dimension))
    spans = tuple(np.ptp(position, axis=0).tolist())
    return Filling(spans, len(radii), packed_volume, float(radii.max() / radii.min()))


def density_of(scene, gas, margin):
    """Return the Density of a Filling; along an axis without a period it has `margin` (a) more."""
    axes = zip(scene.box, gas.spans, strict=True)
    lengths = tuple(period or span + margin for period, span in axes)
    compression = LAYER_COMPRESSION if scene.box[-1] is None else 1.0
    volume = math.prod(lengths) / compression
    return Density(lengths, gas.number / volume, gas.packed_volume / volume)


def chosen_scheme(scene, gas, packing):
    """Return SWEEP, CELLS or LISTS: the choice of the user, or the scheme that costs least.

    `gas` is a Filling, `packing` is as in Density.
    """
    if scene.scheme != CHEAPEST:
        return scene.scheme
    dimension, is_bed = len(scene.box), scene.box[-1] is None
    few = break_even(dimension, BED_PACKING if is_bed else packing, has_kicks(scene.effects))
    if gas.number <= few * gas.size_ratio**SIZE_EXPONENT:
        return SWEEP
    may_have_lists = scene.effects.shear is None and gas.size_ratio == 1.0 and not is_bed
    return LISTS if may_have_lists and packing >= LISTS_FROM[dimension] else CELLS


def has_kicks(effects):
    """Return whether an effect changes velocities at times of its own, particle by particle."""
    kept_times, events = (
        {hook.effect_index for hook in hooks.active(effects, name)}
        for name in ("particle_times", "predict")
    )
    return bool(kept_times & events)


def break_even(dimension, packing, kicked=False):
    """Return the number of particles up to which a sweep costs less than cells.

    `kicked` is as returned by `has_kicks`. Between PACKINGS the number is interpolated, on
    logarithmic scales.
    """
    numbers = BREAK_EVEN_OF_KICKS if kicked else BREAK_EVEN[dimension]
    logarithm = np.interp(math.log(packing), np.log(PACKINGS), np.log(numbers))
    return round(math.exp(logarithm))


def particles_per_cell(dimension, packing):
    """Return the number of particles in a cell, where cells are wide enough."""
    fewest, most = PER_CELL[dimension]
    return min(most, fewest * max(1.0, (DENSE / packing) ** GROWTH))


def cell_grid(scene, gas, narrowest, diameter=0.0):
    """Return the Grid of cells for a Filling, with `particles_per_cell` or more.

    No cell is narrower than `narrowest` (a). A cell holds fewer particles where the box else had no
    room for MIN_CELLS. Along an open axis the cells fill the initial height of the gas, and at
    least MIN_CELLS cells, or particles of this `diameter`.
    """
    dimension, density = len(scene.box), density_of(scene, gas, narrowest)
    volume = particles_per_cell(dimension, density.packing) / density.number
    width = max(narrowest, volume ** (1.0 / dimension))
    lengths = [
        max(length, MIN_CELLS * max(width, diameter)) if period is None else length
        for period, length in zip(scene.box, density.lengths, strict=True)
    ]
    widths = [max(narrowest, min(width, length / MIN_CELLS)) for length in lengths]
    counts = tuple(
        max(1, math.floor(length / width)) for length, width in zip(lengths, widths, strict=True)
    )
    return Grid(counts, tuple(float(length / n) for length, n in zip(lengths, counts, strict=True)))
