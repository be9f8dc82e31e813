"""Viscoelastic particles: r falls with the normal speed g, and how their gas cools.

r(g) is the Pade approximation of R. Ramirez, T. Poeschel, N. V. Brilliantov and T. Schwager, Phys.
Rev. E 60, 4465 (1999); it is fixed by `r` at one normal `speed` (a/T). Between Maxwellian particles
g^2/(4 T_tr/m) is distributed as exp(-u) over contacts, so the translational energy that a contact
takes is that of the constant r_T, with

    1 - r_T^2 = integral of u exp(-u) [1 - r(2 sqrt(u T_tr/m))^2] du,

and the rate equations hold with r_T in r's place. Where contacts are nearly elastic, T_tr of a gas
that loses energy along the normal alone falls as t^(-5/3): T. Schwager and T. Poeschel, Phys. Rev.
E 57, 650 (1998), N. V. Brilliantov and T. Poeschel, Phys. Rev. E 61, 5573 (2000).
"""

import math
from typing import NamedTuple

import numpy as np

from roughgas.base import Interval
from roughgas.theory.arguments import POSITIVE, check, check_dimension, material, quotient
from roughgas.theory.closed_forms import cooling_ratio
from roughgas.theory.rate_equations import collision_rates, runge_kutta

ABOVE = 1.0, 2.583
"""Coefficients of powers of x above, and below, in the Pade approximation."""
BELOW = 1.0, 3.583, 2.983, 1.148, 0.326
INSIDE = Interval("(0, 1]")
FARTHEST = 45.0 ** (1 / 10)
"""u = s^10 makes the integrand smooth; beyond this s it is below 1e-17."""
ROOTS, WEIGHTS = (np.polynomial.legendre.leggauss(80) + np.array([[1.0], [0.0]])) * FARTHEST / 2
WEIGHTS = WEIGHTS * np.exp(-(ROOTS**10)) * 10 * ROOTS**19
STEPS = 400
"""Steps in which the rate equations are integrated, at least."""
PER_FOLD = 20.0
"""Steps to the e-fold that is the fastest at the start."""


class Cooling(NamedTuple):
    """A cooling gas: collisions per particle, time (T), and temperatures (m a^2/T^2)."""

    collisions: np.ndarray
    time: np.ndarray
    T_tr: np.ndarray
    T_rot: np.ndarray


def viscoelastic_restitution(g, r, speed=1.0) -> np.ndarray:
    """Return the restitution at a normal speed `g` >= 0 of contacts that have `r` at `speed`."""
    g, speed = check("normal speed", g), check("speed", speed, POSITIVE)
    return _pade(_x_of(r) * (g / speed) ** 0.2)[()]


def maxwellian_restitution(T_tr, r, speed=1.0) -> np.ndarray:
    """Return r_T, the constant restitution by which Maxwellian particles lose as much energy."""
    T_tr, speed = check("temperature T_tr", T_tr), check("speed", speed, POSITIVE)
    return np.sqrt(1 - _lost(_x_of(r) * (4 * T_tr / speed**2) ** 0.1))[()]


def viscoelastic_ratio(T_tr, r, beta, speed=1.0, dimension=2, inertia=None) -> np.ndarray:
    """Return R of a cooling gas at T_tr, which follows its restitution without delay: that of the
    theory of free cooling with r_T."""
    return cooling_ratio(maxwellian_restitution(T_tr, r, speed), beta, dimension, inertia)


def viscoelastic_time(T0, r, frequency, speed=1.0, dimension=2) -> np.ndarray:
    """Return tau of `viscoelastic_temperature`, in T; infinite at r = 1.

    With x_0 that of r at `speed`, 1/tau = (6/(5 D)) nu x_0 (4 T_0/m)^(1/10) Gamma(21/10) /
    speed^(1/5), to first order in x: 1 - r(g)^2 = 2 x.
    """
    T0, nu = check("temperature T0", T0), check("frequency", frequency)
    speed, dimension = check("speed", speed, POSITIVE), check_dimension(dimension)
    x = _x_of(r) * (4 * T0 / speed**2) ** 0.1 * math.gamma(2.1)
    return quotient(5.0 * dimension, 6.0 * nu * x)


def viscoelastic_temperature(time, T0, r, frequency, speed=1.0, dimension=2) -> np.ndarray:
    """Return T_tr = T0 (1 + t/tau)^(-5/3), of smooth, nearly elastic viscoelastic particles.

    `frequency`: collisions per particle per time at T0. Perfectly rough particles, which lose no
    energy along the tangent either, share it among D + n_r degrees of freedom in place of D, n_r
    = 2 D - 3: their tau is longer by (D + n_r)/D once R = 1/2.
    """
    time = check("time", time)
    return check("temperature T0", T0) * (
        1 + time / viscoelastic_time(T0, r, frequency, speed, dimension)
    ) ** (-5 / 3)


def viscoelastic_cooling(
    collisions, T0, r, beta, frequency, speed=1.0, dimension=2, inertia=None, T_rot=0.0
) -> Cooling:
    """Return the solution of the rate equations with r_T up to so many `collisions` per particle.

    It begins at T_tr = T0 (> 0) with the given T_rot; r, beta and T0 are plain numbers,
    `frequency` the collisions per particle per time at T0. Runge and Kutta's fourth-order method,
    in equal steps of collisions.
    """
    gas = material(r, beta, dimension, inertia)
    T0, last = check("temperature T0", T0, POSITIVE), float(check("collisions", collisions))
    nu = check("frequency", frequency, POSITIVE)
    x_0 = _x_of(r) / float(check("speed", speed, POSITIVE)) ** 0.2
    rough = collision_rates(1.0, *gas[1:])

    def slope(state):
        _, T_tr, T_rot = state
        of_tr, of_rot = rough.changes(T_tr, T_rot)
        of_tr = of_tr - _lost(x_0 * (4 * T_tr) ** 0.1) * T_tr / gas.dimension
        return np.array([np.sqrt(T0 / T_tr) / nu, of_tr, of_rot])

    fastest = _lost(x_0 * (4 * T0) ** 0.1) + rough.translational_loss + rough.rotational_loss
    steps = STEPS + math.ceil(PER_FOLD * fastest * last)
    states, step = [np.array([0.0, T0, T_rot])], last / steps
    for _ in range(steps):
        states.append(runge_kutta(slope, states[-1], step))
    return Cooling(np.linspace(0.0, last, steps + 1), *np.array(states).T)


def _lost(x):
    """Return 1 - r_T^2, x being that of a contact at the speed 2 sqrt(T_tr/m)."""
    return ((1 - _pade(np.multiply.outer(x, ROOTS)) ** 2) * WEIGHTS).sum(-1)


def _pade(x):
    return np.polynomial.polynomial.polyval(x, ABOVE) / np.polynomial.polynomial.polyval(x, BELOW)


def _x_of(r):
    """Return x >= 0 with the Pade approximation r, in (0, 1], by Newton's method from above.

    It is the only positive root of a convex polynomial.
    """
    r = np.asarray(check("restitution r", r, INSIDE))
    below = np.multiply.outer(BELOW, r)
    below[0] -= ABOVE[0]
    below[1] -= ABOVE[1]
    slope = below[1:] * np.arange(1.0, len(BELOW)).reshape(-1, *[1] * r.ndim)
    x = 2 * np.cbrt(ABOVE[1] / (BELOW[-1] * r))  # beyond the root
    for _ in range(60):
        value = np.polynomial.polynomial.polyval(x, below, tensor=False)
        x = np.maximum(x - value / np.polynomial.polynomial.polyval(x, slope, tensor=False), 0.0)
    return x
