"""When a gas is in a steady state: driven gases, plateaus of cooling ones, and mixtures of states.

**Driven gases.** The end of the transient, and whether a run has reached its steady state, are
judged from series of energies (period means for a vibrated bed, see `errors.period_means`), not
from R, which may already be right while both energies still drift. The rotational energy is the
slowest signal near beta = -1.

**Cooling gases.** The plateau of R in a freely cooling gas, found from an ensemble of replicas.

From spin 0, R rises to its plateau. Later, in large or very dissipative systems, shear modes and
clusters add energy of flow to E_tr, and R falls for good. Neither scale is known beforehand, and
one replica is too noisy to show them, so both ends are found from the ensemble, as Welch's method
does for the warm-up of replicated simulations. The noise is the spread between replicas, which are
independent, so no autocorrelation along s, the collisions per particle, is needed:

1. The samples are divided into about 60 blocks, nearly even in log s, as the scales of transient
   and departure may lie far apart. A window of blocks is stationary if, at either end, no stretch
   of 1, 2, 4, ... blocks up to half of it departs from the rest by 3.5 sigma.
2. From each block the longest stationary window is taken, if it at least doubles s (so that it
   outlasts the transient before it) or begins where a plateau may at the earliest.
3. Both ends are trimmed until no stretch departs by 3 sigma. (At 2 sigma noise alone would have
   every fourth window trimmed, and the error understated by a seventh.) An end found inside the
   data then gives up another fifth of the window, because a transient at the limit of detection
   would still bias the mean by about its standard error.
4. Of these windows, the plateau is the one that multiplies s by most, leaving out those that drift
   (the last third must differ from the first by less than a quarter of R, at 2 sigma) and those
   that R exceeds elsewhere, by 5 % and 3.5 sigma in a tenth of what is before or after: a pause on
   the way up, or a later plateau where flow dominates.
5. Where replicas rest at two different R (`is_bimodal`), their mean is no state of the gas: the
   window is reported, but does not count as a plateau.

On synthetic ensembles (relaxation in 4 to 60 collisions per particle, 10 to 60 replicas, series of
50 to 800 samples, with and without a departure) the bias is below 0.7 of the standard error, and
the 95 % interval holds the truth in 94 % of the cases, or in 87 % if `minimum_start` is only three
relaxation times or a plateau lasts only twenty. About ten replicas are needed, and a series of ten
relaxation times or a `minimum_start` of a few: a slower relaxation hides in the noise.

**Mixtures.** Whether an ensemble of replicas is a mixture: some have left for another state.

The replicas' means are sorted, and split in two at each gap. Were a split given beforehand, the
distance of its two groups over the scatter within them would tell. The best of all splits reaches
about 3 in a Gaussian ensemble, whatever its size. An ensemble is called bimodal if one of them
reaches 5 sigma (those of a Gaussian that are as improbable as Student's t with n - 2 degrees of
freedom), and if its groups are a quarter of the mean apart.

Of 400 000 synthetic ensembles of 10, 20, 40 or 60 replicas, up to 6 in 100 000 Gaussian ones reach
5 sigma, and up to 2 and 7 in 100 skewed or long-tailed ones (gamma distribution of shape 4,
Student's t of 5 degrees of freedom). The second condition lets nearly all of these pass: where
replicas scatter by 3 % of R, less than 1 in 1000 and 1 in 100 are still called bimodal. Of mixtures
in which a replica, a quarter or half of them are displaced, nine tenths are found from a
displacement of 8 standard deviations of a replica on (40 and 60 replicas), 10 (20 replicas) or 20
(10 replicas).
"""

from typing import NamedTuple

import numpy as np

from roughgas.statistics.errors import (
    blocking,
    degrees_of_freedom,
    gaussian_sigmas,
    period_means,
    student_t,
)

MSER_BATCH = 5
SHORTEST_SERIES = 12
ALARM_SIGMAS = 3.5  # one false alarm in 2000 if the noise were known exactly
NEGLIGIBLE_DRIFT = 0.01  # of the energy
SURE_SIGMAS = 5.0  # of a drift that counts however small it is
MOST_MEANS = 400  # that this drift is sought in
ROUNDING_OF_ENERGY = 1e-9  # of the energy: a drift below this is none
CUT_SIGMAS = 3.0
BLOCKS = 60
ORIGIN = 1 / 40  # of all samples, added to s: no block is shorter than a few per mille of them
SHORTEST_PLATEAU = 8  # blocks
SHORTEST_GROWTH = 2.0
TRIM_SIGMAS = 3.0
MARGIN = 0.2
CLEAR_EXCESS = 0.05  # of R
BOUND_SIGMAS = 2.0
LARGEST_DRIFT_OF_R = 0.25  # of R
ROUNDING = 1e-12  # R is not known better than this
BIMODAL_SIGMAS = 5.0
APART = 0.25  # of the mean
FEWEST = 4  # replicas


class Drift(NamedTuple):
    """Change from the first to the last third of a series, relative to the mean of the last two."""

    change: float
    stderr: float
    sigmas: float


def detect_start(*series: np.ndarray, planned: int = 0) -> int:
    """Return the index of the first sample, from `planned` on, after the transient of all `series`.

    Each has shape (samples,), and is cut later than planned only if it shows a transient there.

    MSER-5 (White, Simulation 69, 323 (1997); White, Cobb & Spratt, Proc. Winter Simulation
    Conference (2000)): of all truncations, the one that leaves the smallest sum (x - mean)^2/n^2,
    a squared standard error, on means of five samples. Hoad, Robinson & Davies, J. Oper. Res. Soc.
    61, 1389 (2010), chose it among 44 methods for automatic use. At most half of a series is cut:
    if that is the answer, the transient may not be over, as `is_equilibrated` will tell.

    In a series without a transient the minimum lies where the noise happens to be small: errors
    would be understated by a fifth after such a cut. So what is cut must differ from what is left
    by 3 sigma in its mean.
    """
    return max(_start(np.asarray(one, dtype=float), planned) for one in series)


def is_equilibrated(*series: np.ndarray, start: int = 0) -> bool:
    """Return whether energies, each of shape (samples,), are stationary from `start` on.

    Pass E_tr and E_rot of the whole run, and the index `start`. Each series must pass two tests:

    * From `start`/2 on, its `drift` must not exceed both 1 % and 3.5 sigma: a relaxation slow
      enough to bias the measurement is seen best there, since the fraction of it that is left at
      `start`/2 is the root of that left at `start`. White or AR(1) series fail by chance about once
      in 1000 or less if their autocorrelation time is below a fiftieth of the stretch, once in 700
      at a twentieth, in 200 at a tenth.
    * From `start` on, it must not exceed 5 sigma, however small it is. Spins that hardly relax
      drift by little, and for long. Noise alone fails in up to 1.5 % of long runs.

    That nothing drifts is no evidence of a steady state where noise would hide a drift: whether a
    run is long enough is for theory to say (`errors.Evidence`). Series that leave fewer than 12
    samples are not stationary as far as they show.
    """
    return all(
        _is_stationary(values[start // 2 :], NEGLIGIBLE_DRIFT, ALARM_SIGMAS)
        and _is_stationary(_thinned(values[start:]), ROUNDING_OF_ENERGY, SURE_SIGMAS)
        for values in (np.asarray(energy, dtype=float) for energy in series)
    )


def drift(series: np.ndarray) -> Drift:
    """Return the change from the first to the last third of a `series`, shape (samples,).

    Geweke (1992) compares the first and the last part of a chain in this way. Here the noise is
    from blocking the residuals of a straight line through the last two thirds, so that neither an
    early transient nor a steady trend counts as noise. `sigmas` accounts for the number of blocks
    (Student's t). Raises ValueError for fewer than 12 samples.
    """
    series = np.asarray(series, dtype=float)
    if len(series) < SHORTEST_SERIES:
        raise ValueError(f"{len(series)} samples: must be at least {SHORTEST_SERIES}")
    late, change, scale = _change(series)
    noise = blocking(late - _line_through(late))
    # 2: the error is for one third instead of two, and for a difference of two such means.
    # The root: the slope was fitted to the same data.
    stderr = 2 * noise.stderr * np.sqrt(noise.blocks / (noise.blocks - 1))
    if stderr == 0:
        return Drift(change / scale, 0.0, np.inf if change else 0.0)
    # Overlapping blocks are worth 1.5 times as many degrees of freedom as disjoint ones.
    degrees_of_freedom = max(1.0, 1.5 * (noise.blocks - 1) - 1)
    sigmas = float(gaussian_sigmas(abs(change) / stderr, degrees_of_freedom))
    return Drift(change / scale, stderr / scale, sigmas)


def _change(series):
    """Return the last two thirds, their change from the first third, and the scale of both."""
    third = len(series) // 3
    early, late = series[:third], series[-2 * third :]
    return late, late[third:].mean() - early.mean(), abs(late.mean()) or 1.0


def _line_through(series: np.ndarray) -> np.ndarray:
    position = np.arange(len(series)) - (len(series) - 1) / 2
    return series.mean() + (position * series).sum() / (position**2).sum() * position


def _thinned(series: np.ndarray) -> np.ndarray:
    """Return means over as many samples as leave MOST_MEANS of them, or fewer than twice as many.

    Correlation between such means is part of what blocking finds; that within them is averaged.
    """
    return period_means(series, max(1, len(series) // MOST_MEANS)) if len(series) else series


def _is_stationary(series: np.ndarray, negligible: float, alarm: float) -> bool:
    """Return whether a series does not drift by more than `negligible` and `alarm` sigma."""
    if len(series) < SHORTEST_SERIES:
        return False
    _, change, scale = _change(series)
    # the noise takes time, and is wanted of few series; both comparisons are false of NaN
    return bool(abs(change / scale) <= negligible or drift(series).sigmas <= alarm)


def _start(series: np.ndarray, planned: int) -> int:
    found = _mser_start(series)
    if found <= planned or cut_sigmas(series[planned:], found - planned) < CUT_SIGMAS:
        return planned
    return found


def cut_sigmas(series: np.ndarray, cut: int) -> float:
    """Return by how many sigma the mean of the first `cut` samples differs from that of all others.

    The noise is that of the others around a straight line, by blocking, as in `drift`. `series` has
    shape (samples,), 0 < cut < samples.
    """
    early, late = series[:cut], series[cut:]
    residuals = late - _line_through(late)
    noise = blocking(residuals)
    variance = noise.stderr**2 * noise.blocks / max(noise.blocks - 1, 1.0)
    # A stretch shorter than the correlation scatters no more than a single sample.
    own = min(variance * len(late) / cut, float(residuals.var()))
    difference = abs(early.mean() - late.mean())
    if not variance + own > 0:
        return np.inf if difference > 0 else 0.0
    t = difference / np.sqrt(variance + own)
    return float(gaussian_sigmas(t, max(1.0, degrees_of_freedom(noise.blocks) - 1)))


def _mser_start(series: np.ndarray) -> int:
    batches = len(series) // MSER_BATCH
    if batches < 2:
        return 0
    # an incomplete batch at the front is left out
    means = series[-MSER_BATCH * batches :].reshape(batches, MSER_BATCH).mean(axis=1)[::-1]
    kept = np.arange(1, batches + 1)
    scatter = np.cumsum((means - means[0]) ** 2) - np.cumsum(means - means[0]) ** 2 / kept
    statistic = (scatter / kept**2)[batches - batches // 2 - 1 :]
    cut = int(np.argmin(statistic[::-1]))
    return cut * MSER_BATCH + len(series) % MSER_BATCH * (cut > 0)


class Plateau(NamedTuple):
    """Where R rests, in collisions per particle: from the sample `start` to `stop`, inclusive."""

    start: float
    stop: float
    mean: float
    stderr: float
    per_replica: np.ndarray
    found: bool


Edges = int | np.ndarray  # one edge between blocks by its number, or several


class BlockSums(NamedTuple):
    """Sums of R over all samples before each edge, shape (replicas, edges), and the edges."""

    sums: np.ndarray
    edges: np.ndarray


def find_plateau(
    collisions_per_particle: np.ndarray, R: np.ndarray, minimum_start: float = 0.0
) -> Plateau:
    """Return the plateau of `R`, shape (replicas, samples), over evenly spaced samples.

    It begins at `minimum_start` at the earliest: pass a few relaxation times of theory. `mean` is
    over replicas, of their means in the window, `per_replica` of shape (replicas,), and `stderr`
    comes from their spread. `found` is False if there is no plateau; the last third of the samples
    is reported then, even if it begins before `minimum_start`. It is False, too, for a plateau of a
    mixture of replicas. Raises ValueError for fewer than two replicas.
    """
    s, R = np.asarray(collisions_per_particle, dtype=float), np.asarray(R, dtype=float)
    if R.ndim != 2 or len(R) < 2 or R.shape[1] != len(s):
        raise ValueError(f"R of shape {R.shape}: must be (2 or more replicas, {len(s)} samples)")
    window = _window(R, s + ORIGIN * np.ptp(s), int(np.searchsorted(s, minimum_start)))
    start, stop = window or (len(s) - max(1, len(s) // 3), len(s))
    per_replica = R[:, start:stop].mean(axis=1)
    mean, stderr = (float(value) for value in _mean_and_stderr(per_replica))
    found = window is not None and not is_bimodal(per_replica)
    return Plateau(float(s[start]), float(s[stop - 1]), mean, stderr, per_replica, found)


def _window(R: np.ndarray, s: np.ndarray, first: int) -> tuple[int, int] | None:
    """Return the plateau as samples [start, stop) from `first` on, or None; `s` > 0."""
    if len(s) - first < SHORTEST_PLATEAU:
        return None
    even = np.geomspace(s[first], s[-1], BLOCKS + 1)[:-1] * (1 - ROUNDING)
    edges = np.append(np.unique(np.searchsorted(s, even)), len(s))
    sums = np.concatenate([np.zeros((len(R), 1)), np.cumsum(R, axis=1)], axis=1)
    blocks = BlockSums(sums[:, edges], edges)
    stops = _stationary_stops(blocks)
    growth = np.where(stops > 0, s[edges[stops] - 1] / s[edges[:-1]], 0.0)
    growth[1:][growth[1:] < SHORTEST_GROWTH] = 0.0
    for start in np.argsort(-growth, kind="stable")[: np.count_nonzero(growth)]:
        begin, end = _trimmed(blocks, int(start), int(stops[start]))
        window = _with_margin(edges, begin, end)
        if _drift_is_small(R[:, edges[begin] : edges[end]]) and not _is_exceeded(R, *window):
            return window
    return None


def _stationary_stops(blocks: BlockSums) -> np.ndarray:
    """Return the edge at which the longest stationary window from each start ends; 0 for none."""
    last = len(blocks.edges) - 1
    starts, stops = np.arange(last - SHORTEST_PLATEAU + 1), np.zeros(last, int)
    to_the_end = _are_stationary(blocks, starts, last)
    stops[starts[to_the_end]] = last
    for start in starts[~to_the_end]:
        ends = np.arange(start + SHORTEST_PLATEAU, last)
        stops[start] = ends[_are_stationary(blocks, start, ends)].max(initial=0)
    return stops


def _are_stationary(blocks: BlockSums, start: Edges, stop: Edges) -> np.ndarray:
    return np.maximum(*_edge_sigmas(blocks, start, stop)) < ALARM_SIGMAS


def _trimmed(blocks: BlockSums, start: int, stop: int) -> tuple[int, int]:
    """Return the window without the blocks at its ends that depart from it by TRIM_SIGMAS."""
    while stop - start > SHORTEST_PLATEAU:
        at_start, at_stop = _edge_sigmas(blocks, start, stop)
        if max(at_start, at_stop) < TRIM_SIGMAS:
            break
        start, stop = (start + 1, stop) if at_start > at_stop else (start, stop - 1)
    return start, stop


def _with_margin(edges: np.ndarray, start: int, stop: int) -> tuple[int, int]:
    """Return the window as samples, less a margin at ends inside the data."""
    margin = round(MARGIN * (edges[stop] - edges[start]))
    at_stop = stop < len(edges) - 1
    return int(edges[start] + margin * (start > 0)), int(edges[stop] - margin * at_stop)


def _edge_sigmas(blocks: BlockSums, start: Edges, stop: Edges) -> tuple[np.ndarray, np.ndarray]:
    """Return the most sigma by which the first, and the last, 1, 2, 4, ... blocks are off."""
    start, stop = np.asarray(start)[..., np.newaxis], np.asarray(stop)[..., np.newaxis]
    widths = np.minimum(2 ** np.arange(BLOCKS.bit_length()), (stop - start) // 2)
    off_early = _sigmas(_contrasts(blocks, start, start + widths, stop))
    off_late = _sigmas(_contrasts(blocks, start, stop - widths, stop))
    return off_early.max(axis=-1), off_late.max(axis=-1)


def _contrasts(
    blocks: BlockSums, start: np.ndarray, split: np.ndarray, stop: np.ndarray
) -> np.ndarray:
    """Return means over blocks [split, stop) less those over [start, split): (replicas, ...)."""
    sums, edges = blocks
    start, split, stop = np.broadcast_arrays(start, split, stop)
    before = sums[:, start]
    early = sums[:, split] - before
    late = sums[:, stop] - before - early
    return late / (edges[stop] - edges[split]) - early / (edges[split] - edges[start])


def _drift_is_small(R: np.ndarray) -> bool:
    third = max(1, R.shape[1] // 3)
    change, stderr = _mean_and_stderr(R[:, -third:].mean(axis=1) - R[:, :third].mean(axis=1))
    bound = abs(change) + student_t(BOUND_SIGMAS, len(R) - 1) * stderr
    return bool(bound <= LARGEST_DRIFT_OF_R * R.mean())


def _is_exceeded(R: np.ndarray, start: int, stop: int) -> bool:
    """Return whether R is clearly above its mean in the window in a tenth before or after it."""
    level = R[:, start:stop].mean(axis=1)
    outside = np.array_split(R[:, :start], 10, axis=1) + np.array_split(R[:, stop:], 10, axis=1)
    excess = [part.mean(axis=1) - level for part in outside if part.shape[1] > 0]
    least = CLEAR_EXCESS * level.mean()
    return any(one.mean() > least and _sigmas(one) > ALARM_SIGMAS for one in excess)


def _sigmas(values: np.ndarray) -> np.ndarray:
    """Return by how many sigma the means of `values`, shape (replicas, ...), differ from 0."""
    mean, stderr = _mean_and_stderr(values)
    return gaussian_sigmas(np.abs(mean) / np.maximum(stderr, ROUNDING), len(values) - 1)


def _mean_and_stderr(values: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    return values.mean(axis=0), values.std(axis=0, ddof=1) / np.sqrt(len(values))


def is_bimodal(values: np.ndarray) -> bool:
    """Return whether `values`, shape (replicas,), not negative, fall into two groups."""
    values = np.sort(np.asarray(values, dtype=float))
    if len(values) < FEWEST:
        return False
    distance, sigmas = _splits(values)
    return bool(np.any((sigmas > BIMODAL_SIGMAS) & (distance > APART * values.mean())))


def _splits(values: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the distance of the groups at each split of sorted `values`, and its significance."""
    number = len(values)
    below = np.arange(1, number)
    sums, squares = np.cumsum(values), np.cumsum(values**2)
    low, high = sums[:-1] / below, (sums[-1] - sums[:-1]) / (number - below)
    within = squares[-1] - below * low**2 - (number - below) * high**2
    # of equal values the rounding of the sums is left
    scatter = np.sqrt(np.maximum(within, np.finfo(float).eps * squares[-1]) / (number - 2))
    distance = high - low
    safe = np.where(scatter > 0.0, scatter, 1.0)
    return distance, gaussian_sigmas(distance / safe, number - 2)
