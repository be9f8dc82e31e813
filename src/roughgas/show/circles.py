"""Many circles that move, drawn as one collection."""

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import EllipseCollection


def add_circles(axes: Axes, **look: Any) -> EllipseCollection:
    """Add a collection of circles, none as yet, whose sizes are in the units of the axes."""
    circles = EllipseCollection([], [], [], units="xy", offsets=[], transOffset=axes.transData)
    circles.set(**look)
    axes.add_collection(circles)
    return circles


def move(circles: EllipseCollection, x: np.ndarray, y: np.ndarray, diameter: Any = 2.0) -> None:
    """Bring circles to these centres (N,), with one diameter or (N,) of them."""
    size = np.full(len(x), 1.0) * diameter
    circles.set(widths=size, heights=size, angles=0.0 * size)
    circles.set_offsets(np.column_stack([x, y]))
