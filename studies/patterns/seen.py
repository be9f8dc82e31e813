"""What is seen from above in a layer, in words: from its order, and from how straight it is at the
scale of a wavelength."""

import numpy as np
import xarray as xr

from .published import CYCLES, Panel, order, room, side, wavelength

ENOUGH_WAVES = 4.0
"""Published wavelengths in the side of a box whose pattern has a name."""
STRIPED = 0.6
"""Least coherence of stripes: they have 1, random waves of one wavelength 0.4, cells 0.1."""
STRAIGHT, ORDERED = 0.7, 0.4
"""Least Q_2 of stripes in one direction, and least Q_4 of squares or Q_6 of hexagons."""


def seen(panel: Panel, layer: xr.Dataset) -> str:
    """Return the name of the pattern of a layer, for a panel of the published figure."""
    waves = room(panel, layer)
    if waves < ENOUGH_WAVES:
        return f"{waves:.1f} waves: too few"
    if coherence(layer) >= STRIPED:
        return "straight stripes" if order(layer, 2).value >= STRAIGHT else "domains of stripes"
    names = {order(layer, 4).value: "squares", order(layer, 6).value: "hexagons"}
    return names[max(names)] if max(names) >= ORDERED else "cells without order"


def clearest(layer: xr.Dataset) -> int:
    """Return the phase, of CYCLES cycles, with the largest variation of heights."""
    return int(np.argmax(layer.mean_height.std(("cell_x", "cell_y")).values)) % CYCLES


def coherence(layer: xr.Dataset) -> float:
    """Return how much the slopes of the clearest heights have one axis within a wavelength: 1 for
    stripes, 0 for patterns without a direction.

    It is the difference of the eigenvalues of the tensor of slopes over their sum, each summed over
    squares of a wavelength.
    """
    heights = layer.mean_height[clearest(layer)].values
    squares = max(1, round(side(layer) / wavelength(layer).value))
    sums = []
    for rows in np.array_split(np.stack(np.gradient(heights)), squares, axis=1):
        for slope_x, slope_y in np.array_split(rows, squares, axis=2):
            products = slope_x**2 - slope_y**2, 2.0 * slope_x * slope_y, slope_x**2 + slope_y**2
            sums.append([product.sum() for product in products])
    along, across, total = np.transpose(sums)
    return float(np.hypot(along, across).sum() / total.sum())
