"""Two energies as shares of their sum: ratios of them then neither overflow nor lose digits."""

import numpy as np


def shares(first, second, neither) -> tuple[np.ndarray, np.ndarray]:
    """Return `first` and `second` (both >= 0, broadcast) divided by their sum.

    Where both vanish, `neither` is the share of the second.
    """
    total = first + second
    some = total > 0
    divisor = np.where(some, total, 1)
    return (
        np.where(some, first / divisor, 1 - neither),
        np.where(some, second / divisor, neither),
    )


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
