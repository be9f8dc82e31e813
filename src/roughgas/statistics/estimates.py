"""Estimates: a value with its standard error and the degrees of freedom of the error.

Whether a difference is significant is decided by its two-sided probability by Student's t.
"""

import math
from statistics import NormalDist
from typing import Any, NamedTuple

import numpy as np

from roughgas.statistics.errors import stderr_over_seeds, sum_error
from roughgas.statistics.student import t_probability, t_quantile

ERROR_DIGITS = 2  # significant digits of a standard error
SIGNIFICANT = 3.0
"""Sigma from which a difference counts as real. A convention. Fixed before any data."""
SIGNIFICANCE = math.erfc(SIGNIFICANT / math.sqrt(2))
"""Two-sided probability below which a difference counts as real, of SIGNIFICANT Gaussian sigma."""
POWER = 0.9
"""Probability with which a test finds a deviation that is called detectable. A convention."""


class Estimate(NamedTuple):
    """A value, its standard error, and the degrees of freedom of the error.

    `f"{estimate}"` is compact: 0.3565(30), the error in units of the last digit. A format for
    numbers is applied to both: `f"{estimate:+.4f}"` is +0.3565 ± 0.0030. In `f"{estimate:±}"` and
    `f"{estimate:+±}"` the error has two digits.
    """

    value: Any  # a float; in studies all three fields may be arrays
    stderr: Any
    dof: Any = math.inf

    @property
    def t(self) -> float:
        """Value over standard error; NaN if the error is unknown, signed infinity if it is 0."""
        if not math.isfinite(self.stderr) or self.stderr < 0:
            return math.nan
        if self.stderr == 0:
            return math.copysign(math.inf, self.value) if self.value else 0.0
        return float(self.value / self.stderr)

    @property
    def probability(self) -> float:
        """Two-sided probability of |t| or more by chance, by Student's t with `dof`; or NaN."""
        return float(t_probability(self.t, self.dof))

    @property
    def is_significant(self) -> bool:
        """Whether the value differs from 0 significantly: its probability is below SIGNIFICANCE."""
        return self.probability < SIGNIFICANCE

    @property
    def detectable(self) -> float:
        """Smallest deviation found significant with probability POWER, in the unit of the value.

        The same as `detectable_at` SIGNIFICANCE; NaN if the error is unknown.
        """
        return self.detectable_at(SIGNIFICANCE)

    def detectable_at(self, level: float) -> float:
        """Return the smallest deviation whose probability is below `level` with probability POWER.

        It is the standard error times the sum of two quantiles of Student's t: of the two-sided
        probability `level`, and of the one-sided probability POWER. Neglected are: significant
        deviations of the wrong sign, less than 1e-3 of all; and that one estimated error is in both
        terms, so that t is noncentral. At this deviation, with the true standard error, the power
        at SIGNIFICANCE is 0.75 for 3 degrees of freedom, 0.81 for 5, 0.87 for 10 and 0.88 for 20.
        The measured value has no part in it. In the unit of the value; NaN if the error is unknown.
        """
        if not (math.isfinite(self.stderr) and self.dof > 0):
            return math.nan
        quantiles = t_quantile(level, self.dof) + t_quantile(2 * (1 - POWER), self.dof)
        return float(self.stderr * quantiles)

    @property
    def sigma(self) -> float:
        """Signed deviate of a Gaussian with the same `probability`; NaN if the error is unknown."""
        t, probability = self.t, self.probability
        if math.isinf(self.dof) or not 0.0 < probability:
            return t  # infinite where the probability vanishes, NaN where it is unknown
        return math.copysign(-NormalDist().inv_cdf(probability / 2), t)

    @property
    def ci95(self) -> float:
        """Half the width of the 95 % interval, by Student's t; NaN if the error is unknown."""
        return t_quantile(0.05, self.dof) * self.stderr if self.dof >= 1 else math.nan

    def minus(self, subtracted: "Estimate") -> "Estimate":
        """Return the difference of this estimate and an independent one, which is subtracted."""
        stderr, dof = sum_error([self.stderr, subtracted.stderr], [self.dof, subtracted.dof])
        return Estimate(self.value - subtracted.value, float(stderr), float(dof))

    def scaled(self, factor: float) -> "Estimate":
        """Return the estimate and its error times `factor`, as for other units."""
        return Estimate(factor * self.value, abs(factor) * self.stderr, self.dof)

    def record(self) -> dict[str, float]:
        """Return the numbers `value`, `error`, `ci95` and `sigma` by name, for JSON.

        They have six significant digits: the standard error, half the width of the 95 % interval,
        and the distance of the value from 0 in sigma.
        """
        numbers = {"value": self.value, "error": self.stderr, "ci95": self.ci95}
        numbers["sigma"] = self.sigma
        return {name: float(f"{number:.6g}") for name, number in numbers.items()}

    def __format__(self, how: str) -> str:
        """Return the estimate as text; `how` is a format for numbers, may end in ±, or is empty."""
        if not how:
            return self._compact()
        if how.endswith("±"):
            how = f"{how[:-1]}.{max(0, decimals_of(self.stderr))}f"
        if not math.isfinite(self.stderr):
            return f"{self.value:{how}} (error unknown)"
        return f"{self.value:{how}} ± {self.stderr:{how.lstrip('+')}}"

    def _compact(self) -> str:
        """Return a text such as 0.3565(30); six digits of the value if there is no error."""
        value, stderr, _ = self
        if not (math.isfinite(value) and math.isfinite(stderr) and stderr > 0.0):
            return f"{value:.6g}"
        exponent = _exponent(max(abs(value), stderr))
        if not -4 <= exponent < 6:
            return f"{Estimate(value / 10.0**exponent, stderr / 10.0**exponent)}e{exponent:+03}"
        decimals = decimals_of(stderr)
        if decimals < 0:
            return f"{round(value, decimals):.0f}({round(stderr, decimals):.0f})"
        shown = f"{stderr:.{decimals}f}" if stderr >= 1.0 else str(round(stderr * 10**decimals))
        return f"{value:.{decimals}f}({shown})"


def mean_with_error(value: np.ndarray, stderr: np.ndarray, dof: np.ndarray) -> Estimate:
    """Return the mean of independent numbers, with the error that follows from their errors.

    `value`, `stderr` and `dof`, the degrees of freedom of each error, have shape (n,).
    """
    error = sum_error(stderr, dof)
    return Estimate(float(value.mean()), float(error.stderr) / len(value), float(error.dof))


def mean_by_scatter(values: np.ndarray) -> Estimate:
    """Return the mean of independent numbers (n,), such as of seeds, with its error by scatter."""
    return Estimate(float(np.mean(values)), stderr_over_seeds(values), len(values) - 1.0)


def decimals_of(stderr: float) -> int:
    """Return the number of significant decimals of a number with the standard error `stderr`.

    Negative for tens and so on; two where the error is zero or unknown.
    """
    if not (math.isfinite(stderr) and stderr > 0.0):
        return ERROR_DIGITS
    return ERROR_DIGITS - 1 - _exponent(float(f"{stderr:.{ERROR_DIGITS - 1}e}"))


def _exponent(number: float) -> int:
    """Return the decimal exponent of a number > 0: 2 for 350, -1 for 0.35."""
    return math.floor(math.log10(number))
