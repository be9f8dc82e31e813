"""Averages of observations over time, and the standard errors of functions of them.

The standard error of a function f of means is the error of a linearised series,
z_k = df(m).(x_k - m), whose mean vanishes (the infinitesimal jackknife, B. Efron, The Jackknife,
the Bootstrap and Other Resampling Plans, 1982, chapter 6).
"""

import math
import warnings
from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import NamedTuple

import numpy as np

from roughgas.statistics.errors import (
    autocorrelation_time,
    blocking,
    degrees_of_freedom,
    effective_samples,
    period_means,
)
from roughgas.statistics.sample_sizes import SampleSize

NamedArrays = Mapping[str, np.ndarray]
"""Arrays by name."""

SLOPE_STEP = 1e-4  # step of the numerical derivative, over the deviations
MAXIMUM_ENTRIES = 2**17  # of arrays that are combined at once


class Averages(NamedTuple):
    """Results of an observable, their standard errors, dof and sample sizes, each by name."""

    value: dict[str, np.ndarray]
    stderr: dict[str, np.ndarray]
    dof: dict[str, np.ndarray]
    sample_size: dict[str, SampleSize]  # arrays in the shape of the value


def averaged(
    combine: Callable[[NamedArrays], NamedArrays],
    runs: Sequence[NamedArrays],
    per_period: int = 1,
    columns: bool = False,
) -> Averages:
    """Return the results of `combine` for averages over observations in independent runs.

    `runs` has arrays (observations, ...) by name for each run, at equal intervals. Means are over
    complete periods of `per_period` observations, if a run has one. The error is by blocking in a
    single run, else from the scatter over runs. Observations that are NaN do not count. `columns`:
    whether `combine` is `columnwise`; then it is called a few times, else twice per observation.
    """
    with np.errstate(divide="ignore", invalid="ignore"), warnings.catch_warnings():
        warnings.simplefilter("ignore", RuntimeWarning)  # means of nothing are NaN
        series = [_period_means_of(run, per_period) for run in runs]
        run_means = [{name: np.nanmean(x, axis=0) for name, x in run.items()} for run in series]
        if len(runs) > 1:
            series = [{name: np.array([run[name] for run in run_means]) for name in run_means[0]}]
        mean = {name: np.nanmean(x, axis=0) for name, x in series[0].items()}
        results = combine(mean)
        linear = _linear_deviations(combine, mean, series[0], columns)
    value = {name: np.asarray(result, float) for name, result in results.items()}
    error_of, size_of = (
        (_scatter_errors, _run_counts) if len(runs) > 1 else (_blocking_errors, _series_sizes)
    )
    errors = {name: error_of(deviations) for name, deviations in linear.items()}
    sample_sizes = {name: size_of(deviations) for name, deviations in linear.items()}
    stderr, dof = (
        {name: error_and_dof[k] for name, error_and_dof in errors.items()} for k in range(2)
    )
    return Averages(value, stderr, dof, sample_sizes)


def _run_counts(runs: np.ndarray) -> SampleSize:
    """Return the sample size of values (runs, ...): the number of runs with a value."""
    return SampleSize(runs=np.isfinite(runs).sum(axis=0))


def _series_sizes(series: np.ndarray) -> SampleSize:
    """Return the sample size of each linearised series (samples, ...).

    It has the number of samples, the length in autocorrelation times, and the effective samples.
    """
    columns = [column[np.isfinite(column)] for column in series.reshape(len(series), -1).T]
    lengths_and_times = [
        (len(column), autocorrelation_time(column) if len(column) else math.nan)
        for column in columns
    ]
    rows = [
        (samples, samples / time, effective_samples(column, time))
        for column, (samples, time) in zip(columns, lengths_and_times, strict=True)
    ]
    sizes = np.array(rows, float).reshape(-1, 3).T.reshape(3, *series.shape[1:])
    return SampleSize(samples=sizes[0], times=sizes[1], effective_samples=sizes[2])


def _period_means_of(observations: NamedArrays, per_period: int) -> dict[str, np.ndarray]:
    """Return means over periods (periods, ...) by name; the observations without a full period.

    `per_period` is the number of observations in a period.
    """
    series = {name: np.asarray(values, float) for name, values in observations.items()}
    if per_period == 1 or len(next(iter(series.values()))) < per_period:
        return series
    return {name: _means_over_periods(x, per_period) for name, x in series.items()}


def _means_over_periods(x: np.ndarray, per_period: int) -> np.ndarray:
    """Return means (periods, ...) of `x` (observations, ...) over periods; NaN does not count.

    `per_period` is the number of observations in a period.
    """
    if np.isfinite(x).all():
        return np.moveaxis(period_means(np.moveaxis(x, 0, -1), per_period), -1, 0)
    complete_periods = x[: len(x) // per_period * per_period]
    return np.nanmean(complete_periods.reshape(-1, per_period, *x.shape[1:]), axis=1)


def _linear_deviations(combine, mean, series, columns) -> dict[str, np.ndarray]:
    """Return f(x_k) - f(mean) to first order for each sample k, (samples, ...) by name.

    f is `combine`, `series` has the samples x (samples, ...), `columns` whether f is `columnwise`.
    """
    if not columns:
        samples = range(len(next(iter(series.values()))))
        deviations = [
            _linear_deviation(combine, mean, {name: x[k] for name, x in series.items()})
            for k in samples
        ]
        return {
            name: np.array([deviation[name] for deviation in deviations]) for name in deviations[0]
        }
    mean = {name: m[..., None] for name, m in mean.items()}
    chunks = [_linear_deviation(combine, mean, chunk) for chunk in _column_chunks(series)]
    return {
        name: np.ascontiguousarray(
            np.moveaxis(np.concatenate([chunk[name] for chunk in chunks], axis=-1), -1, 0)
        )
        for name in chunks[0]
    }


def _linear_deviation(combine, mean, x) -> NamedArrays:
    """Return f(x) - f(mean) to first order in x - mean, by a central difference, by name.

    f is `combine`; `mean` and `x` are arrays by name.
    """
    shifted = [
        combine({name: m + sign * SLOPE_STEP * (x[name] - m) for name, m in mean.items()})
        for sign in (1, -1)
    ]
    return {name: (shifted[0][name] - shifted[1][name]) / (2.0 * SLOPE_STEP) for name in shifted[0]}


def _column_chunks(series: NamedArrays) -> Iterator[NamedArrays]:
    """Generate stretches of series (samples, ...) as columns (..., samples), of a few MB each.

    Each is a mapping of arrays by name, as `series` is.
    """
    samples = len(next(iter(series.values())))
    entries = sum(x.size for x in series.values()) // samples
    step = max(1, MAXIMUM_ENTRIES // max(1, entries))
    for first in range(0, samples, step):
        yield {name: np.moveaxis(x[first : first + step], 0, -1) for name, x in series.items()}


def _blocking_errors(series: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return standard errors by blocking of means of series (samples, ...), and their dof."""
    columns = series.reshape(len(series), -1).T
    blockings = [blocking(column[np.isfinite(column)]) for column in columns]
    errors = [(result.stderr, degrees_of_freedom(result.blocks)) for result in blockings]
    return tuple(np.array(errors).T.reshape(2, *series.shape[1:]))


def _scatter_errors(runs: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return standard errors of means of independent numbers (runs, ...), and their dof."""
    finite = np.isfinite(runs)
    count = finite.sum(axis=0)
    square = np.where(finite, runs, 0.0) ** 2
    with np.errstate(divide="ignore", invalid="ignore"):
        stderr = np.sqrt(square.sum(axis=0) / (count * (count - 1.0)))
    return np.where(count > 1, stderr, math.nan), np.maximum(count - 1.0, 0.0)
