"""How the two temperatures approach their stationary ratio, and decay from there on: Haff's law.

The rate equations are linear in (T_tr, T_rot) when time is counted in collisions per particle, n,
so their solution is exact: the part of the initial state off the stationary ratio fades as
exp(-Gamma n), Gamma the difference of the two eigenvalues. `spin_share` describes the drive as in
rate_equations. A drive is taken to replace at each moment the energy that collisions dissipate.
With one of constant power the energy may settle more slowly than theta, at the same stationary R.
"""

from typing import NamedTuple

import numpy as np

from roughgas.base import Interval
from roughgas.theory.arguments import check, material
from roughgas.theory.rate_equations import collision_rates, stationary_shares
from roughgas.theory.shares import quotient


class Relaxation(NamedTuple):
    """Temperatures in units of the initial T_tr, and theta = T_rot/T_tr."""

    theta: np.ndarray
    T_tr: np.ndarray
    T_rot: np.ndarray


def relaxation_rate(r, beta, dimension=2, inertia=None, spin_share=None) -> np.ndarray:
    """Return Gamma, the rate at which theta relaxes, per collision per particle.

    From the linear stability of theta, and positive, except at beta = -1 (spin decoupled) where
    r = 1 or the drive is translational: theta then stays as it is and Gamma = 0.
    """
    rates = collision_rates(r, beta, dimension, inertia)
    if spin_share is None:
        difference = rates.translational_loss - rates.rotational_loss
        return np.sqrt(difference**2 + 4 * rates.translational_gain * rates.rotational_gain)
    s = check("spin share of the drive", spin_share)
    return s * (rates.translational_loss + rates.rotational_gain) + (1 - s) * (
        rates.rotational_loss + rates.translational_gain
    )


def relax(theta0, r, beta, collisions, dimension=2, inertia=None, spin_share=None) -> Relaxation:
    """Return the temperatures after `collisions` (>= 0) per particle, from theta0 (>= 0) on.

    Exact solution of the rate equations: a mixture of the initial and the stationary state, of
    positive terms only.
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
    r, beta, tolerance=0.01, dimension=2, inertia=None, spin_share=None, theta0=0.0
) -> np.ndarray:
    """Return collisions per particle until R is within a fraction `tolerance` of its limit.

    The limit is the stationary R; at first T_rot/T_tr = theta0. Infinite if R never gets there, as
    in a cooling gas without spin at beta = -1.
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


def haff_temperature(time, T0, r, beta, frequency, dimension=2, inertia=None) -> np.ndarray:
    """Return T_tr = T0/(1 + t/t_h)^2 at `time` >= 0, from T_tr = T0 and the stationary R on.

    `frequency`: collisions per particle per time at T0, e.g. `collision_frequency(T0, packing)`.
    T_rot decays by the same factor.
    """
    time, T0 = check("time", time), check("temperature T0", T0)
    return T0 / (1 + time / haff_time(r, beta, frequency, dimension, inertia)) ** 2


def haff_time(r, beta, frequency, dimension=2, inertia=None) -> np.ndarray:
    """Return t_h = 2/(frequency * decay_rate), nu being ~ sqrt(T_tr); inf if nothing decays.

    `frequency` (> 0, 1/T) is that at the initial temperature.
    """
    decay = decay_rate(r, beta, dimension, inertia)
    return quotient(2.0, check("frequency", frequency) * decay)


def decay_rate(r, beta, dimension=2, inertia=None) -> np.ndarray:
    """Return -d ln T_tr/dn at the stationary R of a cooling gas, n in collisions per particle.

    At beta = -1 it is that of the smooth gas, (1 - r^2)/D, whose spin has no effect. The limit
    beta -> -1 would be 0, since spin, which hardly decays there, feeds translation.
    """
    r, beta, dimension, q = material(r, beta, dimension, inertia)
    smooth = (1 - r) * (1 + r) / dimension
    return np.where(beta == -1, smooth, slow_decay(r, beta, dimension, q))[()]


def slow_decay(r, beta, dimension=2, inertia=None) -> np.ndarray:
    """Return the decay rate of the slower mode of a cooling gas, per collision per particle.

    The product of both rates is a sum of positive terms, so nothing cancels.
    """
    r, beta, dimension, q = material(r, beta, dimension, inertia)
    rates = collision_rates(r, beta, dimension, q)
    spin_loss, spin_gain = rates.rotational_loss, rates.rotational_gain
    product = (1 - r) * (1 + r) * spin_loss + (dimension - 1) * (1 - beta) * spin_gain
    both = rates.translational_loss + spin_loss
    return quotient(2 * (product / dimension), both + relaxation_rate(r, beta, dimension, q))
