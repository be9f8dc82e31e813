"""Errors of numbers that are derived from gases, by leaving out one seed at a time.

A number that depends on the means over seeds of several independent gases is computed again without
each seed in turn (M. H. Quenouille, Biometrika 43, 353 (1956)). The scatter has all that these
means share, such as a common unit, and gives the covariances of several numbers.
"""

import math
from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np

from roughgas.judging import Estimate, sum_error


class GasOfSeeds(NamedTuple):
    """Series of a gas for each seed, (seeds, samples), or their means over seeds, (samples,)."""

    T_tr: np.ndarray  # temperatures of translation and of rotation, m a^2/T^2
    T_rot: np.ndarray
    collisions: np.ndarray  # per particle since the start

    @property
    def T(self) -> np.ndarray:
        """The mean temperature of disks."""
        return (2.0 * self.T_tr + self.T_rot) / 3.0


class Jackknife(NamedTuple):
    """Numbers of shape (k,) with their covariance."""

    value: np.ndarray
    deviations: tuple[np.ndarray, ...]
    """For each gas an array (seeds, k) whose products, summed over seeds, are its covariance."""

    @property
    def covariance(self) -> np.ndarray:
        """The covariance of the numbers, (k, k)."""
        return sum(deviations.T @ deviations for deviations in self.deviations)

    @property
    def stderr(self) -> np.ndarray:
        """The standard errors, (k,)."""
        return np.sqrt(sum(np.sum(deviations**2, axis=0) for deviations in self.deviations))

    @property
    def dof(self) -> np.ndarray:
        """The degrees of freedom of the errors, (k,), by Welch and Satterthwaite."""
        errors = [np.sqrt(np.sum(deviations**2, axis=0)) for deviations in self.deviations]
        seeds = [np.full(errors[0].shape, len(deviations) - 1.0) for deviations in self.deviations]
        return sum_error(errors, seeds).dof

    def estimate(self, index: int = 0) -> Estimate:
        """Return one of the numbers with its error."""
        return Estimate(*(float(column[index]) for column in (self.value, self.stderr, self.dof)))

    def probability(self) -> float:
        """Return the probability of numbers as far from 0 as these, by Hotelling's T^2.

        The degrees of freedom are those of the gas with the fewest seeds. NaN unless its seeds
        outnumber the numbers. H. Hotelling, Ann. Math. Stat. 2, 360 (1931).
        """
        count, dof = len(self.value), min(map(len, self.deviations)) - 1
        if dof < count or not np.isfinite(self.covariance).all():
            return math.nan
        square = float(self.value @ np.linalg.solve(self.covariance, self.value))
        return f_survival(square * (dof - count + 1) / (count * dof), count, dof - count + 1)


def f_survival(ratio: float, first: int, second: float) -> float:
    """Return the probability that a ratio of two variances exceeds `ratio` by chance.

    Their degrees of freedom are `first`, an even number, and `second`: the incomplete beta function
    I_x(second/2, first/2) at x = second/(second + first ratio) is then a sum of first/2 terms. M.
    Abramowitz & I. A. Stegun, Handbook of Mathematical Functions (1964), 26.6.4.
    """
    x, a = second / (second + first * ratio), 0.5 * second
    term, total = 1.0, 1.0
    for j in range(1, first // 2):
        term *= (a + j - 1.0) / j * (1.0 - x)
        total += term
    return x**a * total


def jackknife(
    statistic: Callable[[Sequence[GasOfSeeds]], np.ndarray], gases: Sequence[GasOfSeeds]
) -> Jackknife:
    """Return the numbers `statistic(means)`, (k,), and their covariance.

    `statistic` takes the means over seeds of all gases. NaN without a second seed.
    """
    means = [GasOfSeeds(*(series.mean(axis=0) for series in gas)) for gas in gases]
    deviations = []
    for index, gas in enumerate(gases):
        seeds = len(gas.T)
        values = np.array(
            [
                statistic([*means[:index], left_out, *means[index + 1 :]])
                for left_out in _without_each_seed(gas)
            ]
        )
        factor = np.sqrt((seeds - 1.0) / seeds) if seeds > 1 else np.nan
        deviations.append(factor * (values - values.mean(axis=0)))
    return Jackknife(statistic(means), tuple(deviations))


def _without_each_seed(gas):
    """Yield the means over all seeds but one, for each seed."""
    seeds, sums = len(gas.T), [series.sum(axis=0) for series in gas]
    for seed in range(seeds):
        yield GasOfSeeds(
            *(
                (total - series[seed]) / max(1, seeds - 1)
                for total, series in zip(sums, gas, strict=True)
            )
        )
