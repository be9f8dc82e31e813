"""Axes of a dataset over points: r, beta and the seed, preceded by the third axis, if any.

The position of a point is the tuple of its coordinates along these axes; a coordinate on the third
axis may be a word.
"""

from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np

from roughgas.base import Attributes

POINT_ATTRIBUTES = (
    "r",
    "beta",
    "seed",
    "r_label",
    "beta_label",
    "variant",
    "swept_value",
    "command",
)
"""Attributes that identify a point within its experiment."""
Position = tuple[Any, ...]
"""Coordinates of a point along the axes."""


def position_of(attributes: Attributes) -> Position:
    """Return the position of a point, from the global attributes of its dataset."""
    swept = (attributes["swept_value"],) if "swept" in attributes else ()
    r, beta, seed = (attributes[name] for name in ("r", "beta", "seed"))
    return *swept, float(r), float(beta), int(seed)


def axes_of(positions: Iterable[Position]) -> list[list[Any]]:
    """Return the sorted distinct coordinates of points along each axis, words after numbers.

    `positions` are the tuples of coordinates of the points; the result has a list for each axis.
    """
    columns = zip(*positions, strict=True)
    return [
        sorted(set(column), key=lambda value: (isinstance(value, str), value)) for column in columns
    ]


def index_of(position: Position, axes: Sequence[Sequence[Any]]) -> tuple[int, ...]:
    """Return the indices of a point's position along `axes`, the coordinates of `axes_of`."""
    return tuple(axis.index(value) for axis, value in zip(axes, position, strict=True))


def coordinate(values: Sequence[Any]) -> np.ndarray:
    """Return the coordinate array of an axis: numbers, or text if some values are words."""
    if any(isinstance(value, str) for value in values):
        values = [value if isinstance(value, str) else f"{value:.10g}" for value in values]
    return np.array(values)
