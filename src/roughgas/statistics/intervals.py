"""Error bars with a stated confidence: errors from several runs pooled, and Student's t.

A standard error from a few numbers is itself uncertain, by 1/sqrt(2 dof) of itself. How many
degrees of freedom stand behind it is therefore kept beside it, and decides how wide the interval
is that holds the truth with a given probability.
"""

import math
from statistics import NormalDist
from typing import NamedTuple

import numpy as np

from roughgas.statistics.errors import student_t

DISAGREE = 2.0  # sigma
SHORTEST = 10.0  # autocorrelation times, in a series whose interval at 95 % holds the truth in 95 %


class Error(NamedTuple):
    """A standard error, and the degrees of freedom it is known with."""

    stderr: float
    dof: float

    def half_width(self, level: float) -> float:
        """Half of the interval that holds the truth with probability `level`, in (0, 1)."""
        return half_width(self.stderr, self.dof, level)


def half_width(stderr: float, dof: float, level: float) -> float:
    """Half width of the interval at confidence `level` about a mean with this standard error.

    NaN where nothing is known of the error (dof below 1, as for a single number).
    """
    if not dof >= 1:
        return math.nan
    return student_t(NormalDist().inv_cdf((1 + level) / 2), dof) * stderr


def is_trusted(samples: int, autocorrelation_time: float) -> bool:
    """Whether a correlated series is long enough for its interval, by blocking, to be as wide as it
    should be; `autocorrelation_time` in samples, NaN for a constant series, whose mean is exact."""
    return not samples < SHORTEST * autocorrelation_time


def degrees_of_freedom(blocks: float) -> float:
    """Of a standard error by `errors.blocking`, from how many blocks it says there are.

    Blocks that overlap are worth 1.5 times as many degrees of freedom as disjoint ones (Meketon &
    Schmeiser 1984) if their length is given. That it is chosen from the same series costs as much:
    on AR(1) series of 20 to 1000 autocorrelation times the scatter of the squared error is that of
    0.6 to 1.3 times as many as there are disjoint blocks, less one.
    """
    return max(0.0, blocks - 1.0)


def pooled(means: np.ndarray, within: np.ndarray, dof: np.ndarray) -> Error:
    """Standard error of the mean of runs, from their scatter and from what each says of itself.

    `means`, `within` (each run's own standard error) and `dof` (its degrees of freedom) have shape
    (runs,). Both sources estimate the variance of one run; they are averaged with their degrees of
    freedom as weights, as in an analysis of variance. Where the scatter is larger than the runs'
    own errors explain, by 2 sigma, these miss something (motion slower than a run), and the scatter
    counts alone. A run's own error of which nothing is known has dof 0 (or NaN) and no weight.
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


def sum_error(stderr: np.ndarray, dof: np.ndarray) -> Error:
    """Return the error of sums of independent numbers along the first axis.

    The degrees of freedom are those of Welch, Biometrika 34, 28 (1947), and Satterthwaite.
    """
    square = np.square(np.asarray(stderr, float))
    total = square.sum(0)
    with np.errstate(divide="ignore", invalid="ignore"):
        effective = total**2 / (square**2 / np.asarray(dof, float)).sum(0)
    return Error(np.sqrt(total), np.where(total > 0, effective, math.inf))


def excess_sigmas(first: float, first_dof: float, second: float, second_dof: float) -> float:
    """How many sigma one estimate of a variance exceeds another.

    Their quotient follows an F distribution: normal approximation of Paulson, Ann. Math. Stat. 13,
    233 (1942). -inf where the first is no estimate, inf where the second is zero and the first not.
    """
    if first_dof <= 0 or first == 0:
        return -math.inf
    if second == 0:
        return math.inf
    root = (first / second) ** (1 / 3)
    one, two = 2 / (9 * first_dof), 2 / (9 * second_dof)
    return ((1 - two) * root - (1 - one)) / math.sqrt(two * root**2 + one)
