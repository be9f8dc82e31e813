"""Fits of power laws and extrapolation to zero, of arrays with known errors."""

import math
from typing import NamedTuple

import numpy as np

EXPONENTS = np.linspace(0.2, 3.0, 2801)  # the grid of `signed_power_law`


class PowerLaw(NamedTuple):
    """The fit y = prefactor x^exponent, with the standard error of the exponent.

    `chi_squared` is chi^2 per degree of freedom; `law(x)` is y.
    """

    exponent: float
    stderr: float
    prefactor: float
    chi_squared: float

    def __call__(self, x: np.ndarray | float) -> np.ndarray | float:
        """Return y at `x`."""
        return self.prefactor * x**self.exponent


def power_law(x, y, weight, bias=0.0) -> PowerLaw:
    """Return the power law fitted to positive `y` by weighted least squares in the logarithms.

    Arrays have shape (points,). `weight` is the inverse variance of log y, and `bias` the mean
    excess of log y, which is subtracted.
    """
    log_x, log_y = np.log(x), np.log(y) - bias
    mean_log_x, mean_log_y = (np.average(values, weights=weight) for values in (log_x, log_y))
    deviation = log_x - mean_log_x
    spread = np.sum(weight * deviation**2)
    exponent = np.sum(weight * deviation * log_y) / spread
    residuals = log_y - mean_log_y - exponent * deviation
    chi_squared = np.sum(weight * residuals**2) / max(1, len(log_x) - 2)
    return PowerLaw(exponent, spread**-0.5, np.exp(mean_log_y - exponent * mean_log_x), chi_squared)


def signed_power_law(x, y, stderr) -> PowerLaw:
    """Return the power law fitted to `y` of either sign by weighted least squares.

    `x` > 0, `y` and its standard error `stderr` are arrays (points,). The logarithm is not used, so
    that values compatible with zero count, too. The error of the exponent is the distance that
    increases chi^2 by 1; the exponent is limited to EXPONENTS.
    """
    weight = 1.0 / stderr**2
    shape = x ** EXPONENTS[:, None]
    amplitude = (shape * y * weight).sum(axis=1) / (shape**2 * weight).sum(axis=1)
    chi = (((y - amplitude[:, None] * shape) / stderr) ** 2).sum(axis=1)
    best = np.argmin(chi)
    likely_exponents = EXPONENTS[chi <= chi[best] + 1.0]
    spread = 0.5 * (likely_exponents[-1] - likely_exponents[0])
    return PowerLaw(EXPONENTS[best], spread, amplitude[best], chi[best] / max(1, len(x) - 2))


def limit_at_zero(x, y, stderr) -> tuple[float, float]:
    """Return value and standard error at x = 0 of a parabola, fitted by weighted least squares.

    `x`, `y` and its standard error `stderr` are arrays (points,). With three points or fewer a
    straight line is fitted.
    """
    powers = np.arange(2 if len(x) <= 3 else 3)
    design = x[:, None] ** powers / stderr[:, None]
    inverse = np.linalg.inv(design.T @ design)
    return (inverse @ (design.T @ (y / stderr)))[0], math.sqrt(inverse[0, 0])
