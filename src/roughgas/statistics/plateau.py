"""The plateau of R in a freely cooling gas, found from an ensemble of replicas.

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
5. Where replicas rest at two different R (`bimodal`), their mean is no state of the gas: the window
   is reported, but does not count as a plateau.

On synthetic ensembles (relaxation in 4 to 60 collisions per particle, 10 to 60 replicas, series of
50 to 800 samples, with and without a departure) the bias is below 0.7 of the standard error, and
the 95 % interval holds the truth in 94 % of the cases, or in 87 % if `minimum_start` is only three
relaxation times or a plateau lasts only twenty. About ten replicas are needed, and a series of ten
relaxation times or a `minimum_start` of a few: a slower relaxation hides in the noise.
"""

from typing import NamedTuple

import numpy as np

from roughgas.statistics.bimodal import is_bimodal
from roughgas.statistics.errors import gaussian_sigmas, student_t

BLOCKS = 60
ORIGIN = 1 / 40  # of all samples, added to s: no block is shorter than a few per mille of them
SHORTEST_PLATEAU = 8  # blocks
SHORTEST_GROWTH = 2.0
ALARM_SIGMAS = 3.5
TRIM_SIGMAS = 3.0
MARGIN = 0.2
CLEAR_EXCESS = 0.05  # of R
BOUND_SIGMAS = 2.0
LARGEST_DRIFT = 0.25  # of R
ROUNDING = 1e-12  # R is not known better than this


class Plateau(NamedTuple):
    """Where R rests, in collisions per particle: from the sample `start` to `stop`, inclusive."""

    start: float
    stop: float
    mean: float
    stderr: float
    per_replica: np.ndarray
    found: bool


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
    stops = np.array([_last_stationary_stop(blocks, start) for start in range(len(edges) - 1)])
    growth = np.where(stops > 0, s[edges[stops] - 1] / s[edges[:-1]], 0.0)
    growth[1:][growth[1:] < SHORTEST_GROWTH] = 0.0
    for start in np.argsort(-growth, kind="stable")[: np.count_nonzero(growth)]:
        begin, end = _trimmed(blocks, int(start), int(stops[start]))
        window = _with_margin(edges, begin, end)
        if _drift_is_small(R[:, edges[begin] : edges[end]]) and not _is_exceeded(R, *window):
            return window
    return None


def _last_stationary_stop(blocks: BlockSums, start: int) -> int:
    """Return the edge at which the longest stationary window from `start` ends; 0 for none."""
    stops = np.arange(start + SHORTEST_PLATEAU, len(blocks.edges))
    stationary = np.maximum(*_edge_sigmas(blocks, start, stops)) < ALARM_SIGMAS
    return int(stops[stationary].max(initial=0))


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


def _edge_sigmas(
    blocks: BlockSums, start: int, stops: np.ndarray | int
) -> tuple[np.ndarray, np.ndarray]:
    """Return the most sigma by which the first, and the last, 1, 2, 4, ... blocks are off."""
    stops = np.asarray(stops)[..., np.newaxis]
    widths = np.minimum(2 ** np.arange(BLOCKS.bit_length()), (stops - start) // 2)
    off_early = _sigmas(_contrasts(blocks, start, start + widths, stops))
    off_late = _sigmas(_contrasts(blocks, start, stops - widths, stops))
    return off_early.max(axis=-1), off_late.max(axis=-1)


def _contrasts(blocks: BlockSums, start: int, split: np.ndarray, stop: np.ndarray) -> np.ndarray:
    """Return means over blocks [split, stop) less those over [start, split): (replicas, ...)."""
    sums, edges = blocks
    sums = sums - sums[:, [start]]
    late = (sums[:, stop] - sums[:, split]) / (edges[stop] - edges[split])
    return late - sums[:, split] / (edges[split] - edges[start])


def _drift_is_small(R: np.ndarray) -> bool:
    third = max(1, R.shape[1] // 3)
    change, stderr = _mean_and_stderr(R[:, -third:].mean(axis=1) - R[:, :third].mean(axis=1))
    bound = abs(change) + student_t(BOUND_SIGMAS, len(R) - 1) * stderr
    return bool(bound <= LARGEST_DRIFT * R.mean())


def _is_exceeded(R: np.ndarray, start: int, stop: int) -> bool:
    """Return whether R is clearly above its mean in the window in a tenth before or after it."""
    level = R[:, start:stop].mean(axis=1)
    outside = np.array_split(R[:, :start], 10, axis=1) + np.array_split(R[:, stop:], 10, axis=1)
    excess = [part.mean(axis=1) - level for part in outside if part.shape[1] > 0]
    return any(
        one.mean() > CLEAR_EXCESS * level.mean() and _sigmas(one) > ALARM_SIGMAS for one in excess
    )


def _sigmas(values: np.ndarray) -> np.ndarray:
    """Return by how many sigma the means of `values`, shape (replicas, ...), differ from 0."""
    mean, stderr = _mean_and_stderr(values)
    return gaussian_sigmas(np.abs(mean) / np.maximum(stderr, ROUNDING), len(values) - 1)


def _mean_and_stderr(values: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    return values.mean(axis=0), values.std(axis=0, ddof=1) / np.sqrt(len(values))
