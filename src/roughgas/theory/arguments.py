"""Checks of the arguments of theory: each returns them as double precision arrays.

All raise InputError with the name of the argument, the first illegal value, and what is legal. NaN
and what is not a number are illegal everywhere.

Two energies as shares of their sum: ratios of them then neither overflow nor lose digits.
"""

from typing import NamedTuple

import numpy as np

from roughgas.base import RESTITUTION, ROUGHNESS, InputError, Interval

POSITIVE, NOT_NEGATIVE = Interval("(0, inf)"), Interval("[0, inf)")
SHARE = Interval("[0, 1]")
"""Share s of a drive's power that goes into spin."""
NET_SHARE = Interval("[-1, 2]")
"""The same for a drive that may take energy out of one motion."""
CORRELATION = Interval("[-1, 1]")
FRICTION = Interval("[0, inf]")
"""Friction coefficient mu; infinite where contacts never slide."""
IN_WORDS = {POSITIVE: "be a positive number", NOT_NEGATIVE: "be a number >= 0"}
LEGAL = {
    "restitution r": RESTITUTION,
    "roughness beta": ROUGHNESS,
    "inertia q": POSITIVE,
    "friction mu": FRICTION,
    "correlation at contacts": CORRELATION,
    "spin share of the drive": SHARE,
    "net spin share of the drive": NET_SHARE,
}
"""What is legal by the name in messages; NOT_NEGATIVE for any other."""


class Material(NamedTuple):
    """Checked properties of the particles: r, beta and q are arrays, D an int."""

    r: np.ndarray
    beta: np.ndarray
    dimension: int
    inertia: np.ndarray

    @property
    def eta(self) -> np.ndarray:
        """q (1 + beta)/[2 (1 + q)]."""
        return self.inertia * (1 + self.beta) / (2 * (1 + self.inertia))


def moment_of_inertia(dimension: int) -> float:
    """Return the moment of inertia q = I/(m a^2) of a uniform disk (1/2) or sphere (2/5)."""
    return {2: 1 / 2, 3: 2 / 5}[check_dimension(dimension)]


def material(r, beta, dimension=2, inertia=None) -> Material:
    """Check r, beta, D and q at once; q defaults to that of uniform disks or spheres."""
    dimension = check_dimension(dimension)
    inertia = moment_of_inertia(dimension) if inertia is None else inertia
    r, beta = check("restitution r", r), check("roughness beta", beta)
    return Material(r, beta, dimension, check("inertia q", inertia))


def check_dimension(dimension: int) -> int:
    """Check the number of dimensions D, 2 or 3."""
    if np.ndim(dimension) or dimension not in (2, 3):
        raise InputError("dimension", dimension, "be 2 or 3")
    return int(dimension)


def check(key: str, value: float | np.ndarray, interval: Interval | None = None) -> np.ndarray:
    """Check numbers that `key` names: whether they lie in `interval`, by default in LEGAL's."""
    interval = interval or LEGAL.get(key, NOT_NEGATIVE)
    array, legal = np.asarray(value), IN_WORDS.get(interval, interval.legal)
    if array.dtype.kind not in "iuf":
        raise InputError(key, value, legal)
    array = array.astype(float)
    illegal = ~interval.holds(array)
    if illegal.any():
        raise InputError(key, array[illegal].flat[0], legal)
    return array


def shares(first, second, neither) -> tuple[np.ndarray, np.ndarray]:
    """Return `first` and `second` (both >= 0, broadcast) divided by their sum.

    Where both vanish, `neither` is the share of the second.
    """
    total = first + second
    some = total > 0
    divisor = np.where(some, total, 1)
    return (np.where(some, first / divisor, 1 - neither), np.where(some, second / divisor, neither))


def positive_root(square, linear, constant) -> tuple[np.ndarray, np.ndarray]:
    """Return the root x = n/d > 0 of `square` x^2 - `linear` x - `constant` = 0 as the pair (n, d).

    `square` and `constant` are >= 0 and `linear` has any sign. Of the two forms of the root the one
    that adds numbers of equal sign is taken, so that nothing cancels. (0, 0) where all vanish.
    """
    sum_of_sizes = np.abs(linear) + np.sqrt(linear**2 + 4 * square * constant)
    numerator = np.where(linear > 0, sum_of_sizes, 2 * constant)
    denominator = np.where(linear > 0, 2 * square, sum_of_sizes)
    return numerator, denominator


def quotient(numerator, denominator) -> np.ndarray:
    """Return `numerator`/`denominator` of numbers >= 0: inf over a vanishing one, 0 for 0/0."""
    numerator, denominator = np.broadcast_arrays(numerator, denominator)
    zero = np.zeros(numerator.shape)
    with np.errstate(divide="ignore", over="ignore"):
        return np.divide(numerator, denominator, out=zero, where=numerator > 0)[()]
