"""What `roughgas theory` is asked for, and what it finds."""

from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple


class Quantity(NamedTuple):
    """An array over the points, what it is, and which equation it is from."""

    values: Any
    meaning: str
    source: str


class GasParameters(NamedTuple):
    """Points (r, beta), arrays of equal shape, and what they share; no friction: `mu` is None.

    The species of a mixture are as in config.yaml; its `inertia` is that of species without one.
    """

    r: Any
    beta: Any
    dimension: int
    inertia: float
    spin_share: float
    mu: float | None
    species: Sequence[Mapping[str, Any]] | None = None
    packing: float = 0.0  # matters for mixtures alone
