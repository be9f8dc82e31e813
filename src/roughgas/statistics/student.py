"""Student's t: the distribution of a deviation over its standard error, if that is estimated.

Its density is proportional to (1 + t^2/dof)^(-(dof + 1)/2); `dof` are the degrees of freedom of
the standard error, any positive number, and infinitely many make it a Gaussian. With t = sqrt(dof)
sinh(u) the integrand is cosh(u)^-dof, which is smooth and decays exponentially, so Gauss-Legendre
integrates it to rounding.

`wallace_sigmas` and `wallace_t` approximate the same probabilities. The intervals stored in points
are by them, and the bits of points stay.
"""

import math
from functools import lru_cache
from statistics import NormalDist

import numpy as np
from numpy.typing import ArrayLike

_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(128)
NEGLIGIBLE_EXPONENT = 40.0  # integrands below exp(-40) of their largest value are neglected
GAUSSIAN_DOF = 1e18  # in floating point no different from infinitely many
NEWTON_STEPS, NEWTON_TOLERANCE = 100, 1e-14


def t_probability(t: ArrayLike, dof: ArrayLike) -> np.ndarray:
    """Return the two-sided probability of Student's t: of deviations of |t| or more by chance.

    `t` is in standard errors that have `dof` > 0 degrees of freedom; the shape is the broadcast
    shape of both. The relative error is below 1e-10, also far in the tails, for dof from 0.5 on.
    NaN where either is NaN or dof is not positive.
    """
    t, dof = _arguments(np.abs(t), dof)
    with np.errstate(invalid="ignore"):
        slope = np.where(np.isinf(t), 1.0, t / np.hypot(t, np.sqrt(dof)))
        start = np.exp(-dof / 2 * np.log1p(t * t / dof))
    return np.minimum(1.0, start * _integral(slope, dof) / _integral(np.zeros_like(slope), dof))


def t_density(t: ArrayLike, dof: ArrayLike) -> np.ndarray:
    """Return the density of Student's t, per unit of t, at `t` in standard errors.

    `dof` > 0 are the degrees of freedom; the shape is the broadcast shape of both.
    """
    t, dof = _arguments(t, dof)
    normalisation = 2 * np.sqrt(dof) * _integral(np.zeros_like(t), dof)
    return np.exp(-(dof + 1) / 2 * np.log1p(t * t / dof)) / normalisation


@lru_cache(maxsize=4096)  # rows of a table share levels, and often degrees of freedom
def t_quantile(probability: float, dof: float) -> float:
    """Return the |t| that deviations reach with this two-sided probability: `t_probability` of it.

    `probability` is in (0, 1) and `dof` > 0; NaN if the degrees of freedom are NaN or not positive.
    Newton's steps for ln p over ln t, which is concave: from the second on they only descend.
    Raises ValueError for another probability.
    """
    if not 0.0 < probability < 1.0:
        raise ValueError(f"probability {probability!r}: must be above 0 and below 1")
    if not dof > 0:
        return math.nan
    t = -NormalDist().inv_cdf(probability / 2)
    for _ in range(NEWTON_STEPS):
        reached = float(t_probability(t, dof))
        slope = 2 * t * float(t_density(t, dof)) / reached
        step = math.log(reached / probability) / slope
        t *= math.exp(min(step, 50.0))
        if abs(step) < NEWTON_TOLERANCE:
            break
    return t


def _arguments(t: ArrayLike, dof: ArrayLike) -> tuple[np.ndarray, np.ndarray]:
    """Return t and degrees of freedom as arrays of one shape, with legal numbers or NaN."""
    dof = np.asarray(dof, dtype=float)
    legal = np.where(dof > 0, np.minimum(dof, GAUSSIAN_DOF), np.nan)
    arguments = np.broadcast_arrays(np.asarray(t, dtype=float), legal)
    return arguments[0], arguments[1]


def _integral(slope: np.ndarray, dof: np.ndarray) -> np.ndarray:
    """Return the integral over v > 0 of (cosh(v) + slope sinh(v))^-dof.

    That is cosh(u)^-dof beyond u over its value there, with slope = tanh(u) in [0, 1]. `length` is
    where one of two lower bounds of the base, 1 + slope v + v^2/2 and (1 + slope) exp(v)/2, has
    made the integrand negligible.
    """
    decay = NEGLIGIBLE_EXPONENT / dof
    with np.errstate(over="ignore", invalid="ignore"):  # with dof below 0.06 the other bound holds
        growth = np.expm1(decay)
        parabolic = 2 * growth / (slope + np.sqrt(slope**2 + 2 * growth))
    exponential = decay + np.log(2 / (1 + slope))
    length = np.fmin(parabolic, exponential)
    v = length[..., np.newaxis] * (_NODES + 1) / 2
    # log1p, since with many degrees of freedom the base is close to 1; large v would overflow
    near = np.minimum(v, 30.0)
    base = np.log1p(2 * np.sinh(near / 2) ** 2 + slope[..., np.newaxis] * np.sinh(near))
    exponents = -dof[..., np.newaxis] * (base + (v - near))
    return length / 2 * (np.exp(exponents) @ _WEIGHTS)


def wallace_sigmas(t: np.ndarray | float, degrees_of_freedom: float) -> np.ndarray:
    """Return the Gaussian deviate, in sigma, about as improbable as Student's `t`, with its sign.

    `t` is in standard errors that have these `degrees_of_freedom`. With four seeds (3 degrees of
    freedom) a difference of 3 standard errors is as probable as 1.9 sigma. Formula of Wallace, Ann.
    Math. Stat. 30, 1121 (1959), never too large; too small by 0.05 at 3 sigma and 0.2 at 5 for 3
    degrees of freedom, by a fifth of this for 8.
    """
    dof, t = degrees_of_freedom, np.asarray(t, dtype=float)
    return np.sign(t) * np.sqrt(dof * np.log1p(t**2 / dof)) * _wallace(dof)


def wallace_t(sigmas: float, degrees_of_freedom: float) -> float:
    """Return Student's t, in standard errors, about as improbable as `sigmas` >= 0 of a Gaussian.

    The errors have these `degrees_of_freedom`. The inverse of `wallace_sigmas`: 2 sigma are 3.3
    standard errors for four values, 2.4 for nine, and 2 with infinitely many degrees of freedom.
    """
    dof = degrees_of_freedom
    if math.isinf(dof):
        return sigmas
    return math.sqrt(dof * math.expm1((sigmas / _wallace(dof)) ** 2 / dof))


def _wallace(degrees_of_freedom: float) -> float:
    """Return the factor of Wallace's formula, a number below 1: see `wallace_sigmas`."""
    return (8 * degrees_of_freedom + 1) / (8 * degrees_of_freedom + 3)
