"""Error bars with a stated confidence: errors from several runs pooled, and Student's t.

A standard error from a few numbers is itself uncertain, by a fraction 1/sqrt(2 dof). Its degrees of
freedom are therefore kept beside it, and decide how wide the interval is that holds the truth with
a given probability.
"""

import math
from statistics import NormalDist
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from roughgas.statistics.errors import student_t

DISAGREE = 2.0  # sigma
SHORTEST = 10.0  # autocorrelation times, in a series whose interval at 95 % holds the truth in 95 %


class Error(NamedTuple):
    """A standard error, and the degrees of freedom that it is known with."""

    stderr: Any  # a float, or an array of them; so are the degrees of freedom
    dof: Any

    def half_width(self, level: float) -> float:
        """Return half the width of the interval that holds the truth at `level` in (0, 1)."""
        return half_width(self.stderr, self.dof, level)


def half_width(stderr: float, dof: float, level: float) -> float:
    """Return half the width of the interval at confidence `level` for this standard error.

    NaN if the error is unknown (dof below 1, as for a single number).
    """
    if not dof >= 1:
        return math.nan
    return student_t(NormalDist().inv_cdf((1 + level) / 2), dof) * stderr


def is_trusted(samples: int, autocorrelation_time: float) -> bool:
    """Return whether a correlated series is long enough for its interval to be wide enough.

    The interval is by blocking, `autocorrelation_time` in samples; where that is NaN, it is not.
    """
    return samples >= SHORTEST * autocorrelation_time


def degrees_of_freedom(blocks: float) -> float:
    """Return the degrees of freedom of a standard error by `errors.blocking` with `blocks` blocks.

    Overlapping blocks of a given length are worth 1.5 times as many degrees of freedom as disjoint
    ones (Meketon & Schmeiser 1984). Choosing the length from the same series costs as much again:
    on AR(1) series of 20 to 1000 autocorrelation times the squared error scatters as with 0.6 to
    1.3 times the number of disjoint blocks, less one.
    """
    return max(0.0, blocks - 1.0)


def pooled(means: np.ndarray, within: np.ndarray, dof: np.ndarray) -> Error:
    """Return the standard error of the mean of runs, from their scatter and from their own errors.

    `means`, `within` (each run's own standard error) and `dof` (its degrees of freedom) have shape
    (runs,). Both sources estimate the variance of one run; they are averaged with their degrees of
    freedom as weights, as in an analysis of variance. Where the scatter exceeds what the runs' own
    errors explain by 2 sigma, these miss something (motion slower than a run), and only the scatter
    counts. An unknown error of a run has dof 0 (or NaN) and no weight.
    """
    means, within = np.asarray(means, float), np.asarray(within, float)
    weights = np.where(np.isfinite(within), np.nan_to_num(dof), 0.0)
    runs = len(means)
    if runs == 1:
        return Error(float(within[0]), float(weights[0]))
    between = float(means.var(ddof=1))
    own = float(weights @ np.nan_to_num(within) ** 2) / max(float(weights.sum()), 1e-300)
    scatter_dof, own_dof = runs - 1.0, float(weights.sum())
    if own_dof == 0 or excess_sigmas(between, scatter_dof, own, own_dof) > DISAGREE:
        return Error(math.sqrt(between / runs), scatter_dof)
    total = scatter_dof + own_dof
    variance = (scatter_dof * between + own_dof * own) / total
    return Error(math.sqrt(variance / runs), total)


def sum_error(stderr: ArrayLike, dof: ArrayLike) -> Error:
    """Return the error of sums of independent numbers along the first axis.

    The degrees of freedom are those of Welch, Biometrika 34, 28 (1947), and Satterthwaite.
    """
    square = np.square(np.asarray(stderr, float))
    total = square.sum(0)
    with np.errstate(divide="ignore", invalid="ignore"):
        effective = total**2 / (square**2 / np.asarray(dof, float)).sum(0)
    return Error(np.sqrt(total), np.where(total > 0, effective, math.inf))


def excess_sigmas(first: float, first_dof: float, second: float, second_dof: float) -> float:
    """Return by how many sigma one estimate of a variance exceeds another.

    Their quotient follows an F distribution: normal approximation of Paulson, Ann. Math. Stat. 13,
    233 (1942). -inf if the first is no estimate or zero, inf if only the second is zero.
    """
    if first_dof <= 0 or first == 0:
        return -math.inf
    if second == 0:
        return math.inf
    root = (first / second) ** (1 / 3)
    one, two = 2 / (9 * first_dof), 2 / (9 * second_dof)
    return ((1 - two) * root - (1 - one)) / math.sqrt(two * root**2 + one)
