"""Whether stated errors are true: coverage of intervals, bias, and the size of the errors."""

import math
from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from roughgas.statistics.intervals import half_width, pooled

REGROUPINGS = 100


class Runs(NamedTuple):
    """What independent runs state: R, its error and degrees of freedom, arrays of shape (runs,)."""

    R: np.ndarray
    stderr: np.ndarray
    dof: np.ndarray


class Share(NamedTuple):
    """An estimated probability, and its standard error."""

    value: float
    stderr: float


def calibrate(
    runs: Runs,
    truth: float,
    truth_stderr: float,
    levels: Sequence[float],
    seeds: int,
    rng: np.random.Generator,
) -> dict[str, Any]:
    """Coverage over (way, level): of intervals of one run, and of `seeds` pooled; bias and errors.

    The error of the bias allows for `truth_stderr`. `rng` puts the runs into groups.
    """
    number, scatter = len(runs.R), float(runs.R.std(ddof=1))
    ways = one_run(runs, truth, levels), several(runs, truth, levels, seeds, rng)
    square = runs.stderr**2
    stated = math.sqrt(square.mean()) / scatter
    off = (runs.R - runs.R.mean()) ** 2
    # Of a root of a quotient of two means: half of the relative errors of both
    uncertain = math.hypot(off.std() / off.mean(), square.std() / square.mean()) / 2
    return {
        "coverage": [[share.value for share in way] for way in ways],
        "coverage_stderr": [[share.stderr for share in way] for way in ways],
        "bias": (float(runs.R.mean()) - truth) / scatter,
        "bias_stderr": math.hypot(1 / math.sqrt(number), truth_stderr / scatter),
        "stated_over_true": stated,
        "stated_over_true_stderr": stated * uncertain / math.sqrt(number),
        "scatter": scatter,
    }


def one_run(runs: Runs, truth: float, levels: Sequence[float]) -> list[Share]:
    """How often the intervals of single runs hold `truth`, at each of `levels`."""
    return [_binomial(_held(runs, truth, level)) for level in levels]


def several(
    runs: Runs, truth: float, levels: Sequence[float], seeds: int, rng: np.random.Generator
) -> list[Share]:
    """How often the intervals of `seeds` runs pooled hold `truth`, at each of `levels`.

    The runs are put into groups at random again and again: an incomplete U-statistic (Blom,
    Biometrika 63, 573 (1976)), several times as precise as one division into groups. To leading
    order its variance is that of Hoeffding, Ann. Math. Stat. 19, 293 (1948): seeds^2/runs times the
    variance, over runs, of how often the groups with this run hold the truth.
    """
    number = len(runs.R) // seeds * seeds
    groups = [rng.permutation(len(runs.R))[:number] for _ in range(REGROUPINGS)]
    groups = np.concatenate(groups).reshape(-1, seeds)
    errors = [pooled(*(part[group] for part in runs)) for group in groups]
    means = runs.R[groups].mean(axis=1)
    pools = Runs(means, *np.array(errors).T)
    return [_hoeffding(_held(pools, truth, level), groups, len(runs.R)) for level in levels]


def _held(runs: Runs, truth: float, level: float) -> np.ndarray:
    """Of each run, whether its interval holds the truth; one that states none does not."""
    widths = [half_width(*known, level) for known in zip(runs.stderr, runs.dof, strict=True)]
    return np.abs(runs.R - truth) <= np.array(widths)


def _binomial(held: np.ndarray) -> Share:
    """The error is that of Laplace's estimate, (k + 1)/(n + 2), and does not vanish at 0 or 1."""
    number = len(held)
    likely = (held.sum() + 1) / (number + 2)
    return Share(float(held.mean()), math.sqrt(likely * (1 - likely) / number))


def _hoeffding(held: np.ndarray, groups: np.ndarray, runs: int) -> Share:
    """The share of groups that hold the truth; never known better than to one run."""
    seeds, value = groups.shape[1], float(held.mean())
    times = np.bincount(groups.ravel(), minlength=runs)
    with_run = np.bincount(groups.ravel(), np.repeat(held, seeds), minlength=runs) / times
    chance = value * (1 - value) / times.mean()  # from a finite number of groups
    variance = seeds**2 / runs * max(0.0, float(with_run.var(ddof=1)) - chance)
    return Share(value, max(math.sqrt(variance + chance * seeds / runs), 1 / runs))
