"""Detection of steady states: of driven gases, plateaus of cooling gases, and mixtures of states.

**Driven gases.** The end of the transient, and whether a run has reached its steady state, are
determined from series of energies (period means for a vibrated bed, see `errors.period_means`), not
from R, which may already be stationary while both energies still drift. The rotational energy is
the slowest signal near beta = -1.

**Cooling gases.** The plateau of R in a freely cooling gas, found from an ensemble of replicas.

From spin 0, R rises to its plateau. Later, in large or very dissipative systems, shear modes and
clusters add energy of flow to E_tr, and R falls permanently. Neither scale is known beforehand, and
a single replica is too noisy to show them, so both ends are determined from the ensemble, as by
Welch's method for the warm-up of replicated simulations. The noise is the spread between replicas,
which are independent, so no autocorrelation along s, the collisions per particle, is needed:

1. The samples are divided into about 60 blocks, nearly even in log s, as the scales of transient
   and departure may lie far apart. A window of blocks is stationary if, at either end, no stretch
   of 1, 2, 4, ... blocks up to half of it departs from the rest by 3.5 sigma.
2. From each block the longest stationary window is taken, if it at least doubles s (so that it
   outlasts the transient before it) or begins at the earliest legal start.
3. Both ends are trimmed until no stretch departs by 3 sigma. (At 2 sigma noise alone would trim
   every fourth window, and the error would be understated by a seventh.) A window that ends inside
   the data then loses another fifth at this end, because a transient at the limit of detection
   would still bias the mean by about its standard error.
4. The plateau is the window with the largest ratio of final to initial s. Windows that drift are
   excluded (the last third must differ from the first by less than a quarter of R, at 2 sigma), and
   windows that R exceeds elsewhere, by 5 % and 3.5 sigma in a tenth of the samples before or after:
   a pause in the rise of R, or a later plateau where flow dominates.
5. If replicas rest at two different R (`is_bimodal`), their mean is no state of the gas: the window
   is reported, but does not count as a plateau.

On synthetic ensembles (relaxation in 4 to 60 collisions per particle, 10 to 60 replicas, series of
50 to 800 samples, with and without a departure) the bias is below 0.7 of the standard error, and
the 95 % interval holds the truth in 94 % of the cases, or in 87 % if `minimum_start` is only three
relaxation times or a plateau lasts only twenty. About ten replicas are needed, and a series of ten
relaxation times or a `minimum_start` of a few: a slower relaxation hides in the noise.

**Mixtures.** Whether an ensemble of replicas is a mixture: some have gone to another state.

The means of the replicas are sorted, and split in two groups at each gap. For a single split chosen
beforehand, the distance of its groups over the scatter within them would be a test statistic. The
largest value of all splits is about 3 in a Gaussian ensemble of any size. An ensemble is called
bimodal if a split reaches 5 sigma (the Gaussian deviate as improbable as Student's t with n - 2
degrees of freedom), and if its groups are a quarter of the mean apart.

Of 400 000 synthetic ensembles of 10, 20, 40 or 60 replicas, up to 6 in 100 000 Gaussian ensembles
reach 5 sigma, and up to 2 and 7 in 100 skewed or long-tailed ensembles (gamma distribution of shape
4, Student's t of 5 degrees of freedom). The second condition excludes nearly all of these: where
replicas scatter by 3 % of R, less than 1 in 1000 and 1 in 100 are still called bimodal. If a
replica, a quarter or half of them are displaced, nine tenths of mixtures are detected from a
displacement of 8 standard deviations of a replica on (40 and 60 replicas), 10 (20 replicas) or 20
(10 replicas).
"""

from typing import NamedTuple

import numpy as np

from roughgas.statistics.errors import blocking, degrees_of_freedom, period_means
from roughgas.statistics.student import wallace_sigmas, wallace_t

SAMPLES_PER_BATCH = 5
MINIMUM_SAMPLES = 12
ALARM_SIGMAS = 3.5  # one false alarm in 2000 if the noise were known exactly
NEGLIGIBLE_DRIFT = 0.01  # of the energy
SURE_DRIFT_SIGMAS = 5.0  # above this, a drift of any size counts
DRIFT_MEANS = 400  # number of means for the test of such a drift, within a factor of 2
ENERGY_ROUNDING = 1e-9  # of the energy; smaller drifts are rounding
CUT_SIGMAS = 3.0
PLATEAU_BLOCKS = 60
ORIGIN_SHIFT = 1 / 40  # of the range of s, added to s: bounds the smallest block from below
MINIMUM_PLATEAU_BLOCKS = 8
MINIMUM_GROWTH = 2.0
TRIM_SIGMAS = 3.0
EDGE_MARGIN = 0.2
CLEAR_EXCESS = 0.05  # of R
DRIFT_BOUND_SIGMAS = 2.0
MAXIMUM_R_DRIFT = 0.25  # of R
R_ROUNDING = 1e-12
BIMODAL_SIGMAS = 5.0
MINIMUM_GROUP_DISTANCE = 0.25  # of the mean
MINIMUM_REPLICAS = 4


class Drift(NamedTuple):
    """Change from the first to the last third of a series, over the mean of the last two thirds.

    `change` and its standard error are relative to this mean; `sigmas` is the change over its
    error, in sigma.
    """

    change: float
    stderr: float
    sigmas: float


def detect_start(*series: np.ndarray, planned: int = 0) -> int:
    """Return the index of the first sample, from `planned` on, after the transient of all `series`.

    Each has shape (samples,), and is cut after the index `planned` only if it shows a transient
    there.

    MSER-5 (White, Simulation 69, 323 (1997); White, Cobb & Spratt, Proc. Winter Simulation
    Conference (2000)): the truncation with the smallest sum (x - mean)^2/n^2, a squared standard
    error, of the remaining means of five samples. Hoad, Robinson & Davies, J. Oper. Res. Soc. 61,
    1389 (2010), chose it among 44 methods for automatic use. At most half of a series is cut: a
    longer transient is detected by `is_equilibrated`.

    In a series without a transient the minimum lies at a random position, after which the noise
    happens to be small, and errors would be understated by a fifth. So the means of the cut and of
    the remaining samples must differ by 3 sigma.
    """
    return max(_start_of(np.asarray(values, dtype=float), planned) for values in series)


def is_equilibrated(*series: np.ndarray, start: int = 0) -> bool:
    """Return whether energies, each of shape (samples,), are stationary from `start` on.

    Pass E_tr and E_rot of the whole run, and the index `start`. Each series must pass two tests:

    * From `start`/2 on, its `drift` must not exceed both 1 % and 3.5 sigma: a relaxation slow
      enough to bias the measurement is most visible there, since the fraction of it that remains at
      `start`/2 is the square root of the fraction at `start`. White or AR(1) series fail by chance
      about once in 1000 or less if their autocorrelation time is below a fiftieth of the stretch,
      once in 700 at a twentieth, in 200 at a tenth.
    * From `start` on, the drift must not exceed 5 sigma, however small it is. Spins that hardly
      relax drift slowly, and for long. Noise alone fails in up to 1.5 % of long runs.

    The absence of a drift is no evidence of a steady state if noise would hide a drift: theory
    decides whether a run is long enough (`errors.SampleSize`). Series with fewer than 12 samples
    count as not stationary.
    """
    return all(
        _is_stationary(values[start // 2 :], NEGLIGIBLE_DRIFT, ALARM_SIGMAS)
        and _is_stationary(_thinned(values[start:]), ENERGY_ROUNDING, SURE_DRIFT_SIGMAS)
        for values in (np.asarray(energy, dtype=float) for energy in series)
    )


def drift(series: np.ndarray) -> Drift:
    """Return the relative change from the first to the last third of a `series`, shape (samples,).

    It is relative to the mean of the last two thirds. A comparison like Geweke's (1992) of the
    first and the last samples of a chain. The noise is estimated by blocking the residuals of a
    straight line through the last two thirds, so that neither an early transient nor a steady trend
    counts as noise. `sigmas` accounts for the number of blocks (Student's t). Raises ValueError for
    fewer than 12 samples.
    """
    series = np.asarray(series, dtype=float)
    if len(series) < MINIMUM_SAMPLES:
        raise ValueError(f"{len(series)} samples: must be at least {MINIMUM_SAMPLES}")
    late, change, scale = _change_of_thirds(series)
    noise = blocking(late - _line_through(late))
    # Factor 2: the error is for one third instead of two, and for a difference of two such means.
    # Square root: the slope was fitted to the same data.
    stderr = 2 * noise.stderr * np.sqrt(noise.blocks / (noise.blocks - 1))
    if stderr == 0:
        return Drift(change / scale, 0.0, np.inf if change else 0.0)
    # Overlapping blocks have 1.5 times the degrees of freedom of disjoint blocks.
    degrees_of_freedom = max(1.0, 1.5 * (noise.blocks - 1) - 1)
    sigmas = float(wallace_sigmas(abs(change) / stderr, degrees_of_freedom))
    return Drift(change / scale, stderr / scale, sigmas)


def _change_of_thirds(series):
    """Return the last two thirds of a series, the change of the mean of its thirds, and the scale.

    The change is from the first third to the last, in the unit of the series. Its scale is the size
    of the mean of the last two thirds, or 1 if that vanishes.
    """
    third = len(series) // 3
    early, late = series[:third], series[-2 * third :]
    return late, late[third:].mean() - early.mean(), abs(late.mean()) or 1.0


def _line_through(series: np.ndarray) -> np.ndarray:
    """Return the values of a straight line fitted to a series (samples,)."""
    position = np.arange(len(series)) - (len(series) - 1) / 2
    return series.mean() + (position * series).sum() / (position**2).sum() * position


def _thinned(series: np.ndarray) -> np.ndarray:
    """Return means over blocks of equal length: DRIFT_MEANS to twice as many if samples suffice.

    `series` has shape (samples,). Blocking accounts for the correlation between these means.
    """
    return period_means(series, max(1, len(series) // DRIFT_MEANS)) if len(series) else series


def _is_stationary(series: np.ndarray, negligible: float, alarm: float) -> bool:
    """Return whether the drift of a series is at most `negligible`, or at most `alarm` sigma.

    `series` has shape (samples,), `negligible` is relative to its mean. False below 12 samples.
    """
    if len(series) < MINIMUM_SAMPLES:
        return False
    _, change, scale = _change_of_thirds(series)
    # the noise takes time, so it is computed for large changes only; comparisons with NaN are false
    return bool(abs(change / scale) <= negligible or drift(series).sigmas <= alarm)


def _start_of(series: np.ndarray, planned: int) -> int:
    """Return the index of the first sample after the transient of a series, `planned` or later."""
    start = _mser_start(series)
    if start <= planned or cut_sigmas(series[planned:], start - planned) < CUT_SIGMAS:
        return planned
    return start


def cut_sigmas(series: np.ndarray, cut: int) -> float:
    """Return the difference, in sigma, of the means of the first `cut` and of the later samples.

    The noise is estimated by blocking the later samples around a straight line, as in `drift`.
    `series` has shape (samples,), 0 < cut < samples.
    """
    early, late = series[:cut], series[cut:]
    residuals = late - _line_through(late)
    noise = blocking(residuals)
    variance = noise.stderr**2 * noise.blocks / max(noise.blocks - 1, 1.0)
    # The mean of a stretch shorter than the correlation scatters no more than a single sample.
    early_variance = min(variance * len(late) / cut, float(residuals.var()))
    difference = abs(early.mean() - late.mean())
    if not variance + early_variance > 0:
        return np.inf if difference > 0 else 0.0
    t = difference / np.sqrt(variance + early_variance)
    return float(wallace_sigmas(t, max(1.0, degrees_of_freedom(noise.blocks) - 1)))


def _mser_start(series: np.ndarray) -> int:
    """Return the index of the first sample after the truncation by MSER-5, see `detect_start`."""
    batches = len(series) // SAMPLES_PER_BATCH
    if batches < 2:
        return 0
    # an incomplete batch at the front is omitted
    means = (
        series[-SAMPLES_PER_BATCH * batches :]
        .reshape(batches, SAMPLES_PER_BATCH)
        .mean(axis=1)[::-1]
    )
    kept_batches = np.arange(1, batches + 1)
    scatter = np.cumsum((means - means[0]) ** 2) - np.cumsum(means - means[0]) ** 2 / kept_batches
    statistic = (scatter / kept_batches**2)[batches - batches // 2 - 1 :]
    cut_batches = int(np.argmin(statistic[::-1]))
    return cut_batches * SAMPLES_PER_BATCH + len(series) % SAMPLES_PER_BATCH * (cut_batches > 0)


class Plateau(NamedTuple):
    """Plateau of R, the share of rotational energy: its first and last sample, and the mean.

    `start` and `stop` are in collisions per particle; `stderr` is the standard error of the mean,
    `per_replica` (replicas,) has the mean of each replica, and `exists` is False if no plateau was
    detected.
    """

    start: float
    stop: float
    mean: float
    stderr: float
    per_replica: np.ndarray
    exists: bool


EdgeIndex = int | np.ndarray  # index of an edge between blocks, or an array of indices


class BlockSums(NamedTuple):
    """Sums of R over all samples before each edge, shape (replicas, edges), and the edges.

    Edges are indices of samples, at the ends of blocks.
    """

    sums: np.ndarray
    edges: np.ndarray


def find_plateau(
    collisions_per_particle: np.ndarray, R: np.ndarray, minimum_start: float = 0.0
) -> Plateau:
    """Return the plateau of the share `R` of rotational energy, shape (replicas, samples).

    `collisions_per_particle` (samples,) is the scale of the samples, which are evenly spaced, and
    of `minimum_start`. The plateau begins at `minimum_start` or later: pass a few relaxation times
    of theory. `per_replica` (replicas,) has the means of the replicas in the window, `mean` is
    their mean, and `stderr` follows from their spread. `exists` is False if no plateau is detected;
    then the last third of the samples is reported, even if it begins before `minimum_start`. It is
    False, too, for a plateau of a mixture of replicas. Raises ValueError for fewer than two
    replicas.
    """
    s, R = np.asarray(collisions_per_particle, dtype=float), np.asarray(R, dtype=float)
    if R.ndim != 2 or len(R) < 2 or R.shape[1] != len(s):
        raise ValueError(f"R of shape {R.shape}: must be (2 or more replicas, {len(s)} samples)")
    window = _plateau_window(
        R, s + ORIGIN_SHIFT * np.ptp(s), int(np.searchsorted(s, minimum_start))
    )
    start, stop = window or (len(s) - max(1, len(s) // 3), len(s))
    per_replica = R[:, start:stop].mean(axis=1)
    mean, stderr = (float(value) for value in _mean_and_stderr(per_replica))
    exists = window is not None and not is_bimodal(per_replica)
    return Plateau(float(s[start]), float(s[stop - 1]), mean, stderr, per_replica, exists)


def _plateau_window(R: np.ndarray, s: np.ndarray, first: int) -> tuple[int, int] | None:
    """Return the plateau of R as samples [start, stop) from `first` on, or None.

    R has shape (replicas, samples); `s` > 0 (samples,) are collisions per particle, shifted.
    """
    if len(s) - first < MINIMUM_PLATEAU_BLOCKS:
        return None
    block_starts = np.geomspace(s[first], s[-1], PLATEAU_BLOCKS + 1)[:-1] * (1 - R_ROUNDING)
    edges = np.append(np.unique(np.searchsorted(s, block_starts)), len(s))
    sums = np.concatenate([np.zeros((len(R), 1)), np.cumsum(R, axis=1)], axis=1)
    blocks = BlockSums(sums[:, edges], edges)
    stops = _stationary_stops(blocks)
    growth = np.where(stops > 0, s[edges[stops] - 1] / s[edges[:-1]], 0.0)
    growth[1:][growth[1:] < MINIMUM_GROWTH] = 0.0
    for start in np.argsort(-growth, kind="stable")[: np.count_nonzero(growth)]:
        begin, end = _trimmed(blocks, int(start), int(stops[start]))
        window = _with_margin(edges, begin, end)
        if _drift_is_small(R[:, edges[begin] : edges[end]]) and not _is_exceeded_outside(
            R, *window
        ):
            return window
    return None


def _stationary_stops(blocks: BlockSums) -> np.ndarray:
    """Return the final edge of the longest stationary window from each block; 0 for none.

    Edges are counted from 0; the result has shape (blocks,).
    """
    last = len(blocks.edges) - 1
    starts, stops = np.arange(last - MINIMUM_PLATEAU_BLOCKS + 1), np.zeros(last, int)
    to_the_end = _are_stationary(blocks, starts, last)
    stops[starts[to_the_end]] = last
    for start in starts[~to_the_end]:
        ends = np.arange(start + MINIMUM_PLATEAU_BLOCKS, last)
        stops[start] = ends[_are_stationary(blocks, start, ends)].max(initial=0)
    return stops


def _are_stationary(blocks: BlockSums, start: EdgeIndex, stop: EdgeIndex) -> np.ndarray:
    """Return whether windows of blocks [start, stop) have no end that deviates by ALARM_SIGMAS."""
    return np.maximum(*_edge_sigmas(blocks, start, stop)) < ALARM_SIGMAS


def _trimmed(blocks: BlockSums, start: int, stop: int) -> tuple[int, int]:
    """Return the window of blocks [start, stop) without deviating blocks at its ends.

    The ends depart from the rest by TRIM_SIGMAS or more; MINIMUM_PLATEAU_BLOCKS are kept.
    """
    while stop - start > MINIMUM_PLATEAU_BLOCKS:
        at_start, at_stop = _edge_sigmas(blocks, start, stop)
        if max(at_start, at_stop) < TRIM_SIGMAS:
            break
        start, stop = (start + 1, stop) if at_start > at_stop else (start, stop - 1)
    return start, stop


def _with_margin(edges: np.ndarray, start: int, stop: int) -> tuple[int, int]:
    """Return the window of blocks [start, stop) as samples, less a margin at ends inside the data.

    `edges` are the indices of the samples at the ends of blocks.
    """
    margin = round(EDGE_MARGIN * (edges[stop] - edges[start]))
    at_stop = stop < len(edges) - 1
    return int(edges[start] + margin * (start > 0)), int(edges[stop] - margin * at_stop)


def _edge_sigmas(
    blocks: BlockSums, start: EdgeIndex, stop: EdgeIndex
) -> tuple[np.ndarray, np.ndarray]:
    """Return the largest deviations, in sigma, of the first and of the last 1, 2, 4, ... blocks.

    They deviate from the rest of the window of blocks [start, stop).
    """
    start, stop = np.asarray(start)[..., np.newaxis], np.asarray(stop)[..., np.newaxis]
    widths = np.minimum(2 ** np.arange(PLATEAU_BLOCKS.bit_length()), (stop - start) // 2)
    off_early = _sigmas(_contrasts(blocks, start, start + widths, stop))
    off_late = _sigmas(_contrasts(blocks, start, stop - widths, stop))
    return off_early.max(axis=-1), off_late.max(axis=-1)


def _contrasts(
    blocks: BlockSums, start: np.ndarray, split: np.ndarray, stop: np.ndarray
) -> np.ndarray:
    """Return means (replicas, ...) over blocks [split, stop) less means over [start, split)."""
    sums, edges = blocks
    start, split, stop = np.broadcast_arrays(start, split, stop)
    before = sums[:, start]
    early = sums[:, split] - before
    late = sums[:, stop] - before - early
    return late / (edges[stop] - edges[split]) - early / (edges[split] - edges[start])


def _drift_is_small(R: np.ndarray) -> bool:
    """Return whether the drift of R (replicas, samples) is at most MAXIMUM_R_DRIFT of its mean.

    The drift is the difference of the last and the first third, and DRIFT_BOUND_SIGMAS of its error
    are added.
    """
    third = max(1, R.shape[1] // 3)
    change, stderr = _mean_and_stderr(R[:, -third:].mean(axis=1) - R[:, :third].mean(axis=1))
    upper_bound = abs(change) + wallace_t(DRIFT_BOUND_SIGMAS, len(R) - 1) * stderr
    return bool(upper_bound <= MAXIMUM_R_DRIFT * R.mean())


def _is_exceeded_outside(R: np.ndarray, start: int, stop: int) -> bool:
    """Return whether R before or after the samples [start, stop) clearly exceeds its mean in them.

    R (replicas, samples) is averaged over tenths of the samples before, and of the samples after.
    """
    level = R[:, start:stop].mean(axis=1)
    outside = np.array_split(R[:, :start], 10, axis=1) + np.array_split(R[:, stop:], 10, axis=1)
    excess = [stretch.mean(axis=1) - level for stretch in outside if stretch.shape[1] > 0]
    minimum_excess = CLEAR_EXCESS * level.mean()
    return any(
        difference.mean() > minimum_excess and _sigmas(difference) > ALARM_SIGMAS
        for difference in excess
    )


def _sigmas(values: np.ndarray) -> np.ndarray:
    """Return the distance from 0, in sigma, of the means of `values` over the first axis.

    The first axis has independent replicas, whose spread is the noise.
    """
    mean, stderr = _mean_and_stderr(values)
    return wallace_sigmas(np.abs(mean) / np.maximum(stderr, R_ROUNDING), len(values) - 1)


def _mean_and_stderr(values: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return mean and standard error of `values` over replicas, the first axis."""
    return values.mean(axis=0), values.std(axis=0, ddof=1) / np.sqrt(len(values))


def is_bimodal(values: np.ndarray) -> bool:
    """Return whether the means of replicas fall into two groups.

    `values` >= 0 (replicas,) are the means. False for fewer than MINIMUM_REPLICAS.
    """
    values = np.sort(np.asarray(values, dtype=float))
    if len(values) < MINIMUM_REPLICAS:
        return False
    distances, sigmas = _split_distances(values)
    return bool(
        np.any((sigmas > BIMODAL_SIGMAS) & (distances > MINIMUM_GROUP_DISTANCE * values.mean()))
    )


def _split_distances(values: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the distance of the groups at each split of sorted `values`, and its significance.

    Both have shape (replicas - 1,); the significance is in sigma.
    """
    number = len(values)
    below = np.arange(1, number)
    sums, squares = np.cumsum(values), np.cumsum(values**2)
    low, high = sums[:-1] / below, (sums[-1] - sums[:-1]) / (number - below)
    sum_of_squares = squares[-1] - below * low**2 - (number - below) * high**2
    # equal values leave the rounding of the sums
    scatter = np.sqrt(np.maximum(sum_of_squares, np.finfo(float).eps * squares[-1]) / (number - 2))
    distance = high - low
    positive_scatter = np.where(scatter > 0.0, scatter, 1.0)
    return distance, wallace_sigmas(distance / positive_scatter, number - 2)
