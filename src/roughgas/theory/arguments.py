"""Checks of the arguments of theory, and ratios of energies that neither overflow nor lose digits.

Each check returns its argument as a double precision array, and raises InputError with the name of
the argument, the first illegal value and the legal range. NaN and values of other types than
numbers are illegal everywhere. Two energies are kept as shares of their sum.

Symbols: normal restitution r, roughness (tangential restitution) beta, number of dimensions D,
moment of inertia q = I/(m a^2) of particles of mass m and radius a.
"""

from typing import NamedTuple

import numpy as np

from roughgas.base import RESTITUTION, ROUGHNESS, InputError, Interval

POSITIVE, NOT_NEGATIVE = Interval("(0, inf)"), Interval("[0, inf)")
SHARE = Interval("[0, 1]")
"""Share s of the power of a drive that goes into spin."""
NET_SHARE = Interval("[-1, 2]")
"""Share s of the net power that goes into spin, of a drive that may also extract energy."""
CORRELATION = Interval("[-1, 1]")
FRICTION = Interval("[0, inf]")
"""Friction coefficient mu; infinite where contacts never slide."""
LEGAL_IN_WORDS = {POSITIVE: "be a positive number", NOT_NEGATIVE: "be a number >= 0"}
INTERVALS = {
    "restitution r": RESTITUTION,
    "roughness beta": ROUGHNESS,
    "inertia q": POSITIVE,
    "friction mu": FRICTION,
    "correlation at contacts": CORRELATION,
    "spin share of the drive": SHARE,
    "net spin share of the drive": NET_SHARE,
}
"""Legal intervals by the names of arguments in messages; NOT_NEGATIVE for other names."""


class Material(NamedTuple):
    """Checked properties of the particles: restitution r and roughness beta, D (an int), inertia q.

    r, beta and q are arrays, which broadcast against each other.
    """

    r: np.ndarray
    beta: np.ndarray
    dimension: int
    inertia: np.ndarray

    @property
    def eta(self) -> np.ndarray:
        """Tangential velocity change over the slip velocity, eta = q (1 + beta)/[2 (1 + q)]."""
        return self.inertia * (1 + self.beta) / (2 * (1 + self.inertia))


def moment_of_inertia(dimension: int) -> float:
    """Return the moment of inertia q = I/(m a^2) of a uniform disk (1/2) or sphere (2/5).

    Raises InputError unless `dimension` is 2 or 3.
    """
    return {2: 1 / 2, 3: 2 / 5}[check_dimension(dimension)]


def material(r, beta, dimension=2, inertia=None) -> Material:
    """Return the restitution r, the roughness beta, D and the moment of inertia q, checked.

    q = I/(m a^2) has by default the value of uniform disks or spheres. Raises InputError for an
    illegal argument.
    """
    dimension = check_dimension(dimension)
    inertia = moment_of_inertia(dimension) if inertia is None else inertia
    r, beta = check("restitution r", r), check("roughness beta", beta)
    return Material(r, beta, dimension, check("inertia q", inertia))


def check_dimension(dimension: int) -> int:
    """Return the number of dimensions D; raise InputError unless it is 2 or 3."""
    if np.ndim(dimension) or dimension not in (2, 3):
        raise InputError("dimension", dimension, "be 2 or 3")
    return int(dimension)


def check(key: str, value: float | np.ndarray, interval: Interval | None = None) -> np.ndarray:
    """Return `value`, a number or numbers, as an array of floats; `key` names it in error messages.

    Raises InputError unless all numbers lie in `interval`, by default the interval of `key` in
    INTERVALS.
    """
    interval = interval or INTERVALS.get(key, NOT_NEGATIVE)
    array, legal = np.asarray(value), LEGAL_IN_WORDS.get(interval, interval.legal)
    if array.dtype.kind not in "iuf":
        raise InputError(key, value, legal)
    array = array.astype(float)
    illegal = ~interval.holds(array)
    if illegal.any():
        raise InputError(key, array[illegal].flat[0], legal)
    return array


def shares(first, second, second_if_both_zero) -> tuple[np.ndarray, np.ndarray]:
    """Return `first` and `second` divided by their sum, two arrays in the broadcast shape.

    Both are >= 0. Where both vanish, the share of the second is `second_if_both_zero`.
    """
    total = first + second
    positive = total > 0
    divisor = np.where(positive, total, 1)
    return (
        np.where(positive, first / divisor, 1 - second_if_both_zero),
        np.where(positive, second / divisor, second_if_both_zero),
    )


def positive_root(square, linear, constant) -> tuple[np.ndarray, np.ndarray]:
    """Return the root x = n/d > 0 of `square` x^2 - `linear` x - `constant` = 0 as the pair (n, d).

    `square` and `constant` are >= 0 and `linear` has any sign; all are arrays that broadcast. Of
    the two forms of the root the one that adds numbers of equal sign is taken, so that nothing
    cancels. (0, 0) where all vanish.
    """
    sum_of_sizes = np.abs(linear) + np.sqrt(linear**2 + 4 * square * constant)
    numerator = np.where(linear > 0, sum_of_sizes, 2 * constant)
    denominator = np.where(linear > 0, 2 * square, sum_of_sizes)
    return numerator, denominator


def quotient(numerator, denominator) -> np.ndarray:
    """Return `numerator`/`denominator` of numbers >= 0, in the broadcast shape.

    Infinite where only the denominator vanishes, 0 for 0/0.
    """
    numerator, denominator = np.broadcast_arrays(numerator, denominator)
    zero = np.zeros(numerator.shape)
    with np.errstate(divide="ignore", over="ignore"):
        return np.divide(numerator, denominator, out=zero, where=numerator > 0)[()]
