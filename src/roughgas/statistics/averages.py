"""Averages over blocks of samples: whole periods of the drive, or what a line can show."""

import numpy as np


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
        raise ValueError(
            f"{series.shape[-1]} samples hold no whole period of {samples_per_period} samples"
        )
    whole = series[..., : periods * samples_per_period]
    return whole.reshape(*series.shape[:-1], periods, samples_per_period).mean(axis=-1)


def block_means(values: np.ndarray, block: int) -> np.ndarray:
    """Return the means over blocks of `block` values; the last block may be shorter."""
    begins = np.arange(0, values.size, block)
    return np.add.reduceat(values, begins) / np.diff(np.append(begins, values.size))
