"""Means over looks, what observables make of them, and the standard errors of that.

The error of a function f of means is that of the series to which f is linear in the deviations from
the means: z_k = df(m).(x_k - m), whose mean vanishes (the infinitesimal jackknife, B. Efron, The
Jackknife, the Bootstrap and Other Resampling Plans, 1982, chapter 6).
"""

import math
import warnings
from collections.abc import Callable, Iterator, Sequence
from typing import NamedTuple

import numpy as np

from roughgas.observables.plugin import Values
from roughgas.statistics.errors import blocking, degrees_of_freedom, period_means

STEP = 1e-4  # of the deviations, in which the slope is taken


class Averages(NamedTuple):
    """Results, their standard errors, and the degrees of freedom of these, each by name."""

    value: dict[str, np.ndarray]
    stderr: dict[str, np.ndarray]
    dof: dict[str, np.ndarray]


def averaged(
    combine: Callable[[Values], Values], runs: Sequence[Sequence[Values]], per_period: int = 1
) -> Averages:
    """Return the averages of what was seen in independent runs, in each at equal intervals.

    Means are over whole periods of so many looks, if there is one. The error is by blocking in a
    single run, else from the scatter over runs. Looks that are NaN do not count.
    """
    with np.errstate(divide="ignore", invalid="ignore"), warnings.catch_warnings():
        warnings.simplefilter("ignore", RuntimeWarning)  # means of nothing are NaN
        series = [_stacked(run, per_period) for run in runs]
        own = [{name: np.nanmean(x, axis=0) for name, x in one.items()} for one in series]
        if len(runs) > 1:
            series = [{name: np.array([one[name] for one in own]) for name in own[0]}]
        mean = {name: np.nanmean(x, axis=0) for name, x in series[0].items()}
        found = combine(mean)
        slopes = list(_slopes(combine, mean, series[0]))
    value = {name: np.asarray(one, float) for name, one in found.items()}
    error = _scatter if len(runs) > 1 else _blocked
    errors = {name: error(np.array([one[name] for one in slopes])) for name in value}
    return Averages(value, *({n: errors[n][k] for n in value} for k in range(2)))


def _stacked(looks: Sequence[Values], per_period: int) -> dict[str, np.ndarray]:
    """Return arrays (periods, ...) by name."""
    stacks = {name: np.array([look[name] for look in looks], float) for name in looks[0]}
    if per_period == 1 or len(looks) < per_period:
        return stacks
    turned = {name: np.moveaxis(x, 0, -1) for name, x in stacks.items()}
    return {name: np.moveaxis(period_means(x, per_period), -1, 0) for name, x in turned.items()}


def _slopes(combine, mean, series) -> Iterator[Values]:
    """Generate the linear part of f(x_k) - f(mean) for each k."""
    for k in range(len(next(iter(series.values())))):
        ends = [
            combine({name: m + sign * STEP * (series[name][k] - m) for name, m in mean.items()})
            for sign in (1, -1)
        ]
        yield {name: (ends[0][name] - ends[1][name]) / (2.0 * STEP) for name in ends[0]}


def _blocked(series: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return error and degrees of freedom of the means of a series (samples, ...)."""
    columns = series.reshape(len(series), -1).T
    found = [blocking(column[np.isfinite(column)]) for column in columns]
    pairs = [(one.stderr, degrees_of_freedom(one.blocks)) for one in found]
    return tuple(np.array(pairs).T.reshape(2, *series.shape[1:]))


def _scatter(runs: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return error and degrees of freedom of the means of independent numbers (runs, ...)."""
    there = np.isfinite(runs)
    count = there.sum(axis=0)
    square = np.where(there, runs, 0.0) ** 2
    with np.errstate(divide="ignore", invalid="ignore"):
        stderr = np.sqrt(square.sum(axis=0) / (count * (count - 1.0)))
    return np.where(count > 1, stderr, math.nan), np.maximum(count - 1.0, 0.0)
