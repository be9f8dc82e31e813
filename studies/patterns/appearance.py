"""What is seen from above in a layer, in words: from its order, and from the distribution of its
heights."""

import numpy as np
import xarray as xr

from .published import CYCLES, Panel, order, room

ENOUGH_WAVES = 4.0
"""Published wavelengths in the side of a box whose pattern has a name."""
STRAIGHT, ORDERED = 0.7, 0.4
"""Least Q_2 of stripes in one direction, and least Q_4 of squares or Q_6 of hexagons."""
SKEWED, STRIPED = 0.4, 2.25
"""Half of the skewness of hexagons of sines, and the mean of the kurtoses of stripes that are a
sine, 1.5, and of random waves, 3."""


def appearance(panel: Panel, layer: xr.Dataset) -> str:
    """Return the name of what a picture shows, for a panel of the published figure."""
    waves = room(panel, layer)
    if waves < ENOUGH_WAVES:
        return f"{waves:.1f} waves: too few"
    if order(layer, 2).value >= STRAIGHT:
        return "straight stripes"
    names = {order(layer, 4).value: "squares", order(layer, 6).value: "hexagons"}
    if max(names) >= ORDERED:
        return names[max(names)]
    deviations = pictured(panel, layer) - np.mean(pictured(panel, layer))
    skewness, kurtosis = (np.mean(deviations**n) / np.std(deviations) ** n for n in (3, 4))
    if abs(skewness) > SKEWED:
        return "separate hills" if skewness > 0.0 else "separate hollows"
    return "bent stripes" if kurtosis < STRIPED else "no order"


def pictured(panel: Panel, layer: xr.Dataset) -> np.ndarray:
    """Return the mean heights, (x, y), at the clearest phase, for panel d one cycle later."""
    phase = (clearest(layer) + (panel.panel == "d")) % CYCLES
    return layer.mean_height[phase].values


def clearest(layer: xr.Dataset) -> int:
    """Return the phase, of CYCLES cycles, with the largest variation of heights."""
    return int(np.argmax(layer.mean_height.std(("cell_x", "cell_y")).values))
