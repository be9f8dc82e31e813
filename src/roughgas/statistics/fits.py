"""Fits of power laws, and what a series tends to: plain functions of arrays with known errors."""

import math
from typing import NamedTuple

import numpy as np

EXPONENTS = np.linspace(0.2, 3.0, 2801)  # that `signed_power_law` tries


class PowerLaw(NamedTuple):
    """y = prefactor x^exponent, the exponent's standard error, and chi^2 per degree of freedom.

    `law(x)` is y.
    """

    exponent: float
    stderr: float
    prefactor: float
    chi_squared: float

    def __call__(self, x: np.ndarray | float) -> np.ndarray | float:
        return self.prefactor * x**self.exponent


def power_law(x, y, weight, bias=0.0) -> PowerLaw:
    """Fit positive `y` by weighted least squares in the logarithms, arrays of shape (points,).

    `weight` is the inverse variance of log y, and `bias` how much too large log y is on average.
    """
    log_x, log_y = np.log(x), np.log(y) - bias
    middle, height = (np.average(values, weights=weight) for values in (log_x, log_y))
    away = log_x - middle
    spread = np.sum(weight * away**2)
    exponent = np.sum(weight * away * log_y) / spread
    misses = log_y - height - exponent * away
    chi_squared = np.sum(weight * misses**2) / max(1, len(log_x) - 2)
    return PowerLaw(exponent, spread**-0.5, np.exp(height - exponent * middle), chi_squared)


def signed_power_law(x, y, stderr) -> PowerLaw:
    """Fit `y` of either sign by weighted least squares, not its logarithm, shape (points,).

    So values that do not differ from zero count, too. The error of the exponent is where chi^2 is
    greater by 1; the exponent lies between the ends of EXPONENTS.
    """
    weight = 1.0 / stderr**2
    shape = x ** EXPONENTS[:, None]
    amplitude = (shape * y * weight).sum(axis=1) / (shape**2 * weight).sum(axis=1)
    chi = (((y - amplitude[:, None] * shape) / stderr) ** 2).sum(axis=1)
    best = np.argmin(chi)
    likely = EXPONENTS[chi <= chi[best] + 1.0]
    spread = 0.5 * (likely[-1] - likely[0])
    return PowerLaw(EXPONENTS[best], spread, amplitude[best], chi[best] / max(1, len(x) - 2))


def limit_at_zero(x, y, stderr) -> tuple[float, float]:
    """Return value and standard error at x = 0 of a parabola, fitted by weighted least squares.

    With three points or fewer it is a straight line.
    """
    powers = np.arange(2 if len(x) <= 3 else 3)
    design = x[:, None] ** powers / stderr[:, None]
    inverse = np.linalg.inv(design.T @ design)
    return (inverse @ (design.T @ (y / stderr)))[0], math.sqrt(inverse[0, 0])
