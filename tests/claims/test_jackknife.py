"""Errors of numbers that are derived from curves, against closed forms."""

import numpy as np
import pytest
from tests.pages import DOCS

from roughgas.base.files import study_module

STUDY = DOCS.parent / "studies" / "mpemba"


@pytest.fixture(scope="module")
def module():
    return study_module(STUDY, "jackknife")


@pytest.fixture(scope="module")
def curves():
    return study_module(STUDY, "curves")


def seeds_of(module, T, collisions=None):
    """Return a gas whose T_tr and T_rot are T, (seeds, samples)."""
    if collisions is None:
        collisions = np.tile(np.arange(T.shape[1]) * 1.0, (len(T), 1))
    return module.GasOfSeeds(T, T.copy(), collisions)


def test_means_have_the_covariance_of_their_samples(module):
    T = np.random.default_rng(1).normal(size=(9, 3))
    means = module.jackknife(lambda gases: gases[0].T, [seeds_of(module, T)])
    assert means.covariance == pytest.approx(np.cov(T.T) / 9, rel=1e-12)
    assert means.stderr == pytest.approx(T.std(axis=0, ddof=1) / 3, rel=1e-12)
    assert means.dof == pytest.approx([8.0] * 3)


def test_variances_of_independent_gases_add(module):
    rng = np.random.default_rng(2)
    first, second = rng.normal(size=(9, 1)), rng.normal(size=(5, 1))
    gases = [seeds_of(module, first), seeds_of(module, second)]
    gap = module.jackknife(lambda means: means[0].T - means[1].T, gases).estimate()
    variances = np.array([first.var(ddof=1) / 9, second.var(ddof=1) / 5])
    assert gap.value == pytest.approx(first.mean() - second.mean())
    assert gap.stderr == pytest.approx(np.sqrt(variances.sum()))
    assert gap.dof == pytest.approx(variances.sum() ** 2 / np.sum(variances**2 / [8.0, 4.0]))


def course(module, curves, T, collisions=None):
    """Return a course of two stages, ten samples each, that begin at 0 and 10."""
    time = np.arange(1.0, 21.0)
    return curves.Course(time, np.array([0.0, 10.0]), seeds_of(module, T, collisions))


def test_the_error_of_the_unit_is_shared_by_all_points(module, curves):
    """T = 2 without scatter, over a unit that scatters: the error is 2 sigma/sqrt(n), to first
    order, and all points deviate together."""
    unit = 1.0 + 0.01 * np.random.default_rng(3).normal(size=12)
    T = np.full((12, 20), 2.0)
    T[:, 10:] = unit[:, None]
    gas = course(module, curves, T)
    points = curves.Gases([gas], 0).at(0, gas.seeds.collisions[0, 2:5] / 2.0)
    expected = 2.0 * unit.std(ddof=1) / np.sqrt(12)
    assert points.stderr == pytest.approx([expected] * 3, rel=0.05)
    assert np.linalg.matrix_rank(points.covariance, tol=1e-12) == 1


def test_a_unit_that_follows_the_curve_leaves_no_error(module, curves):
    T = np.tile((1.0 + 0.1 * np.random.default_rng(4).normal(size=(12, 1))), (1, 20))
    gas = course(module, curves, T)
    assert curves.Gases([gas], 0).at(0, np.array([1.0, 2.0])).stderr == pytest.approx(
        [0, 0], abs=1e-12
    )


def test_the_error_of_the_clock_moves_points_along_the_curve(module, curves):
    """T = 3 - 0.1 t up to the last stage: a clock that is fast by a share e moves T(time) by 0.1 t
    e."""
    rng, time = np.random.default_rng(5), np.arange(1.0, 21.0)
    T = np.tile(np.where(time <= 10.0, 3.0 - 0.1 * time, 1.0), (12, 1))
    rate = 1.0 + 0.01 * rng.normal(size=(12, 1))
    gas = course(module, curves, T, rate * time)
    points = curves.Gases([gas], 0).at(0, np.array([2.0]))
    expected = 0.1 * 4.0 * rate.std(ddof=1) / np.sqrt(12) / rate.mean() ** 2
    assert points.stderr == pytest.approx([expected], rel=0.05)


def test_the_ratio_of_variances_has_tabulated_probabilities(module):
    """5 % at F(4, 20) = 2.866 and F(6, 10) = 3.217, and at chi squared/4 = 2.372; (1 + 2
    F/n)^(-n/2) for two and n degrees of freedom."""
    assert module.f_survival(2.866, 4, 20) == pytest.approx(0.05, abs=1e-5)
    assert module.f_survival(3.217, 6, 10) == pytest.approx(0.05, abs=2e-5)
    assert module.f_survival(9.488 / 4, 4, 1e7) == pytest.approx(0.05, abs=1e-5)
    assert module.f_survival(1.7, 2, 7) == pytest.approx((1 + 2 * 1.7 / 7) ** -3.5)


def test_curves_without_a_deviation_are_improbable_as_often_as_they_should(module):
    """Correlated Gaussians: 5 % of 400 within 3.5 standard errors (by chance once in 2000; the seed
    is fixed)."""
    rng, trials = np.random.default_rng(6), 400
    mixing = np.array([[1.0, 0, 0, 0], [0.9, 0.3, 0, 0], [0.8, 0.2, 0.2, 0], [0.5, 0.1, 0, 1.0]])
    below = 0
    for _ in range(trials):
        T = rng.normal(size=(10, 4)) @ mixing.T
        below += module.jackknife(lambda m: m[0].T, [seeds_of(module, T)]).probability() < 0.05
    assert below / trials == pytest.approx(0.05, abs=3.5 * np.sqrt(0.05 * 0.95 / trials))


def test_too_few_seeds_have_no_probability(module):
    T = np.random.default_rng(7).normal(size=(4, 4))
    means = module.jackknife(lambda gases: gases[0].T, [seeds_of(module, T)])
    assert np.isnan(means.probability())
