"""A number with its standard error: the one type for it, and how it is written."""

import math
from typing import Any, NamedTuple

DIGITS = 2  # of an error
SIGNIFICANT = 3.0
"""Sigma from which a difference counts as real. A convention. Fixed before any data."""


class Estimate(NamedTuple):
    """A value, its standard error, and the degrees of freedom that the error is known with.

    `f"{estimate}"` is compact: 0.3565(30), the error in units of the last digit. A format for
    numbers is applied to both: `f"{estimate:+.4f}"` is +0.3565 ± 0.0030. In `f"{estimate:±}"` and
    `f"{estimate:+±}"` the error has two digits.
    """

    value: Any  # a float, in studies also an array of them; so are the others
    stderr: Any
    dof: Any = math.inf

    @property
    def sigma(self) -> float:
        """How many sigma of a Gaussian the value is from 0, signed; NaN if the error is unknown."""
        from roughgas.statistics.errors import gaussian_sigmas

        if not math.isfinite(self.stderr) or self.stderr < 0:
            return math.nan
        if self.stderr == 0:
            return math.copysign(math.inf, self.value) if self.value else 0.0
        ratio = self.value / self.stderr
        return ratio if math.isinf(self.dof) else float(gaussian_sigmas(ratio, self.dof))

    @property
    def real(self) -> bool:
        """Whether it differs from 0 significantly."""
        return abs(self.sigma) >= SIGNIFICANT

    def minus(self, other: "Estimate") -> "Estimate":
        """Return the difference of two independent estimates."""
        from roughgas.statistics.intervals import sum_error

        stderr, dof = sum_error([self.stderr, other.stderr], [self.dof, other.dof])
        return Estimate(self.value - other.value, float(stderr), float(dof))

    def scaled(self, factor: float) -> "Estimate":
        """Return the estimate in other units, such as per cent."""
        return Estimate(factor * self.value, abs(factor) * self.stderr, self.dof)

    def record(self) -> dict[str, float]:
        """Return value, error and sigma for JSON, with six significant digits."""
        numbers = {"value": self.value, "error": self.stderr, "sigma": self.sigma}
        return {name: float(f"{number:.6g}") for name, number in numbers.items()}

    def __format__(self, how: str) -> str:
        if not how:
            return self._compact()
        if how.endswith("±"):
            how = f"{how[:-1]}.{max(0, decimals_of(self.stderr))}f"
        if not math.isfinite(self.stderr):
            return f"{self.value:{how}} (error unknown)"
        return f"{self.value:{how}} ± {self.stderr:{how.lstrip('+')}}"

    def _compact(self) -> str:
        """Return such as 0.3565(30); six digits if there is no error."""
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


def decimals_of(stderr: float) -> int:
    """Return how many decimals of a number with this error count; negative for tens and so on.

    Two where the error is zero or unknown.
    """
    if not (math.isfinite(stderr) and stderr > 0.0):
        return DIGITS
    return DIGITS - 1 - _exponent(float(f"{stderr:.{DIGITS - 1}e}"))


def _exponent(number: float) -> int:
    return math.floor(math.log10(number))
