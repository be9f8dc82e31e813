"""Means with their errors: averages, standard errors, intervals, and whether there is evidence.

A point's error pools the scatter over independent seeds with the errors within its runs (`pooled`).
Pass period means (`period_means`), not raw samples of a periodically driven gas.

A standard error from a few numbers is itself uncertain, by a fraction 1/sqrt(2 dof). Its degrees of
freedom are therefore kept beside it, and decide how wide the interval is that holds the truth with
a given probability.
"""

import math
from statistics import NormalDist
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

YES, NO, UNKNOWN = 1, 0, -1
"""The values of a verdict; UNKNOWN stands for a lack of evidence."""
FEWEST_BLOCKS = 4
WINDOW = 3.0  # in autocorrelation times; longer ones add noise, and bias in a short series
DISAGREE = 2.0  # sigma
DIGITS = 2  # of an error
SIGNIFICANT = 3.0
"""Sigma from which a difference counts as real. A convention. Fixed before any data."""


class Evidence(NamedTuple):
    """What a measured window rests on, numbers or arrays; each must reach that of LEAST."""

    collisions: Any = math.inf  # of each particle, made within it
    samples: Any = math.inf  # that its mean is made of; where a drive has a period, means over it
    relaxations: Any = math.inf  # e-folds, by theory, that a transient has had to decay in
    memories: Any = math.inf  # of its length, in times of theory
    runs: Any = math.inf  # independent ones that it is averaged over, where it is over such
    phases: Any = math.inf  # of a periodic drive, shown by the samples
    times: Any = math.inf  # of its length, in measured autocorrelation times
    carriers: Any = math.inf  # independent samples that carry its variance (`carriers`)

    def suffices(self, least: "Evidence | None" = None) -> np.ndarray:
        """Return whether each number reaches that of `least`, LEAST if not given."""
        reached: Any = True
        for number, limit in zip(self, LEAST if least is None else least, strict=True):
            if number is not math.inf:  # which reaches any
                reached = reached & np.greater_equal(number, limit)
        return np.asarray(reached)

    def verdict(self, holds: bool, least: "Evidence | None" = None) -> int:
        """Return whether a statement `holds`, YES or NO; UNKNOWN if this is too little evidence."""
        return int(holds) if self.suffices(least) else UNKNOWN


# Ten collisions per particle are a few e-folds of R where it relaxes fastest. Relaxations: the
# 95 % interval of a plateau that begins after three holds the truth in 87 % only (`find_plateau`).
# Memories: from twelve on the interval of R holds the truth in 92 to 98 % (docs/accuracy.md). Runs:
# the spread of fewer is too badly known to show a drift. Phases: with 16 a bed has R within 0.0005
# of that with 80. Times and carriers are of data, which may only veto: honest series pass.
LEAST = Evidence(
    collisions=10,
    samples=12,
    relaxations=5,
    memories=12,
    runs=5,
    phases=16,
    times=6,
    carriers=12,
)


IN_WORDS = {
    "collisions": "{} collisions per particle",
    "samples": "{} samples",
    "relaxations": "{} e-folds of the slowest temperature",
    "memories": "window of {} memories",
    "runs": "{} replicas",
    "phases": "{} phases of the drive",
    "times": "window of {} measured autocorrelation times",
}


def lack_of(evidence: Evidence, least: Evidence) -> str:
    """Return in words which numbers do not reach those of `least`; nothing where all do."""
    return "; ".join(
        f"{text.format(_whole(getattr(evidence, name)))}, {getattr(least, name):g} needed"
        for name, text in IN_WORDS.items()
        if not getattr(evidence, name) >= getattr(least, name)
    )


def _whole(number: float) -> int:
    return math.floor(number) if math.isfinite(number) else 0


def verdict(steady: int, evidence: Evidence, least: Evidence = LEAST) -> np.ndarray:
    """Return whether a number's interval holds the truth as often as it says.

    Flags (int8) in the shape of the evidence: `steady`, a flag, where that is not YES; YES with all
    the evidence of `least`, else UNKNOWN. Theory decides by the length of the window. The run's own
    noise never vouches for it: it can but veto.
    """
    enough = evidence.suffices(least)
    return np.where(enough | (steady != YES), steady, UNKNOWN).astype(np.int8)


def period_means(series: np.ndarray, samples_per_period: int) -> np.ndarray:
    """Return means over consecutive blocks of `samples_per_period` samples, along the last axis.

    A vibrated bed that is sampled a few times per period shows the same few phases of its floor
    again and again. Its raw samples are anticorrelated, and their autocorrelation misleads, so all
    statistics are of these means. An incomplete last block is left out. `series` has shape (...,
    samples), the result (..., samples // samples_per_period). Raises ValueError unless there is at
    least one whole period.
    """
    series = np.asarray(series)
    periods = series.shape[-1] // samples_per_period if samples_per_period >= 1 else 0
    if periods < 1:
        samples = f"{series.shape[-1]} samples"
        raise ValueError(f"{samples} hold no whole period of {samples_per_period} samples")
    if samples_per_period == 1:  # a mean of each value takes time
        return series.astype(float)
    whole = series[..., : periods * samples_per_period]
    return whole.reshape(*series.shape[:-1], periods, samples_per_period).mean(axis=-1)


def block_means(values: np.ndarray, block: int) -> np.ndarray:
    """Return the means over blocks of `block` values; the last block may be shorter."""
    begins = np.arange(0, values.size, block)
    return np.add.reduceat(values, begins) / np.diff(np.append(begins, values.size))


class Blocking(NamedTuple):
    """Standard error of a mean, and how many blocks of the chosen length the series holds."""

    stderr: float
    blocks: float


def blocking_stderr(series: np.ndarray) -> float:
    """Return the standard error of the mean of a correlated series, shape (samples,)."""
    return blocking(series).stderr


def blocking(series: np.ndarray) -> Blocking:
    """Return the standard error of the mean of a correlated series of shape (samples,).

    Blocking (Flyvbjerg & Petersen, J. Chem. Phys. 91, 461 (1989)) with overlapping blocks (Meketon
    & Schmeiser, Proc. Winter Simulation Conference (1984)), which use the data better than
    disjoint ones. The block length b grows until b^3 > 2 n tau^2, the optimum of Lee et al., Phys.
    Rev. E 83, 066706 (2011), and Wolff, Comput. Phys. Commun. 156, 143 (2004), where tau is the
    integrated autocorrelation time found on the way, or until few blocks are left. Blocks of
    length b miss a share of about tau/(2 b) of the variance, which is added again.

    On AR(1) series of 100 to 4000 samples with tau from 0.5 to n/20 the root mean square estimate
    is within 7 % of the truth; a single one scatters by 5 % (tau = 1, n = 2000) to 30 % (tau =
    n/20).
    The error is NaN below two samples.
    """
    series = np.asarray(series, dtype=float)
    samples = len(series)
    if samples < 2:
        return Blocking(math.nan, samples)
    if np.ptp(series) == 0:
        return Blocking(0.0, samples)
    naive = series.var(ddof=1) / samples
    sums = np.concatenate([[0.0], np.cumsum(series - series.mean())])
    length = 1
    while True:
        variance = _overlapping_block_variance(sums, length)
        time = variance / naive
        longer = math.ceil(1.3 * length)
        if length**3 > 2 * samples * time**2 or longer * FEWEST_BLOCKS > samples:
            missing = min(time / (2 * length), 0.5)
            return Blocking(math.sqrt(variance * (1 + missing)), samples / length)
        length = longer


def autocorrelation_time(series: np.ndarray) -> float:
    """Return the integrated autocorrelation time 1 + 2 sum rho(k), in samples.

    `series` has shape (samples,), or (replicas, samples) for replicas whose autocorrelation
    functions are averaged. The sum ends at Sokal's window (A. D. Sokal, Monte Carlo methods in
    statistical mechanics, 1996), which is 3 tau in this convention (his 6). The estimate comes
    out short because the mean is taken from the same series, which is corrected to first order as
    in Wolff (2004). Never below 1: anticorrelation gets no credit, because it mostly comes from
    samples at fixed phases of a drive. 1 for a constant series, of which each sample says all; NaN
    where a value is. Reliable if the series is 20 tau long.
    """
    series = np.atleast_2d(np.asarray(series, dtype=float))
    samples = series.shape[1]
    if not np.isfinite(series).all():
        return math.nan
    varying = series[np.ptp(series, axis=1) > 0]
    if len(varying) == 0:
        return 1.0
    time = _integrated_time(varying)
    return max(1.0, time * (1 + 2 * WINDOW * time / samples))


def _integrated_time(series: np.ndarray) -> float:
    """Return 1 + 2 sum rho(k) of series (replicas, samples), to the first k of WINDOW times it."""
    rho = sum(map(_autocorrelation, series)) / len(series)
    times = 2.0 * np.cumsum(rho) - 1.0
    inside = np.arange(len(times)) < WINDOW * times
    return float(times[np.argmin(inside)] if inside.any() else times[-1])


def _autocorrelation(series: np.ndarray) -> np.ndarray:
    """Return rho(k) of a series (samples,), by the Fourier transform of the series and zeros."""
    room = 2 * 2 ** (len(series) - 1).bit_length()
    spectrum = np.fft.fft(series - series.mean(), n=room)
    covariance = np.fft.ifft(spectrum * np.conjugate(spectrum))[: len(series)].real
    return covariance / covariance[0]


def carriers(series: np.ndarray, autocorrelation_time: float) -> float:
    """Return how many independent samples carry the variance of a series (samples,) about 0.

    Of means z over overlapping blocks of an autocorrelation time (in samples) it is 3 <z^2>^2/<z^4>
    times the blocks side by side: their number if z is Gaussian, three times the visits if a few
    rare ones make up the series. 0 of a series that is 0, and where the time is NaN.
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
    """Return the standard error of the mean of independent values, shape (seeds,); NaN for one."""
    values = np.asarray(values, dtype=float)
    if len(values) < 2:
        return math.nan
    return float(values.std(ddof=1)) / math.sqrt(len(values))


def gaussian_sigmas(t: np.ndarray | float, degrees_of_freedom: float) -> np.ndarray:
    """Return how many sigma of a Gaussian are as improbable as Student's `t`, with its sign.

    With four seeds (3 degrees of freedom) a difference of 3 standard errors is no rarer than 1.9
    sigma. Formula of Wallace, Ann. Math. Stat. 30, 1121 (1959), never too large; too small by 0.05
    at 3 sigma and 0.2 at 5 for 3 degrees of freedom, by a fifth of that for 8.
    """
    dof, t = degrees_of_freedom, np.asarray(t, dtype=float)
    return np.sign(t) * np.sqrt(dof * np.log1p(t**2 / dof)) * _wallace(dof)


def student_t(sigmas: float, degrees_of_freedom: float) -> float:
    """Return how many standard errors are as safe a bound as `sigmas` >= 0 of a known Gaussian.

    The inverse of `gaussian_sigmas`: 2 sigma are 3.3 standard errors of four values, 2.4 of nine,
    and 2 with infinitely many degrees of freedom.
    """
    dof = degrees_of_freedom
    if math.isinf(dof):
        return sigmas
    return math.sqrt(dof * math.expm1((sigmas / _wallace(dof)) ** 2 / dof))


def _wallace(degrees_of_freedom: float) -> float:
    return (8 * degrees_of_freedom + 1) / (8 * degrees_of_freedom + 3)


def _overlapping_block_variance(sums: np.ndarray, length: int) -> float:
    """Return the variance of the mean from all blocks of `length` consecutive samples of a series,
    whose cumulated departures from its mean are `sums`, shape (samples + 1,)."""
    samples = len(sums) - 1
    means = sums[length:] - sums[:-length]
    means /= length
    means *= means  # in place: blocks are many, and arrays of them take time to allocate
    return length / ((samples - length) * (samples - length + 1)) * float(means.sum())


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


def degrees_of_freedom(blocks: float) -> float:
    """Return the degrees of freedom of a standard error by `blocking` with `blocks` blocks.

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
    squares = weights * np.nan_to_num(within) ** 2
    own = float(squares.sum()) / max(float(weights.sum()), 1e-300)
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


class Estimate(NamedTuple):
    """A value, its standard error, and the degrees of freedom that the error is known with.

    `f"{estimate}"` is compact: 0.3565(30), the error in units of the last digit. A format for
    numbers is applied to both: `f"{estimate:+.4f}"` is +0.3565 ± 0.0030. In `f"{estimate:±}"` and
    `f"{estimate:+±}"` the error has two digits.
    """

    value: Any  # a float, in studies also an array of them; so are the others
    stderr: Any
    dof: Any = math.inf

    @property
    def sigma(self) -> float:
        """How many sigma of a Gaussian the value is from 0, signed; NaN if the error is unknown."""
        if not math.isfinite(self.stderr) or self.stderr < 0:
            return math.nan
        if self.stderr == 0:
            return math.copysign(math.inf, self.value) if self.value else 0.0
        ratio = self.value / self.stderr
        return ratio if math.isinf(self.dof) else float(gaussian_sigmas(ratio, self.dof))

    @property
    def ci95(self) -> float:
        """Half the width of the 95 % interval, by Student's t; NaN if the error is unknown."""
        return half_width(self.stderr, self.dof, 0.95)

    @property
    def real(self) -> bool:
        """Whether it differs from 0 significantly."""
        return abs(self.sigma) >= SIGNIFICANT

    def minus(self, other: "Estimate") -> "Estimate":
        """Return the difference of two independent estimates."""
        stderr, dof = sum_error([self.stderr, other.stderr], [self.dof, other.dof])
        return Estimate(self.value - other.value, float(stderr), float(dof))

    def scaled(self, factor: float) -> "Estimate":
        """Return the estimate in other units, such as per cent."""
        return Estimate(factor * self.value, abs(factor) * self.stderr, self.dof)

    def record(self) -> dict[str, float]:
        """Return value, error, ci95 and sigma for JSON, with six significant digits."""
        numbers = {"value": self.value, "error": self.stderr, "ci95": self.ci95}
        numbers["sigma"] = self.sigma
        return {name: float(f"{number:.6g}") for name, number in numbers.items()}

    def __format__(self, how: str) -> str:
        if not how:
            return self._compact()
        if how.endswith("±"):
            how = f"{how[:-1]}.{max(0, decimals_of(self.stderr))}f"
        if not math.isfinite(self.stderr):
            return f"{self.value:{how}} (error unknown)"
        return f"{self.value:{how}} ± {self.stderr:{how.lstrip('+')}}"

    def _compact(self) -> str:
        """Return such as 0.3565(30); six digits if there is no error."""
        value, stderr, _ = self
        if not (math.isfinite(value) and math.isfinite(stderr) and stderr > 0.0):
            return f"{value:.6g}"
        exponent = _exponent(max(abs(value), stderr))
        if not -4 <= exponent < 6:
            return f"{Estimate(value / 10.0**exponent, stderr / 10.0**exponent)}e{exponent:+03}"
        decimals = decimals_of(stderr)
        if decimals < 0:
            return f"{round(value, decimals):.0f}({round(stderr, decimals):.0f})"
        shown = f"{stderr:.{decimals}f}" if stderr >= 1.0 else str(round(stderr * 10**decimals))
        return f"{value:.{decimals}f}({shown})"


def decimals_of(stderr: float) -> int:
    """Return how many decimals of a number with this error count; negative for tens and so on.

    Two where the error is zero or unknown.
    """
    if not (math.isfinite(stderr) and stderr > 0.0):
        return DIGITS
    return DIGITS - 1 - _exponent(float(f"{stderr:.{DIGITS - 1}e}"))


def _exponent(number: float) -> int:
    return math.floor(math.log10(number))
