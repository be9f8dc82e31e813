"""Orders, limits and costs from deviations that have errors: plain functions of arrays."""

import math
from typing import NamedTuple

import numpy as np

ORDERS = np.linspace(0.2, 3.0, 2801)
FINE = 1e-4, 400  # least t_c nu that the cheapest is sought from, and how many are tried
FEWEST_PARTS, SHORTEST = 20, 16  # of a series: parts, and samples in each


class Power(NamedTuple):
    """A fit of amplitude * t^order, and chi^2 per degree of freedom."""

    order: float
    order_stderr: float
    amplitude: float
    chi_squared: float


def power_law(t, deviation, stderr) -> Power:
    """Least squares of amplitude * t^order; its error is where chi^2 is greater by 1.

    The deviations themselves are fitted, not their logarithms, so that unresolved ones count, too.
    """
    weight = 1.0 / stderr**2
    shape = t ** ORDERS[:, None]
    amplitude = (shape * deviation * weight).sum(axis=1) / (shape**2 * weight).sum(axis=1)
    chi = (((deviation - amplitude[:, None] * shape) / stderr) ** 2).sum(axis=1)
    best = np.argmin(chi)
    inside = ORDERS[chi <= chi[best] + 1.0]
    spread = 0.5 * (inside[-1] - inside[0])
    return Power(ORDERS[best], spread, amplitude[best], chi[best] / max(1, len(t) - 2))


def limit(t, values, stderr) -> tuple[float, float]:
    """Value and standard error at t = 0 of a parabola, by weighted least squares.

    With three points or fewer it is a straight line.
    """
    powers = np.arange(2 if len(t) <= 3 else 3)
    design = t[:, None] ** powers / stderr[:, None]
    inverse = np.linalg.inv(design.T @ design)
    return (inverse @ (design.T @ (values / stderr)))[0], math.sqrt(inverse[0, 0])


def statistical_error(series, truth):
    """(lengths in samples, rms error of means over so many, its error) from one long series.

    Disjoint parts of the series, of which there are K, are compared with `truth`; the error of
    their rms is that over sqrt(2 K).
    """
    most = max(SHORTEST, len(series) // FEWEST_PARTS)
    lengths = SHORTEST * 2 ** np.arange(int(math.log2(most / SHORTEST)) + 1)
    errors = np.array([math.sqrt(_mean_square(series, length, truth)) for length in lengths])
    return lengths, errors, errors / np.sqrt(2.0 * (len(series) // lengths))


def slowdown(target, t, seconds, fit, events) -> float:
    """How many times the CPU time of events soft spheres take for an error of R of `target`.

    The error is the root mean square of the deviation, that of `fit`, and the statistical error,
    relative to R; t_c is chosen for the least time. `seconds` are the soft spheres' CPU seconds
    per collision per particle at each t_c nu in `t`, interpolated as powers; below the least they
    are inversely proportional to t_c. `events` is the same of the event-driven gas.
    """
    fine = np.geomspace(FINE[0], t.max(), FINE[1])
    order = np.argsort(t)
    known = np.interp(np.log(fine), np.log(t[order]), np.log(seconds[order]))
    cost = np.exp(known) * np.maximum(1.0, t.min() / fine)
    left = 1.0 - (fit.amplitude * fine**fit.order / target) ** 2
    return float((cost[left > 0.0] / left[left > 0.0]).min(initial=math.inf) / events)


def _mean_square(series, length, truth):
    number = len(series) // length
    means = series[: number * length].reshape(number, length).mean(axis=1)
    return np.mean((means - truth) ** 2)
