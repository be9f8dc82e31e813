"""How far velocities and spins of a homogeneous gas are from Maxwellian ones, and R with that.

The Sonine approximation: the distribution of V and w is Maxwellian, of temperatures T_tr and T_rot,
times 1 + a20 S20 + a11 S11 + a02 S02, to first order in the cumulants (see `Cumulants`); nothing is
fitted. For spheres it is A. Santos, G. M. Kremer & M. dos Santos, Phys. Fluids 23, 030604 (2011),
and with a fourth term, the alignment of V and w, F. Vega Reyes, A. Santos & G. M. Kremer, Phys.
Rev. E 89, 020202 (2014); for disks and spheres A. Megias & A. Santos, Phys. Rev. E 108, 014902
(2023). Its limit of smooth particles is T. P. C. van Noije & M. H. Ernst, Granular Matter 1, 57
(1998).

The collision integrals are not copied from there. A gas of two halves, Maxwellian with T_tr (1 + e)
and T_rot (1 + d) and with T_tr (1 - e) and T_rot (1 - d), has a20 = e^2, a11 = e d and a02 = d^2 to
this order, so that the rate at which a moment changes is needed of Gaussian pairs alone, and its
second derivatives by temperatures. In the same way cov(v_i, w_i) = +-rho stands for an alignment.
Rates are per collision per particle of the Maxwellian gas; unit: T_tr = m = a = 1.
"""

from typing import NamedTuple

import numpy as np

from roughgas.theory.arguments import check, material, quotient
from roughgas.theory.rate_equations import Rates, balanced_shares, collision_rates

CIRCLE = 0.1 * np.exp(2j * np.pi * np.arange(12) / 12)
"""Where Cauchy's formula is summed; what it leaves out is of order (0.1/2)^12."""
ITERATIONS = 200
PRECISION = 1e-13
FAR = 1e-6
"""Farther from the Maxwellian theta, as a factor, the approximation has no meaning."""


class Cumulants(NamedTuple):
    """R and the cumulants of a stationary gas; these vanish where all is Maxwellian.

    a20 = D <V^4>/[(D + 2) <V^2>^2] - 1,    a02 = n <w^4>/[(n + 2) <w^2>^2] - 1,  n = 2 D - 3,
    a11 = <V^2 w^2>/(<V^2> <w^2>) - 1,      alignment = 3 <(V.w)^2>/<V^2 w^2> - 1  (0 for disks).
    """

    R: np.ndarray
    a20: np.ndarray
    a11: np.ndarray
    a02: np.ndarray
    alignment: np.ndarray


def sonine_state(r, beta, dimension=2, inertia=None, spin_share=None) -> Cumulants:
    """Return R and the cumulants of a gas that cools, or of one that white noise drives.

    The drive consists of weak independent kicks, and a share `spin_share` of its power goes into
    spin; None: no drive, and ratios of moments are stationary. All is NaN where moments do not
    settle, or where they settle at values that no distribution has: in a cooling gas <w^4> has no
    limit at some beta below 0. At beta = -1, where spins are decoupled, R is that of
    `stationary_ratio`, and only a20 is known.
    """
    gas, share = material(r, beta, dimension, inertia), np.asarray(0.0)
    if spin_share is not None:
        share = check("spin share of the drive", spin_share)
    D, (r, beta, q, share) = gas.dimension, np.broadcast_arrays(gas.r, gas.beta, gas.inertia, share)
    drive = None if spin_share is None else share
    R, a, settled = _settled(r, beta, D, q, drive)
    rough = beta > -1
    R = np.where(settled | ~rough, R, np.nan)
    a = np.where((settled | ~rough)[..., None], a, np.nan)
    a[..., 1:] = np.where(rough[..., None], a[..., 1:], np.nan)
    a20, a11, a02 = (a[..., k][()] for k in range(3))
    alignment = 0 * a11 if D == 2 else (a[..., 3] / (1 + a11))[()]
    return Cumulants(R[()], a20, a11, a02, alignment)


def _settled(r, beta, dimension, q, drive) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return R, the cumulants (..., 3 or 4), and whether a gas settles there.

    Cumulants are found at the theta that balances energies, and theta anew with these, until it
    stays. Where spins are decoupled theta does not matter, and R is left as it is.
    """
    rates, rough = collision_rates(r, beta, dimension, q), beta > -1
    translational, R = balanced_shares(rates, dimension, q, drive)
    x = np.where(rough, quotient(R, translational), 1.0) / q
    changes = _in_powers(x, r, beta, dimension, q)
    part, stays = np.ones_like(x), ~rough
    for _ in range(ITERATIONS):
        constant, matrix = _system(changes, part, x, dimension, drive is None)
        a = _stationary(constant, matrix, rough)
        before, balanced = R, balanced_shares(_corrected(rates, a), dimension, q, drive)
        R = np.where(rough, balanced[1], before)
        stays = np.abs(R - before) <= PRECISION * R
        if stays.all():
            break
        part = np.where(rough, np.clip(quotient(*balanced[::-1]) / (q * x), FAR, 1 / FAR), 1.0)
    # cumulants that were disturbed go back, and are those of moments: <V^4> >= <V^2>^2 ...
    returns = np.linalg.eigvals(matrix).real.max(axis=-1) < 0
    least = -2 / (dimension + 2), -1.0, -2 / (2 * dimension - 1)
    return R, a, stays & returns & (a[..., :3] >= least).all(axis=-1)


def _corrected(rates: Rates, a) -> Rates:
    """Return the rates in a gas of cumulants `a`, (..., 3 or 4), to first order.

    Fast particles collide more often: over collisions the squares of the normal and tangential
    velocity are larger than in a Maxwellian gas, that of the spin where fast particles spin faster.
    """
    a20, a11, _, *aligned = np.moveaxis(a, -1, 0)
    of_velocity = 1 + 3 / 16 * a20
    of_spin = 1 - a20 / 16 + (a11 - (aligned[0] / 5 if aligned else 0.0)) / 4
    factors = of_velocity, of_spin, of_velocity, of_spin
    return Rates(*(np.maximum(x * y, 0.0) for x, y in zip(rates, factors, strict=True)))


def _in_powers(x, r, beta, dimension, q) -> np.ndarray:
    """Return `moment_changes` at a part p of x as coefficients of 1, p and p^2, shape (3, ...)."""
    none, one, two = (moment_changes(part * x, r, beta, dimension, q) for part in (0, 1, 2))
    square = (two - 2 * one + none) / 2
    return np.stack([none, one - none - square, square])


def _system(changes, part, x, dimension, cools) -> tuple[np.ndarray, np.ndarray]:
    """Return (..., n) and (..., n, n): the rates at which cumulants change in a Maxwellian gas, and
    by each of the n = 3 or 4 cumulants.

    The last of four is 3 <(V.w)^2>/(<V^2> <w^2>) less 1 + a11. Kicks replace the energy that
    contacts take but no cumulant; in a gas that cools all moments of an order fall alike.
    """
    none, one, square = changes
    x, part = x[..., None, None], part[..., None, None]
    rates = (none + part * (one + part * square)) / maxwellian_moments(x * part, dimension)
    of_V, of_w, *fourth = np.moveaxis(rates, -1, 0)
    falls = [2 * of_V, of_V + of_w, 2 * of_w, of_V + of_w][: len(fourth)]
    system = np.stack([one - fall for one, fall in zip(fourth, falls, strict=True)], axis=-2)
    if cools:
        for k, fall in enumerate(falls):
            system[..., k, 1 + k] -= fall[..., 0]
        if dimension == 3:
            system[..., 3, 2] -= falls[3][..., 0]
    return system[..., 0], system[..., 1:]


def _stationary(constant, matrix, rough) -> np.ndarray:
    """Return the cumulants that do not change; without contacts of spins that is a20 alone."""
    apart = np.eye(constant.shape[-1])
    apart[0, 0] = 0.0
    matrix = np.where(rough[..., None, None], matrix, matrix * (1 - apart) + apart)
    return -np.linalg.solve(matrix, constant[..., None])[..., 0]


def moment_changes(x, r, beta, dimension, q) -> np.ndarray:
    """Return the rates at which contacts change moments, to first order in the cumulants.

    Shape (..., 1 + cumulants, moments): of a Maxwellian gas, then by a20, a11, a02 and, of spheres,
    by the alignment. The moments are <V^2>, <w^2>, <V^4>, <V^2 w^2>, <w^4> and, of spheres,
    <(V.w)^2>; w is the surface velocity a omega, and x = T_rot/(q T_tr).
    """
    eta = q * (1 + beta) / (2 * (1 + q))
    contact = (1 + r) / 2, eta, eta / q
    nothing = 0.0, 0 * eta, 0 * eta

    def change(*pair):
        after, before = (moments_at_contact(*pair, *one, dimension) for one in (contact, nothing))
        return np.stack([one - other for one, other in zip(after, before, strict=True)], axis=-1)

    def second(T, spin, rho=0):
        """Return the second order in e, at T_tr (1 + e T) and so on of either particle."""
        e = CIRCLE.reshape(-1, *(1,) * np.ndim(x))
        hot, spins, both = 1 + e * T, x * (1 + e * spin), e * rho * np.sqrt(x)
        found = change(hot, 1.0, spins, x, both) + change(1.0, hot, x, spins, 0.0)
        return np.mean(found / e[..., None] ** 2, axis=0).real

    a20, a02 = second(1, 0), second(0, 1)
    a11 = second(1, 1) - a20 - a02
    orders = [change(1.0, 1.0, x, x, 0.0), a20, a11, a02]
    if dimension == 3:  # cov(v_i, w_i) = rho has a11 = 2 rho^2/(3 x), alignment 10 rho^2/(3 x)
        orders.append(0.3 * (second(0, 0, 1) - 2 / 3 * a11))
    return np.stack(orders, axis=-2)


def maxwellian_moments(x, dimension) -> np.ndarray:
    """Return the moments of `moment_changes` in a Maxwellian gas, (..., moments); x is (..., 1)."""
    D, n = dimension, 2 * dimension - 3
    found = [D + 0 * x, n * x, D * (D + 2) + 0 * x, D * n * x, n * (n + 2) * x**2]
    return np.concatenate(found if D == 2 else [*found, D * x], axis=-1)


def moments_at_contact(T1, T2, x1, x2, rho, normal, eta, turn, dimension) -> list:
    """Return the moments of the first of two particles after their contacts, times how often two of
    them collide, in units of how often a pair of T = 1 does.

    Components of velocities are Gaussian of the variances T1 and T2, of spins x1 and x2; rho is
    cov(v_i, w_i) of the first. With n along the line of centres, v' = v - `normal` g_n n - `eta`
    g_t and w' x n = w x n + `turn` g_t; in terms of u = w x n, g_t = v1_t - v2_t - u1 - u2. Over
    contacts, which are as frequent as |g_n| is large, <g_n^2> = 2 s and <g_n^4> = 8 s^2, s = T1 +
    T2: as if Gaussian with twice the variance and the fourth cumulant -4 s^2.
    """
    across = dimension - 1
    spins_along = dimension - 2  # spheres spin about the line of centres, too
    s = T1 + T2
    with_g = (1 - normal) * T1 - normal * T2  # cov(v_n', g_n)
    V = (1 - normal) ** 2 * T1 + normal**2 * T2 + with_g**2 / s
    Vw, w = (1 - normal + with_g / s) * rho, x1 + rho**2 / s
    V4 = 3 * V**2 - 4 * (with_g**2 / s) ** 2
    V2w2 = V * w + 2 * Vw**2 - 4 * (with_g * rho / s) ** 2
    w4 = 3 * w**2 - 4 * (rho**2 / s) ** 2

    t = (1 - eta) ** 2 * T1 + eta**2 * (T2 + x1 + x2)  # of a component of v_t'
    u = (1 - turn) ** 2 * x1 + turn**2 * (x2 + T1 + T2)
    tu = turn * (1 - eta) * T1 + eta * (1 - turn) * x1 - eta * turn * (T2 + x2)
    turned = (1 - eta - turn) * rho  # covariance of v_t' and w_t', not w' x n, by components
    t4, u4 = (across * (across + 2) * one**2 for one in (t, u))
    t2u2 = across**2 * t * u + 2 * across * tu**2 + 4 * spins_along * turned**2

    found = [
        V + across * t,
        spins_along * w + across * u,
        V4 + 2 * across * V * t + t4,
        spins_along * (V2w2 + across * t * w) + across * V * u + t2u2,
        spins_along * (w4 + 2 * across * w * u) + u4,
    ]
    if dimension == 3:
        found.append(V2w2 + 4 * Vw * turned + 6 * turned**2 + 2 * t * u - 2 * tu**2)
    return [np.sqrt(s / 2) * one for one in found]
