"""Where the transient of a driven gas ends, and whether a run has reached its steady state.

Both are judged from series of energies (period means for a vibrated bed, see
`averages.period_means`), not from R, which may already be right while both energies still drift.
The rotational energy is the slowest signal near beta = -1.
"""

from typing import NamedTuple

import numpy as np

from roughgas.statistics.errors import blocking, gaussian_sigmas
from roughgas.statistics.intervals import degrees_of_freedom

MSER_BATCH = 5
SHORTEST_SERIES = 12
ALARM_SIGMAS = 3.5  # one false alarm in 2000 if the noise were known exactly
NEGLIGIBLE_DRIFT = 0.01  # of the energy
LARGEST_DRIFT = 0.5
CUT_SIGMAS = 3.0


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

    Pass E_tr and E_rot of the whole run, and the index `start`. The test begins at `start`/2: a
    relaxation slow enough to bias the measurement is seen best there, since the fraction of it that
    is left at `start`/2 is the root of that left at `start`. Each series must pass two tests of its
    `drift` over that stretch:

    * It must not drift by more than 1 % and 3.5 sigma. White or AR(1) series fail by chance about
      once in 1000 or less if their autocorrelation time is below a fiftieth of the stretch, once
      in 700 at a twentieth, in 200 at a tenth.
    * Its drift plus 2 standard errors must lie below half the energy: noise does not pass for
      equilibrium.

    Series that leave fewer than 12 samples are not stationary as far as they show.
    """
    return all(_is_stationary(np.asarray(one, dtype=float)[start // 2 :]) for one in series)


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
    third = len(series) // 3
    early, late = series[:third], series[-2 * third :]
    change = late[third:].mean() - early.mean()
    scale = abs(late.mean()) or 1.0
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


def _line_through(series: np.ndarray) -> np.ndarray:
    position = np.arange(len(series)) - (len(series) - 1) / 2
    return series.mean() + (position @ series) / (position @ position) * position


def _is_stationary(series: np.ndarray) -> bool:
    if len(series) < SHORTEST_SERIES:
        return False
    change, stderr, sigmas = drift(series)
    significant = abs(change) > NEGLIGIBLE_DRIFT and sigmas > ALARM_SIGMAS
    return not significant and abs(change) + 2 * stderr <= LARGEST_DRIFT


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
