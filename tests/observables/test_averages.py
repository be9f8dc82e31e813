"""Means over looks, and the errors of what is made of them."""

import math

import numpy as np
import pytest

from roughgas.observables.averages import averaged
from roughgas.statistics.errors import blocking

RNG = np.random.default_rng(3)
LOOKS = 400


def looks(**series):
    """A look for each place of the series."""
    return [dict(zip(series, row, strict=True)) for row in zip(*series.values(), strict=True)]


def ratio(means):
    return {"ratio": means["a"] / means["b"]}


def test_a_mean_has_the_error_by_blocking():
    values = RNG.standard_normal((LOOKS, 3)).cumsum(axis=0)
    found = averaged(dict, [looks(x=values)])
    assert found.value["x"] == pytest.approx(values.mean(axis=0), rel=1e-12)
    for k in range(3):
        error = blocking(values[:, k])
        assert found.stderr["x"][k] == pytest.approx(error.stderr, rel=1e-6)
        assert found.dof["x"][k] == pytest.approx(error.blocks - 1.0)


def test_the_error_of_a_quotient_is_that_of_its_linear_part():
    """Gauss's law of the propagation of errors, with the covariance."""
    a, noise = RNG.normal(5.0, 1.0, LOOKS), RNG.normal(0.0, 0.5, LOOKS)
    b = 0.5 * a + noise + 3.0
    found = averaged(ratio, [looks(a=a, b=b)])
    R = a.mean() / b.mean()
    linear = R * (a / a.mean() - b / b.mean())
    assert found.value["ratio"] == pytest.approx(R, rel=1e-14)
    assert found.stderr["ratio"] == pytest.approx(blocking(linear).stderr, rel=1e-5)


def test_of_several_runs_the_scatter_counts():
    means = np.array([1.0, 2.0, 4.0])
    runs = [looks(a=np.full(9, mean), b=np.full(9, 2.0)) for mean in means]
    found = averaged(ratio, runs)
    assert found.value["ratio"] == pytest.approx(means.mean() / 2.0)
    expected = means.std(ddof=1) / math.sqrt(3) / 2.0
    assert found.stderr["ratio"] == pytest.approx(expected, rel=1e-6)
    assert found.dof["ratio"] == 2.0


def test_what_is_nan_does_not_count():
    values = RNG.standard_normal((LOOKS, 2))
    values[:30, 0] = math.nan
    values[:, 1] = math.nan
    found = averaged(dict, [looks(x=values)])
    assert found.value["x"][0] == pytest.approx(values[30:, 0].mean(), rel=1e-12)
    assert found.stderr["x"][0] == pytest.approx(blocking(values[30:, 0]).stderr, rel=1e-6)
    assert math.isnan(found.value["x"][1]) and math.isnan(found.stderr["x"][1])


def test_means_are_over_whole_periods():
    """A swing within the period is no scatter."""
    phases = np.tile([0.0, 1.0, 5.0, 2.0], LOOKS // 4)
    found = averaged(dict, [looks(x=phases)], per_period=4)
    assert found.value["x"] == 2.0 and found.stderr["x"] == 0.0
