from types import SimpleNamespace

import numpy as np
import pytest


def _series(rng, autocorrelation_time, samples, count):
    """Return AR(1) series (count, samples) of mean 0 and variance 1.

    Their 1 + 2 sum rho(k) is `autocorrelation_time`.
    """
    memory = _memory(autocorrelation_time)
    series = np.empty((count, samples))
    series[:, 0] = rng.normal(size=count)
    kicks = rng.normal(size=(count, samples)) * np.sqrt(1 - memory**2)
    for sample in range(1, samples):
        series[:, sample] = memory * series[:, sample - 1] + kicks[:, sample]
    return series


def _stderr(autocorrelation_time, samples):
    """Return the exact standard error of the mean of such a series."""
    lags = np.arange(1, samples)
    correlations = _memory(autocorrelation_time) ** lags
    return np.sqrt((1 + 2 * np.sum((1 - lags / samples) * correlations)) / samples)


def _memory(autocorrelation_time):
    return (autocorrelation_time - 1) / (autocorrelation_time + 1)


@pytest.fixture(scope="session")
def ar1():
    """Correlated noise: `ar1.series(rng, tau, samples, count)`, `ar1.stderr(tau, samples)`."""
    return SimpleNamespace(series=_series, stderr=_stderr)
