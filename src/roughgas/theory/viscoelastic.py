"""Viscoelastic particles: restitution r as a function of the normal speed g, and cooling.

r(g) is the Pade approximation of R. Ramirez, T. Poeschel, N. V. Brilliantov and T. Schwager, Phys.
Rev. E 60, 4465 (1999); it is fixed by `r` at one normal `speed` (a/T). Between Maxwellian particles
u = g^2/(4 T_tr/m) is distributed as exp(-u) over contacts, so contacts dissipate as much
translational energy as with the constant r_T, with

    1 - r_T^2 = integral of u exp(-u) [1 - r(2 sqrt(u T_tr/m))^2] du,

and the rate equations hold with r_T in place of r. If contacts are nearly elastic and dissipate
energy along the normal only, T_tr falls as t^(-5/3): T. Schwager and T. Poeschel, Phys. Rev. E 57,
650 (1998), N. V. Brilliantov and T. Poeschel, Phys. Rev. E 61, 5573 (2000).

R = T_rot/(T_rot + T_tr) is the share of rotational energy; beta is the roughness and `inertia`
q = I/(m a^2).
"""

import math
from typing import NamedTuple

import numpy as np

from roughgas.base import Interval
from roughgas.theory.arguments import POSITIVE, check, check_dimension, material, quotient
from roughgas.theory.closed_forms import cooling_ratio
from roughgas.theory.rate_equations import collision_rates, runge_kutta

PADE_NUMERATOR = 1.0, 2.583
"""Coefficients of powers of x in the numerator of the Pade approximation."""
PADE_DENOMINATOR = 1.0, 3.583, 2.983, 1.148, 0.326
LEGAL_RESTITUTION = Interval("(0, 1]")
LARGEST_NODE = 45.0 ** (1 / 10)
"""Upper limit of s in the integral over u = s^10, which makes it smooth; beyond it is < 1e-17."""
NODES, WEIGHTS = (np.polynomial.legendre.leggauss(80) + np.array([[1.0], [0.0]])) * LARGEST_NODE / 2
WEIGHTS = WEIGHTS * np.exp(-(NODES**10)) * 10 * NODES**19
MINIMUM_STEPS = 400
"""Smallest number of steps in the integration of the rate equations."""
STEPS_PER_E_FOLD = 20.0
"""Steps per e-fold of the fastest decay at the start."""


class Cooling(NamedTuple):
    """A cooling gas: collisions per particle, time (T), and temperatures (m a^2/T^2)."""

    collisions: np.ndarray
    time: np.ndarray
    T_tr: np.ndarray
    T_rot: np.ndarray


def viscoelastic_restitution(g, r, speed=1.0) -> np.ndarray:
    """Return the restitution at a normal speed `g` >= 0 of contacts that have `r` at `speed`.

    Both speeds are relative, in a/T.
    """
    g, speed = check("normal speed", g), check("speed", speed, POSITIVE)
    return _pade_restitution(_pade_argument(r) * (g / speed) ** 0.2)[()]


def maxwellian_restitution(T_tr, r, speed=1.0) -> np.ndarray:
    """Return r_T, the constant restitution that dissipates as much energy in a Maxwellian gas.

    `T_tr` is the temperature of translation in m a^2/T^2; contacts have the restitution `r` at the
    normal `speed` in a/T.
    """
    T_tr, speed = check("temperature T_tr", T_tr), check("speed", speed, POSITIVE)
    return np.sqrt(1 - _dissipated_share(_pade_argument(r) * (4 * T_tr / speed**2) ** 0.1))[()]


def viscoelastic_ratio(T_tr, r, beta, speed=1.0, dimension=2, inertia=None) -> np.ndarray:
    """Return R, the share of rotational energy, of a gas that cools at the temperature T_tr.

    R is computed by the theory of free cooling with r_T of `maxwellian_restitution`, which has the
    arguments `T_tr`, `r` and `speed`, at the roughness `beta`. R is assumed to follow the
    restitution without delay.
    """
    return cooling_ratio(maxwellian_restitution(T_tr, r, speed), beta, dimension, inertia)


def viscoelastic_time(T0, r, frequency, speed=1.0, dimension=2) -> np.ndarray:
    """Return the time tau of `viscoelastic_temperature`, in units of T; infinite at r = 1.

    `T0` is the initial T_tr in m a^2/T^2, `frequency` nu, the collisions per particle per T at T0,
    and `r` the restitution at the normal `speed` in a/T. With x_0 the Pade argument of r at
    `speed`, 1/tau = (6/(5 D)) nu x_0 (4 T_0/m)^(1/10) Gamma(21/10)/speed^(1/5), to first order in
    x: 1 - r(g)^2 = 2 x.
    """
    T0, nu = check("temperature T0", T0), check("frequency", frequency)
    speed, dimension = check("speed", speed, POSITIVE), check_dimension(dimension)
    x = _pade_argument(r) * (4 * T0 / speed**2) ** 0.1 * math.gamma(2.1)
    return quotient(5.0 * dimension, 6.0 * nu * x)


def viscoelastic_temperature(time, T0, r, frequency, speed=1.0, dimension=2) -> np.ndarray:
    """Return T_tr = T0 (1 + t/tau)^(-5/3) of smooth, nearly elastic viscoelastic particles.

    `time` t >= 0 is in units of T; `r` is the restitution at the normal `speed` in a/T.
    `frequency`: collisions per particle per T at T0. Perfectly rough particles, which lose no
    energy along the tangent either, share it among D + n_r degrees of freedom in place of D,
    n_r = 2 D - 3: their tau is longer by (D + n_r)/D once R = 1/2.
    """
    time = check("time", time)
    return check("temperature T0", T0) * (
        1 + time / viscoelastic_time(T0, r, frequency, speed, dimension)
    ) ** (-5 / 3)


def viscoelastic_cooling(
    collisions, T0, r, beta, frequency, speed=1.0, dimension=2, inertia=None, T_rot=0.0
) -> Cooling:
    """Return the solution of the rate equations with r_T over `collisions` per particle.

    It begins at T_tr = T0 (> 0) and `T_rot`, in m a^2/T^2; r (at the normal `speed` in a/T), beta
    and T0 are plain numbers, `frequency` the collisions per particle per T at T0. By the
    Runge-Kutta method of fourth order, in equal steps of collisions.
    """
    gas = material(r, beta, dimension, inertia)
    T0, final = check("temperature T0", T0, POSITIVE), float(check("collisions", collisions))
    nu = check("frequency", frequency, POSITIVE)
    x_0 = _pade_argument(r) / float(check("speed", speed, POSITIVE)) ** 0.2
    rough = collision_rates(1.0, *gas[1:])

    def slope(state):
        """Return the derivatives of (time, T_tr, T_rot) by collisions per particle."""
        _, T_tr, T_rot = state
        of_tr, of_rot = rough.changes(T_tr, T_rot)
        of_tr = of_tr - _dissipated_share(x_0 * (4 * T_tr) ** 0.1) * T_tr / gas.dimension
        return np.array([np.sqrt(T0 / T_tr) / nu, of_tr, of_rot])

    fastest = (
        _dissipated_share(x_0 * (4 * T0) ** 0.1) + rough.translational_loss + rough.rotational_loss
    )
    steps = MINIMUM_STEPS + math.ceil(STEPS_PER_E_FOLD * fastest * final)
    states, step = [np.array([0.0, T0, T_rot])], final / steps
    for _ in range(steps):
        states.append(runge_kutta(slope, states[-1], step))
    return Cooling(np.linspace(0.0, final, steps + 1), *np.array(states).T)


def _dissipated_share(x):
    """Return 1 - r_T^2, the share of the normal kinetic energy that contacts dissipate on average.

    `x` is the Pade argument at the normal speed 2 sqrt(T_tr/m).
    """
    return ((1 - _pade_restitution(np.multiply.outer(x, NODES)) ** 2) * WEIGHTS).sum(-1)


def _pade_restitution(x):
    """Return the restitution of a contact by the Pade approximation with argument `x`."""
    return np.polynomial.polynomial.polyval(x, PADE_NUMERATOR) / np.polynomial.polynomial.polyval(
        x, PADE_DENOMINATOR
    )


def _pade_argument(r):
    """Return the argument x >= 0 for which the Pade approximation equals `r`, in (0, 1].

    It is found by Newton's method from above: x is the only positive root of a convex polynomial.
    """
    r = np.asarray(check("restitution r", r, LEGAL_RESTITUTION))
    polynomial = np.multiply.outer(PADE_DENOMINATOR, r)
    polynomial[0] -= PADE_NUMERATOR[0]
    polynomial[1] -= PADE_NUMERATOR[1]
    slope = polynomial[1:] * np.arange(1.0, len(PADE_DENOMINATOR)).reshape(-1, *[1] * r.ndim)
    x = 2 * np.cbrt(PADE_NUMERATOR[1] / (PADE_DENOMINATOR[-1] * r))  # beyond the root
    for _ in range(60):
        value = np.polynomial.polynomial.polyval(x, polynomial, tensor=False)
        x = np.maximum(x - value / np.polynomial.polynomial.polyval(x, slope, tensor=False), 0.0)
    return x
