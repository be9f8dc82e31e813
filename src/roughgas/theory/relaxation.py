"""How the two temperatures of a homogeneous gas approach their stationary ratio.

The rate equations are linear in (T_tr, T_rot) when time is counted in collisions per particle, n,
so their solution is exact: the part of the initial state off the stationary ratio fades as
exp(-Gamma n), Gamma the difference of the two eigenvalues. `spin_share` describes the drive as in
rate_equations. A drive is taken to replace at each moment the energy that collisions dissipate.
With one of constant power the energy may settle more slowly than theta, at the same stationary R.
"""

from typing import NamedTuple

import numpy as np

from roughgas.base.legal import Interval
from roughgas.theory.arguments import SHARE, Choice, Numbers, check
from roughgas.theory.haff import slow_decay
from roughgas.theory.rate_equations import collision_rates, stationary_shares
from roughgas.theory.shares import quotient


class Relaxation(NamedTuple):
    """Temperatures in units of the initial T_tr, and theta = T_rot/T_tr."""

    theta: np.ndarray
    T_tr: np.ndarray
    T_rot: np.ndarray


def relaxation_rate(
    r: Numbers, beta: Numbers, dimension: int = 2, inertia: Choice = None, spin_share: Choice = None
) -> np.ndarray:
    """Return Gamma, the rate at which theta relaxes, per collision per particle.

    From the linear stability of theta, and positive, except at beta = -1 (spin decoupled) where
    r = 1 or the drive is translational: theta then stays as it is and Gamma = 0. Raises InputError.
    """
    rates = collision_rates(r, beta, dimension, inertia)
    if spin_share is None:
        difference = rates.translational_loss - rates.rotational_loss
        return np.sqrt(difference**2 + 4 * rates.translational_gain * rates.rotational_gain)
    s = check("spin share of the drive", spin_share, SHARE)
    return s * (rates.translational_loss + rates.rotational_gain) + (1 - s) * (
        rates.rotational_loss + rates.translational_gain
    )


def relax(
    theta0: Numbers,
    r: Numbers,
    beta: Numbers,
    collisions: Numbers,
    dimension: int = 2,
    inertia: Choice = None,
    spin_share: Choice = None,
) -> Relaxation:
    """Return the temperatures after `collisions` (>= 0) per particle, from theta0 (>= 0) on.

    Exact solution of the rate equations: a mixture of the initial and the stationary state, of
    positive terms only. All arguments but D broadcast. Raises InputError.
    """
    theta0, n = check("theta0", theta0), check("collisions", collisions)
    translational, rotational = stationary_shares(r, beta, dimension, inertia, spin_share)
    weight = _stationary_weight(theta0, translational, rotational, dimension, spin_share)
    passed = relaxation_rate(r, beta, dimension, inertia, spin_share) * n
    old, new = np.exp(-passed), -np.expm1(-passed) * weight
    T_tr, T_rot = old + new * translational, theta0 * old + new * rotational
    decay = slow_decay(r, beta, dimension, inertia) if spin_share is None else 0.0
    scale = np.exp(-decay * n)
    return Relaxation(quotient(T_rot, T_tr), scale * T_tr, scale * T_rot)


def collisions_to_relax(
    r: Numbers,
    beta: Numbers,
    tolerance: Numbers = 0.01,
    dimension: int = 2,
    inertia: Choice = None,
    spin_share: Choice = None,
    theta0: Numbers = 0.0,
) -> np.ndarray:
    """Return collisions per particle until R is within a fraction `tolerance` of its limit.

    The limit is the stationary R; at first T_rot/T_tr = theta0. Infinite if R never gets there, as
    in a cooling gas without spin at beta = -1. All arguments but D broadcast. Raises InputError.
    """
    tolerance, theta0 = check("tolerance", tolerance, Interval("(0, 1)")), check("theta0", theta0)
    translational, rotational = stationary_shares(r, beta, dimension, inertia, spin_share)
    weight = _stationary_weight(theta0, translational, rotational, dimension, spin_share)
    distance = np.abs(theta0 * translational - rotational)
    near = tolerance * rotational
    gamma = relaxation_rate(r, beta, dimension, inertia, spin_share)
    with np.errstate(divide="ignore", over="ignore", invalid="ignore"):
        needed = np.log1p((distance - near * (1 + theta0)) / (near * weight)) / gamma
    return np.where(distance > near * (1 + theta0), needed, 0.0)[()]


def _stationary_weight(theta0, translational, rotational, dimension, spin_share):
    """Return the weight c of the stationary state in (1, theta0) = c (tr, rot) + c' (fast mode).

    The fast mode is (-rot, alpha tr) in a cooling gas, the product of the two theta that stay as
    they are being -alpha = -D/(2D-3); with a drive it is (-1, alpha), which carries no energy.
    """
    alpha = dimension / (2 * dimension - 3)
    fast = (rotational, translational) if spin_share is None else (1.0, 1.0)
    return (alpha * fast[1] + theta0 * fast[0]) / (
        alpha * fast[1] * translational + fast[0] * rotational
    )
