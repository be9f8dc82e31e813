"""Fits: power laws, and two peaks."""

import numpy as np
import pytest

from roughgas.statistics.fits import limit_at_zero, power_law, signed_power_law
from roughgas.statistics.steady_state import find_plateau, is_bimodal

X = np.geomspace(1, 100, 6)
T = np.array([0.05, 0.02, 0.01, 0.005])


def test_a_positive_power_law_is_fitted_with_its_error():
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


def test_points_count_by_their_weight_and_a_bias_is_subtracted():
    """Only the precise points lie on a line of slope -1/2."""
    x, y = np.array([1.0, 4, 16, 64]), np.array([1.0, 0.5, 0.25, 9.0])
    assert power_law(x, y, np.ones(4)).exponent > 0
    unsure = np.array([1e9, 1e9, 1e9, 1])
    assert power_law(x, y, unsure).exponent == pytest.approx(-0.5, abs=1e-6)
    biased = power_law(X, 3 * X**-0.5 * np.exp(0.1 * X), np.ones(6), bias=0.1 * X)
    assert biased[::2] == pytest.approx((-0.5, 3.0))


def test_a_power_law_of_either_sign_is_fitted_with_its_error():
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


def test_the_limit_of_a_parabola_is_its_value_at_zero():
    values, stderr = 0.31 - 0.5 * T + T**2, np.array([1e-3, 2e-3, 1e-3, 2e-3])
    assert limit_at_zero(T, values, stderr)[0] == pytest.approx(0.31, abs=1e-12)
    rng = np.random.default_rng(2)
    limits = [
        limit_at_zero(T, values + stderr * rng.standard_normal(4), stderr) for _ in range(400)
    ]
    spread, error = np.std([value for value, _ in limits]), limits[0][1]
    assert spread == pytest.approx(error, rel=3.5 / np.sqrt(800))


LOW, NOISE = 0.27, 0.012  # replicas of 160 disks, averaged over a hundred collisions per particle


def are_bimodal(ensembles):
    return np.array([is_bimodal(values) for values in ensembles])


@pytest.mark.parametrize("replicas", [10, 20, 40, 60, 160])
def test_no_false_alarm_among_gaussian_ensembles(replicas):
    """Whatever the scatter: up to 6 in 100 000 reach 5 sigma, so 4 of 3000 are 1 in 20 000."""
    rng = np.random.default_rng(41)
    for scatter in (NOISE, 0.25 * LOW):
        ensembles = np.abs(LOW + scatter * rng.standard_normal((3000, replicas)))
        assert are_bimodal(ensembles).sum() <= 3


@pytest.mark.parametrize("shape", ["gamma", "student"])
def test_skewed_ensembles_are_no_mixtures_while_they_scatter_little(shape):
    """Hardly any of the ensembles beyond 5 sigma have peaks a quarter of R apart."""
    rng = np.random.default_rng(42)
    draw = {
        "gamma": rng.gamma(4.0, 0.5, (3000, 40)) - 2,
        "student": rng.standard_t(5, (3000, 40)) * np.sqrt(3 / 5),
    }
    assert are_bimodal(LOW * (1 + 0.03 * draw[shape])).mean() <= 0.01


@pytest.mark.parametrize("replicas", [10, 40, 160])
@pytest.mark.parametrize("share", [0.0, 0.25, 0.5, 0.9])
def test_replicas_that_have_run_away_are_found(replicas, share):
    """From a single replica to 90 % of them: in all of 300 mixtures."""
    rng = np.random.default_rng(43)
    ensembles = LOW + NOISE * rng.standard_normal((300, replicas))
    ensembles[:, : max(1, round(share * replicas))] = 1 - rng.exponential(1e-3, (300, 1))
    assert are_bimodal(rng.permuted(ensembles, axis=1)).all()


def test_replicas_on_their_way_do_not_hide_the_others():
    """mu = 0.15: 29 replicas of 40 from 0.24 to 0.29, five above 0.99, the rest in between."""
    values = np.concatenate([np.linspace(0.24, 0.29, 29), np.linspace(0.35, 0.95, 6), 5 * [0.995]])
    assert is_bimodal(values)


@pytest.mark.parametrize("values", [[0.2, 1.0], [0.2, 0.2, 1.0], np.zeros(10), np.full(10, 0.3)])
def test_few_or_equal_replicas_are_no_mixture(values, recwarn):
    assert not is_bimodal(values) and not recwarn.list


def test_rounding_and_scatter_of_1_minus_R_are_no_mixture():
    """All replicas have run away, some of them further: 1 - R scatters over decades."""
    rng = np.random.default_rng(44)
    lack = 10 ** rng.uniform(-12, -2, (300, 40))
    assert not are_bimodal(1 - lack).any()
    assert not is_bimodal(0.3 + 1e-16 * rng.integers(-3, 4, 40))


@pytest.mark.parametrize("runaways", [0, 1, 5])
def test_the_plateau_of_a_mixture_does_not_count(runaways):
    """They run away before the window begins, so that each replica stays at its R."""
    rng = np.random.default_rng(45)
    R = LOW + NOISE * rng.standard_normal((40, 200))
    R[:runaways] = 0.999
    plateau = find_plateau(np.arange(1.0, 201), R)
    assert plateau.exists == (runaways == 0)
    assert (plateau.start, plateau.stop) == (1, 200)
    assert plateau.mean == pytest.approx(R.mean())
