"""Checks of the arguments of theory: each returns them as double precision arrays.

All raise InputError with the name of the argument, the first illegal value and what is legal. NaN
and what is not a number are illegal everywhere.
"""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from roughgas.base.errors import InputError
from roughgas.base.legal import RESTITUTION, ROUGHNESS, Interval

Numbers = float | np.ndarray
"""What functions of theory take: a plain number, or an array."""

NET_SHARES = (-1, 2)
"""Shares of a drive's net power that may go into spin."""


class Material(NamedTuple):
    """Checked properties of the particles: r, beta and q are arrays, D an int."""

    r: np.ndarray
    beta: np.ndarray
    dimension: int
    inertia: np.ndarray


def moment_of_inertia(dimension: int) -> float:
    """Dimensionless moment of inertia q = I/(m a^2) of a uniform disk (1/2) or sphere (2/5)."""
    return {2: 1 / 2, 3: 2 / 5}[check_dimension(dimension)]


def material(
    r: Numbers, beta: Numbers, dimension: int = 2, inertia: Numbers | None = None
) -> Material:
    """Check r, beta, D and q at once; q defaults to that of uniform disks or spheres."""
    dimension = check_dimension(dimension)
    inertia = moment_of_inertia(dimension) if inertia is None else inertia
    return Material(check_restitution(r), check_roughness(beta), dimension, check_inertia(inertia))


def check_restitution(r: Numbers) -> np.ndarray:
    """Normal restitution r, in [0, 1]."""
    return _check_in(RESTITUTION, "restitution r", r)


def check_roughness(beta: Numbers) -> np.ndarray:
    """Tangential restitution beta, in [-1, 1]: smooth at -1, perfectly rough at 1."""
    return _check_in(ROUGHNESS, "roughness beta", beta)


def check_inertia(q: Numbers) -> np.ndarray:
    """Dimensionless moment of inertia q, positive and finite."""
    return _checked("inertia q", q, "be a positive number", lambda x: (x > 0) & (x < np.inf))


def check_dimension(dimension: int) -> int:
    """Number of dimensions D, 2 or 3."""
    if np.ndim(dimension) or dimension not in (2, 3):
        raise InputError("dimension", dimension, "be 2 or 3")
    return int(dimension)


def check_share(spin_share: Numbers) -> np.ndarray:
    """Share s of a drive's power that goes into spin, in [0, 1]."""
    return check_between("spin share of the drive", spin_share, 0, 1)


def check_net_share(spin_share: Numbers) -> np.ndarray:
    """The same of a drive that may take energy out of one motion, in NET_SHARES."""
    return check_between("net spin share of the drive", spin_share, *NET_SHARES)


def check_between(key: str, value: Numbers, low: float, high: float) -> np.ndarray:
    """A number in [low, high]."""
    return _check_in(Interval(f"[{low}, {high}]"), key, value)


def check_not_negative(key: str, value: Numbers) -> np.ndarray:
    """A finite number that is zero or positive."""
    return _checked(key, value, "be a number >= 0", lambda x: (x >= 0) & (x < np.inf))


def check_fraction(key: str, value: Numbers) -> np.ndarray:
    """A number in (0, 1), the ends excluded."""
    return _check_in(Interval("(0, 1)"), key, value)


def _check_in(interval: Interval, key: str, value: Numbers) -> np.ndarray:
    return _checked(key, value, interval.legal, interval.holds)


def _checked(key: str, value, legal: str, accepts: Callable) -> np.ndarray:
    array = np.asarray(value)
    if array.dtype.kind not in "iuf":
        raise InputError(key, value, legal)
    array = array.astype(float)
    illegal = ~accepts(array)
    if illegal.any():
        raise InputError(key, array[illegal].flat[0], legal)
    return array
