"""What many estimates of R tell: the errors observed, the law they follow, and what it costs."""

import math
from typing import NamedTuple

import numpy as np


class Line(NamedTuple):
    """The slope of log error against log time, and its standard error."""

    slope: float
    stderr: float


class Levels(NamedTuple):
    """Root mean square errors, each with its standard error; shape (levels,).

    `groups` is how many estimates are behind each, `seconds` what one of them costs on average.
    """

    error: np.ndarray
    stderr: np.ndarray
    seconds: np.ndarray
    groups: np.ndarray


def observed(R: np.ndarray, seconds: np.ndarray, truth: float) -> Levels:
    """Errors of the estimates `R`, shape (levels, groups) with NaN where a level has fewer.

    That of K normal estimates has the standard error (2 K)^(-1/2) of itself.
    """
    groups = np.isfinite(R).sum(axis=1)
    error = np.sqrt(np.nanmean((R - truth) ** 2, axis=1))
    return Levels(error, error / np.sqrt(2 * groups), np.nanmean(seconds, axis=1), groups)


def slope(levels: Levels) -> Line:
    """Weighted least squares through log error against log seconds.

    The logarithm of a root mean square of K normal errors has the variance 1/(2 K), and is too
    small by 1/(2 K) on average.
    """
    weight = 2.0 * levels.groups
    x, y = np.log(levels.seconds), np.log(levels.error) + 1 / weight
    x = x - np.average(x, weights=weight)
    return Line(float((weight * x * y).sum() / (weight * x**2).sum()), (weight @ x**2) ** -0.5)


def noise(levels: Levels, length: np.ndarray) -> tuple[float, float]:
    """Variance of R's mean times the length of the run: mean over levels, and standard error.

    It is the variance of R times its integrated autocorrelation time, less the share tau/(2 length)
    that a short run of exponentially correlated samples misses.
    """
    mean = float(np.average(levels.error**2 * length, weights=levels.groups))
    return mean, mean * math.sqrt(2 / levels.groups.sum())


def time_from_blocks(series: np.ndarray, length: int) -> float:
    """Integrated autocorrelation time in samples, from the scatter of means over `length` samples.

    Unlike an estimate with a window it misses no slow tail; known to (2 length/samples)^(1/2)
    only; too small by half of itself over `length`, relatively. NaN for fewer than two blocks.
    """
    blocks = len(series) // length
    if blocks < 2:
        return math.nan
    means = series[: blocks * length].reshape(blocks, length).mean(axis=1)
    return float(length * means.var(ddof=1) / series.var())
