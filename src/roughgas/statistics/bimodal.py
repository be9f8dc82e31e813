"""Whether an ensemble of replicas is a mixture: some have left for another state.

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

import numpy as np

from roughgas.statistics.errors import gaussian_sigmas

BIMODAL_SIGMAS = 5.0
APART = 0.25  # of the mean
FEWEST = 4  # replicas


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
