"""Fits of power laws, on data of known law: exact ones to rounding, noisy ones as errors say."""

import numpy as np
import pytest

from roughgas.statistics.fits import limit_at_zero, power_law, signed_power_law

X = np.geomspace(1, 100, 6)
T = np.array([0.05, 0.02, 0.01, 0.005])


def test_a_positive_power_law():
    """The scatter of 2000 exponents is known to 1.6 %: 4 sigma."""
    law = power_law(X, 3 * X**-0.5, np.full(6, 100.0))
    assert law[:3] == pytest.approx((-0.5, 0.1 / np.log(X).std() / np.sqrt(6), 3.0))
    assert law(4.0) == pytest.approx(1.5) and law.chi_squared < 1e-20
    rng = np.random.default_rng(2)
    noisy = X**-0.5 * np.exp(0.1 * rng.standard_normal((2000, 6)))
    fits = [power_law(X, y, np.full(6, 100.0)) for y in noisy]
    exponents = np.array([fit.exponent for fit in fits])
    assert exponents.std() == pytest.approx(fits[0].stderr, rel=0.07)
    assert exponents.mean() == pytest.approx(-0.5, abs=0.005)
    assert np.mean([fit.chi_squared for fit in fits]) == pytest.approx(1.0, abs=0.07)


def test_points_of_less_weight_count_less_and_a_bias_is_taken_off():
    """Only the precise points lie on a line of slope -1/2."""
    x, y = np.array([1.0, 4, 16, 64]), np.array([1.0, 0.5, 0.25, 9.0])
    assert power_law(x, y, np.ones(4)).exponent > 0
    unsure = np.array([1e9, 1e9, 1e9, 1])
    assert power_law(x, y, unsure).exponent == pytest.approx(-0.5, abs=1e-6)
    biased = power_law(X, 3 * X**-0.5 * np.exp(0.1 * X), np.ones(6), bias=0.1 * X)
    assert biased[::2] == pytest.approx((-0.5, 3.0))


def test_a_power_law_of_either_sign():
    """Without noise to the grid; with noise within 3.5 of the errors given, which are right."""
    stderr = np.full(4, 1e-3)
    exact = signed_power_law(T, -1.5 * T**1.2, stderr)
    assert exact.exponent == pytest.approx(1.2, abs=1e-3) and exact.chi_squared < 1e-4
    assert exact.prefactor == pytest.approx(-1.5, rel=1e-2)
    rng = np.random.default_rng(1)
    noisy = -1.5 * T + stderr * rng.standard_normal((400, 4))
    fits = [signed_power_law(T, y, stderr) for y in noisy]
    pulls = [(fit.exponent - 1.0) / fit.stderr for fit in fits]
    assert np.std(pulls) == pytest.approx(1.0, abs=0.15)
    assert abs(np.mean(pulls)) < 3.5 / np.sqrt(400)
    assert np.mean([fit.chi_squared for fit in fits]) == pytest.approx(1.0, abs=3.5 / np.sqrt(400))


def test_the_limit_of_a_parabola():
    values, stderr = 0.31 - 0.5 * T + T**2, np.array([1e-3, 2e-3, 1e-3, 2e-3])
    assert limit_at_zero(T, values, stderr)[0] == pytest.approx(0.31, abs=1e-12)
    rng = np.random.default_rng(2)
    found = [limit_at_zero(T, values + stderr * rng.standard_normal(4), stderr) for _ in range(400)]
    spread, error = np.std([value for value, _ in found]), found[0][1]
    assert spread == pytest.approx(error, rel=3.5 / np.sqrt(800))
