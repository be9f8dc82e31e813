"""Standard errors of means and series, and the widths of confidence intervals.

The error of a point pools the scatter over independent seeds with the errors within its runs
(`pooled_error`). Pass period means (`period_means`), not raw samples of a periodically driven gas.

A standard error from a few numbers is itself uncertain, by a fraction 1/sqrt(2 dof). Its degrees of
freedom `dof` are therefore stored with it, and determine the width of confidence intervals.
"""

import math
from statistics import NormalDist
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from roughgas.statistics.student import wallace_t

MINIMUM_BLOCKS = 4
AUTOCORRELATION_WINDOW = 3.0  # in autocorrelation times; a longer one adds noise and, if the
# series is short, bias
DISAGREEMENT_SIGMAS = 2.0


def period_means(series: np.ndarray, samples_per_period: int) -> np.ndarray:
    """Return means over consecutive blocks of `samples_per_period` samples, along the last axis.

    A vibrated bed that is sampled a few times per period repeats the same few phases of its floor.
    Its raw samples are anticorrelated, and their autocorrelation misleads, so all statistics use
    these means. An incomplete last block is omitted. `series` has shape (..., samples), the result
    (..., samples // samples_per_period). Raises ValueError without a complete period.
    """
    series = np.asarray(series)
    periods = series.shape[-1] // samples_per_period if samples_per_period >= 1 else 0
    if periods < 1:
        samples = f"{series.shape[-1]} samples"
        raise ValueError(f"{samples} hold no whole period of {samples_per_period} samples")
    if samples_per_period == 1:  # saves time
        return series.astype(float)
    complete_periods = series[..., : periods * samples_per_period]
    return complete_periods.reshape(*series.shape[:-1], periods, samples_per_period).mean(axis=-1)


def block_means(values: np.ndarray, block_length: int) -> np.ndarray:
    """Return the means over blocks of `block_length` consecutive values, (blocks,).

    `values` has shape (samples,); the last block may be shorter.
    """
    begins = np.arange(0, values.size, block_length)
    return np.add.reduceat(values, begins) / np.diff(np.append(begins, values.size))


class Blocking(NamedTuple):
    """Standard error of a mean, and the number of blocks of the chosen length in the series."""

    stderr: float
    blocks: float


def blocking_stderr(series: np.ndarray) -> float:
    """Return the standard error of the mean of a correlated series (samples,), by `blocking`.

    In the unit of the series; NaN below two samples.
    """
    return blocking(series).stderr


def blocking(series: np.ndarray) -> Blocking:
    """Return the standard error of the mean of a correlated series of shape (samples,).

    Blocking (Flyvbjerg & Petersen, J. Chem. Phys. 91, 461 (1989)) with overlapping blocks (Meketon
    & Schmeiser, Proc. Winter Simulation Conference (1984)), which use the data better than disjoint
    ones. The block length b grows until b^3 > 2 n tau^2, n being the number of samples, the optimum
    of Lee et al., Phys. Rev. E 83, 066706 (2011), and Wolff, Comput. Phys. Commun. 156, 143 (2004),
    where tau is the integrated autocorrelation time estimated from blocks of this length, or until
    few blocks are left. Blocks of length b miss a share of about tau/(2 b) of the variance, which
    is added again.

    On AR(1) series of 100 to 4000 samples with tau from 0.5 to n/20 the root mean square estimate
    is within 7 % of the truth; a single estimate scatters by 5 % (tau = 1, n = 2000) to 30 %
    (tau = n/20). The error is NaN below two samples.
    """
    series = np.asarray(series, dtype=float)
    samples = len(series)
    if samples < 2:
        return Blocking(math.nan, samples)
    if np.ptp(series) == 0:
        return Blocking(0.0, samples)
    uncorrelated = series.var(ddof=1) / samples
    sums = np.concatenate([[0.0], np.cumsum(series - series.mean())])
    length = 1
    while True:
        variance = _overlapping_block_variance(sums, length)
        time = variance / uncorrelated
        next_length = math.ceil(1.3 * length)
        if length**3 > 2 * samples * time**2 or next_length * MINIMUM_BLOCKS > samples:
            missing_share = min(time / (2 * length), 0.5)
            return Blocking(math.sqrt(variance * (1 + missing_share)), samples / length)
        length = next_length


def autocorrelation_time(series: np.ndarray) -> float:
    """Return the integrated autocorrelation time tau = 1 + 2 sum rho(k), in samples.

    rho(k) is the autocorrelation at a distance of k samples. `series` has shape (samples,), or
    (replicas, samples) for replicas whose autocorrelation functions are averaged. The sum ends at
    Sokal's window (A. D. Sokal, Monte Carlo methods in statistical mechanics, 1996), which is 3 tau
    in this convention (his 6). The estimate is biased low because the mean is taken from the same
    series; this is corrected to first order as in Wolff (2004). Never below 1: anticorrelation is
    ignored, because it mostly comes from samples at fixed phases of a drive. 1 for a constant
    series; NaN if a value is NaN. Reliable if the series is 20 tau long.
    """
    series = np.atleast_2d(np.asarray(series, dtype=float))
    samples = series.shape[1]
    if not np.isfinite(series).all():
        return math.nan
    varying = series[np.ptp(series, axis=1) > 0]
    if len(varying) == 0:
        return 1.0
    time = _integrated_time(varying)
    return max(1.0, time * (1 + 2 * AUTOCORRELATION_WINDOW * time / samples))


def _integrated_time(series: np.ndarray) -> float:
    """Return 1 + 2 sum rho(k) of series (replicas, samples), in samples.

    rho(k) is averaged over the replicas; the sum ends at AUTOCORRELATION_WINDOW times itself.
    """
    rho = sum(map(_autocorrelation, series)) / len(series)
    times = 2.0 * np.cumsum(rho) - 1.0
    inside = np.arange(len(times)) < AUTOCORRELATION_WINDOW * times
    return float(times[np.argmin(inside)] if inside.any() else times[-1])


def _autocorrelation(series: np.ndarray) -> np.ndarray:
    """Return the autocorrelation rho(k), (samples,), of a series (samples,).

    It is computed by the Fourier transform of the zero-padded series.
    """
    padded_length = 2 * 2 ** (len(series) - 1).bit_length()
    spectrum = np.fft.fft(series - series.mean(), n=padded_length)
    covariance = np.fft.ifft(spectrum * np.conjugate(spectrum))[: len(series)].real
    return covariance / covariance[0]


def effective_samples(series: np.ndarray, autocorrelation_time: float) -> float:
    """Return the number of independent samples that carry the variance of a series about 0.

    `series` is (samples,), and `autocorrelation_time` is in samples. With means z over overlapping
    blocks of this length it is 3 <z^2>^2/<z^4> times the number of adjacent blocks: this number if
    z is Gaussian, three times the number of events if a few rare events make up the series. 0 if
    the series vanishes, and if the time is NaN.
    """
    if not (len(series) and math.isfinite(autocorrelation_time)):
        return 0.0
    length = max(1, min(math.ceil(autocorrelation_time), len(series)))
    sums = np.concatenate([[0.0], np.cumsum(series)])
    square = (sums[length:] - sums[:-length]) ** 2
    largest = float(square.max())
    if not largest > 0.0:
        return 0.0
    share = square / largest
    return float(3.0 * share.sum() ** 2 / (share**2).sum()) / length


def stderr_over_seeds(values: np.ndarray) -> float:
    """Return the standard error of the mean of independent values, one per seed; NaN for one value.

    `values` has shape (seeds,).
    """
    values = np.asarray(values, dtype=float)
    if len(values) < 2:
        return math.nan
    return float(values.std(ddof=1)) / math.sqrt(len(values))


def _overlapping_block_variance(sums: np.ndarray, length: int) -> float:
    """Return the variance of the mean of a series, from all blocks of `length` consecutive samples.

    `sums` are the cumulated deviations of the series from its mean, shape (samples + 1,).
    """
    samples = len(sums) - 1
    means = sums[length:] - sums[:-length]
    means /= length
    means *= means  # in place: allocating arrays of this size takes time
    return length / ((samples - length) * (samples - length + 1)) * float(means.sum())


class StandardError(NamedTuple):
    """A standard error, and the degrees of freedom `dof` of its estimate."""

    stderr: Any  # a float, or an array of them; so are the degrees of freedom
    dof: Any

    def half_width(self, level: float) -> float:
        """Return half the width of the confidence interval at `level` in (0, 1), by Student's t."""
        return half_width(self.stderr, self.dof, level)


def half_width(stderr: float, dof: float, level: float) -> float:
    """Return half the width of the confidence interval at `level` in (0, 1), by Student's t.

    `stderr` is the standard error and `dof` its degrees of freedom. NaN if the error is unknown
    (`dof` below 1, as for a single number). By Wallace's formula, like the intervals stored in
    points: at 95 % too wide by 38 % for 1 degree of freedom, 4 % for 2, and 1 % for 3.
    """
    if not dof >= 1:
        return math.nan
    return wallace_t(NormalDist().inv_cdf((1 + level) / 2), dof) * stderr


def degrees_of_freedom(blocks: float) -> float:
    """Return the degrees of freedom of a standard error by `blocking` with `blocks` blocks.

    Overlapping blocks of a given length have 1.5 times the degrees of freedom of disjoint blocks
    (Meketon & Schmeiser 1984). Choosing the length from the same series cancels this gain: on AR(1)
    series of 20 to 1000 autocorrelation times the squared error scatters as with 0.6 to 1.3 times
    the number of disjoint blocks, less one.
    """
    return max(0.0, blocks - 1.0)


def pooled_error(means: np.ndarray, within: np.ndarray, dof: np.ndarray) -> StandardError:
    """Return the standard error of the mean of runs, from their scatter and their errors.

    `means`, `within` (the standard error of each run) and `dof` (its degrees of freedom) have shape
    (runs,). Both scatter and errors estimate the variance of a run; they are averaged with their
    degrees of freedom as weights, as in an analysis of variance. Where the scatter exceeds the
    errors of the runs by 2 sigma, these errors miss something (motion slower than a run), and only
    the scatter counts. An unknown error of a run has dof 0 (or NaN) and no weight.
    """
    means, within = np.asarray(means, float), np.asarray(within, float)
    weights = np.where(np.isfinite(within), np.nan_to_num(dof), 0.0)
    runs = len(means)
    if runs == 1:
        return StandardError(float(within[0]), float(weights[0]))
    between_variance = float(means.var(ddof=1))
    weighted_squares = weights * np.nan_to_num(within) ** 2
    within_variance = float(weighted_squares.sum()) / max(float(weights.sum()), 1e-300)
    scatter_dof, within_dof = runs - 1.0, float(weights.sum())
    if (
        within_dof == 0
        or excess_sigmas(between_variance, scatter_dof, within_variance, within_dof)
        > DISAGREEMENT_SIGMAS
    ):
        return StandardError(math.sqrt(between_variance / runs), scatter_dof)
    total_dof = scatter_dof + within_dof
    variance = (scatter_dof * between_variance + within_dof * within_variance) / total_dof
    return StandardError(math.sqrt(variance / runs), total_dof)


def sum_error(stderr: ArrayLike, dof: ArrayLike) -> StandardError:
    """Return the standard error of sums of independent numbers along the first axis.

    `stderr` and `dof` are the standard errors of the numbers and their degrees of freedom. The
    degrees of freedom of the result follow Welch, Biometrika 34, 28 (1947), and Satterthwaite.
    """
    square = np.square(np.asarray(stderr, float))
    total = square.sum(0)
    with np.errstate(divide="ignore", invalid="ignore"):
        effective = total**2 / (square**2 / np.asarray(dof, float)).sum(0)
    return StandardError(np.sqrt(total), np.where(total > 0, effective, math.inf))


def excess_sigmas(first: float, first_dof: float, second: float, second_dof: float) -> float:
    """Return the excess, in sigma, of an estimate `first` of a variance over an estimate `second`.

    `first_dof` and `second_dof` are their degrees of freedom. Their quotient follows an F
    distribution: normal approximation of Paulson, Ann. Math. Stat. 13, 233 (1942). -inf if `first`
    is unknown or zero, inf if only `second` is zero.
    """
    if first_dof <= 0 or first == 0:
        return -math.inf
    if second == 0:
        return math.inf
    root = (first / second) ** (1 / 3)
    first_width, second_width = 2 / (9 * first_dof), 2 / (9 * second_dof)
    return ((1 - second_width) * root - (1 - first_width)) / math.sqrt(
        second_width * root**2 + first_width
    )
