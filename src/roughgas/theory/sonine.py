"""Cumulants of velocities and spins of a homogeneous gas, and R, in the Sonine approximation.

The distribution of V and w is Maxwellian, of temperatures T_tr and T_rot, times 1 + a20 S20 +
a11 S11 + a02 S02, to first order in the cumulants (see `Cumulants`); nothing is fitted. Published
for spheres by A. Santos, G. M. Kremer & M. dos Santos, Phys. Fluids 23, 030604 (2011), with a
fourth term, the alignment of V and w, by F. Vega Reyes, A. Santos & G. M. Kremer, Phys. Rev. E 89,
020202 (2014); for disks and spheres by A. Megias & A. Santos, Phys. Rev. E 108, 014902 (2023). Its
limit of smooth particles is T. P. C. van Noije & M. H. Ernst, Granular Matter 1, 57 (1998).

The collision integrals are not copied from these papers. A gas of two halves, Maxwellian with T_tr
(1 + e) and T_rot (1 + d) and with T_tr (1 - e) and T_rot (1 - d), has a20 = e^2, a11 = e d and
a02 = d^2 to this order. So the rates of change of moments are only needed for Gaussian pairs, with
their second derivatives by temperatures. In the same way cov(v_i, w_i) = +-rho represents an
alignment. Rates are per collision per particle of the Maxwellian gas; unit: T_tr = m = a = 1.

R = T_rot/(T_rot + T_tr) is the share of rotational energy, theta = T_rot/T_tr; r is the normal
restitution, beta the roughness, q = I/(m a^2), D the number of dimensions.
"""

from typing import NamedTuple

import numpy as np

from roughgas.theory.arguments import check, material, quotient
from roughgas.theory.rate_equations import Rates, balanced_shares, collision_rates

CONTOUR = 0.1 * np.exp(2j * np.pi * np.arange(12) / 12)
"""Points at which Cauchy's integral formula is summed; the error is of order (0.1/2)^12."""
ITERATIONS = 200
R_PRECISION = 1e-13
SMALLEST_THETA_FACTOR = 1e-6
"""Bound of theta over the Maxwellian theta, or its inverse, for a meaningful approximation."""


class Cumulants(NamedTuple):
    """R and the cumulants of a stationary gas; cumulants of a Maxwellian distribution vanish.

    R is the share of rotational energy, V the velocity and w the spin.

    a20 = D <V^4>/[(D + 2) <V^2>^2] - 1,    a02 = n <w^4>/[(n + 2) <w^2>^2] - 1,  n = 2 D - 3,
    a11 = <V^2 w^2>/(<V^2> <w^2>) - 1,      alignment = 3 <(V.w)^2>/<V^2 w^2> - 1  (0 for disks).
    """

    R: np.ndarray
    a20: np.ndarray
    a11: np.ndarray
    a02: np.ndarray
    alignment: np.ndarray


def sonine_state(r, beta, dimension=2, inertia=None, spin_share=None) -> Cumulants:
    """Return R and the cumulants of a cooling gas, or of a gas driven by white noise.

    R is the share of rotational energy. The drive consists of weak independent kicks, and a share
    `spin_share` of its power goes into spin; None: no drive, and ratios of moments are stationary.
    All results have the broadcast shape of the arguments. They are NaN where moments do not
    converge, or converge to values that no distribution has: in a cooling gas <w^4> has no limit at
    some beta below 0. At beta = -1, where spins are decoupled, R is `stationary_ratio`, and a20 is
    the only cumulant that is not NaN.
    """
    gas, share = material(r, beta, dimension, inertia), np.asarray(0.0)
    if spin_share is not None:
        share = check("spin share of the drive", spin_share)
    D, (r, beta, q, share) = gas.dimension, np.broadcast_arrays(gas.r, gas.beta, gas.inertia, share)
    drive = None if spin_share is None else share
    R, cumulants, settled = _stationary_state(r, beta, D, q, drive)
    rough = beta > -1
    R = np.where(settled | ~rough, R, np.nan)
    cumulants = np.where((settled | ~rough)[..., None], cumulants, np.nan)
    cumulants[..., 1:] = np.where(rough[..., None], cumulants[..., 1:], np.nan)
    a20, a11, a02 = (cumulants[..., k][()] for k in range(3))
    alignment = 0 * a11 if D == 2 else (cumulants[..., 3] / (1 + a11))[()]
    return Cumulants(R[()], a20, a11, a02, alignment)


def _stationary_state(r, beta, dimension, q, drive) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return R, the cumulants (..., 3 or 4), and whether this state is stable and physical.

    `drive` is the spin share of the power of the drive, None in a cooling gas; `q` is I/(m a^2).
    The cumulants are a20, a11, a02 and, for spheres, the fourth of `_cumulant_equations`. Iterates
    until R is constant: cumulants at the theta that balances energies, then theta with these
    cumulants. Where spins are decoupled theta does not matter, and R keeps its initial value.
    """
    rates, rough = collision_rates(r, beta, dimension, q), beta > -1
    translational, R = balanced_shares(rates, dimension, q, drive)
    x = np.where(rough, quotient(R, translational), 1.0) / q
    changes = _changes_in_powers(x, r, beta, dimension, q)
    theta_factor, converged = np.ones_like(x), ~rough
    for _ in range(ITERATIONS):
        constant, matrix = _cumulant_equations(changes, theta_factor, x, dimension, drive is None)
        cumulants = _stationary(constant, matrix, rough)
        previous_R, balanced = (
            R,
            balanced_shares(_corrected_rates(rates, cumulants), dimension, q, drive),
        )
        R = np.where(rough, balanced[1], previous_R)
        converged = np.abs(R - previous_R) <= R_PRECISION * R
        if converged.all():
            break
        theta_factor = np.where(
            rough,
            np.clip(
                quotient(*balanced[::-1]) / (q * x),
                SMALLEST_THETA_FACTOR,
                1 / SMALLEST_THETA_FACTOR,
            ),
            1.0,
        )
    # stable against disturbances, and cumulants of possible moments: <V^4> >= <V^2>^2 ...
    finite, finite_matrix = _replaced_if_infinite(matrix)
    stable = finite & (np.linalg.eigvals(finite_matrix).real.max(axis=-1) < 0)
    lower_bounds = -2 / (dimension + 2), -1.0, -2 / (2 * dimension - 1)
    return R, cumulants, converged & stable & (cumulants[..., :3] >= lower_bounds).all(axis=-1)


def _corrected_rates(rates: Rates, cumulants) -> Rates:
    """Return the coefficients of the rate equations in a gas with `cumulants`, to first order.

    `rates` hold for a Maxwellian gas, `cumulants` (..., 3 or 4) are as in `_stationary_state`.
    Fast particles collide more often: averaged over collisions, the squares of the normal and
    tangential velocity exceed their values in a Maxwellian gas; so does the square of the spin if
    fast particles spin faster.
    """
    a20, a11, _, *alignment = np.moveaxis(cumulants, -1, 0)
    velocity_factor = 1 + 3 / 16 * a20
    spin_factor = 1 - a20 / 16 + (a11 - (alignment[0] / 5 if alignment else 0.0)) / 4
    factors = velocity_factor, spin_factor, velocity_factor, spin_factor
    return Rates(*(np.maximum(x * y, 0.0) for x, y in zip(rates, factors, strict=True)))


def _changes_in_powers(x, r, beta, dimension, q) -> np.ndarray:
    """Return `moment_changes` at p x as its coefficients of 1, p and p^2, shape (3, ...).

    x = T_rot/(q T_tr), and p is any factor.
    """
    at_zero, at_one, at_two = (
        moment_changes(factor * x, r, beta, dimension, q) for factor in (0, 1, 2)
    )
    quadratic = (at_two - 2 * at_one + at_zero) / 2
    return np.stack([at_zero, at_one - at_zero - quadratic, quadratic])


def _cumulant_equations(
    changes, theta_factor, x, dimension, cools
) -> tuple[np.ndarray, np.ndarray]:
    """Return the vector b (..., n) and matrix A (..., n, n) of d(cumulants)/dn = b + A cumulants.

    n = 3 or 4; the fourth cumulant is 3 <(V.w)^2>/(<V^2> <w^2>) less 1 + a11. `changes` are the
    coefficients of `_changes_in_powers` at `x` = T_rot/(q T_tr), which is multiplied by
    `theta_factor` here; `cools`: whether the gas has no drive. Kicks replace the energy that
    contacts dissipate, and no cumulants; in a cooling gas the moments of an order fall at the same
    rate.
    """
    constant, linear, quadratic = changes
    x, theta_factor = x[..., None, None], theta_factor[..., None, None]
    with np.errstate(divide="ignore", invalid="ignore"):  # moments of spins may be inf or NaN
        rates = (
            constant + theta_factor * (linear + theta_factor * quadratic)
        ) / maxwellian_moments(x * theta_factor, dimension)
    V2_rate, w2_rate, *fourth_moments = np.moveaxis(rates, -1, 0)
    normaliser_rates = [2 * V2_rate, V2_rate + w2_rate, 2 * w2_rate, V2_rate + w2_rate][
        : len(fourth_moments)
    ]
    system = np.stack(
        [
            change - normaliser_rate
            for change, normaliser_rate in zip(fourth_moments, normaliser_rates, strict=True)
        ],
        axis=-2,
    )
    if cools:
        for k, normaliser_rate in enumerate(normaliser_rates):
            system[..., k, 1 + k] -= normaliser_rate[..., 0]
        if dimension == 3:
            system[..., 3, 2] -= normaliser_rates[3][..., 0]
    return system[..., 0], system[..., 1:]


def _stationary(constant, matrix, rough) -> np.ndarray:
    """Return the stationary cumulants, 0 = b + A cumulants; only a20 where spins are decoupled.

    `constant` is b (..., n), `matrix` A (..., n, n), `rough` whether contacts change spins. NaN
    where cumulants do not exist or are not unique: the matrix is not finite, or singular.
    """
    decoupled = np.eye(constant.shape[-1])
    decoupled[0, 0] = 0.0
    matrix = np.where(rough[..., None, None], matrix, matrix * (1 - decoupled) + decoupled)
    finite, finite_matrix = _replaced_if_infinite(matrix)
    solvable = (finite & (np.linalg.slogdet(finite_matrix).sign != 0.0))[..., None]
    finite_matrix = np.where(solvable[..., None], finite_matrix, np.eye(constant.shape[-1]))
    cumulants = -np.linalg.solve(finite_matrix, constant[..., None])[..., 0]
    return np.where(solvable, cumulants, np.nan)


def _replaced_if_infinite(matrix) -> tuple[np.ndarray, np.ndarray]:
    """Return whether each matrix (..., n, n) is finite, and the matrices with others set to 0."""
    finite = np.isfinite(matrix).all(axis=(-2, -1))
    return finite, np.where(finite[..., None, None], matrix, 0.0)


def moment_changes(x, r, beta, dimension, q) -> np.ndarray:
    """Return the rates of change of moments by contacts, to first order in the cumulants.

    They are per collision per particle of the Maxwellian gas. Shape (..., 1 + cumulants, moments):
    the rates of a Maxwellian gas, then their coefficients of a20, a11, a02 and, for spheres, of the
    alignment. The moments are <V^2>, <w^2>, <V^4>, <V^2 w^2>, <w^4> and, for spheres, <(V.w)^2>; w
    is the surface velocity a omega, `x` = T_rot/(q T_tr), and `q` = I/(m a^2).
    """
    eta = q * (1 + beta) / (2 * (1 + q))
    contact = (1 + r) / 2, eta, eta / q
    no_contact = 0.0, 0 * eta, 0 * eta

    def change(*pair):
        """Return the changes of moments by contacts, after less before, (..., moments).

        `pair` has the first arguments of `moments_at_contact`: variances of both particles, and
        rho.
        """
        after, before = (
            moments_at_contact(*pair, *impulses, dimension) for impulses in (contact, no_contact)
        )
        return np.stack([new - old for new, old in zip(after, before, strict=True)], axis=-1)

    def second_order(T, spin, rho=0):
        """Return the coefficient of e^2 in the changes, by Cauchy's integral formula.

        Either particle has in turn T_tr (1 + e T), x (1 + e spin), and the covariance e rho sqrt(x)
        of v and w; the other is Maxwellian.
        """
        e = CONTOUR.reshape(-1, *(1,) * np.ndim(x))
        T_tr, spins, covariance = 1 + e * T, x * (1 + e * spin), e * rho * np.sqrt(x)
        changes = change(T_tr, 1.0, spins, x, covariance) + change(1.0, T_tr, x, spins, 0.0)
        return np.mean(changes / e[..., None] ** 2, axis=0).real

    a20, a02 = second_order(1, 0), second_order(0, 1)
    a11 = second_order(1, 1) - a20 - a02
    orders = [change(1.0, 1.0, x, x, 0.0), a20, a11, a02]
    if dimension == 3:  # cov(v_i, w_i) = rho has a11 = 2 rho^2/(3 x), alignment 10 rho^2/(3 x)
        orders.append(0.3 * (second_order(0, 0, 1) - 2 / 3 * a11))
    return np.stack(orders, axis=-2)


def maxwellian_moments(x, dimension) -> np.ndarray:
    """Return the moments of `moment_changes` in a Maxwellian gas, (..., moments).

    `x` = T_rot/(q T_tr) has shape (..., 1); T_tr = m = 1.
    """
    D, n = dimension, 2 * dimension - 3
    moments = [D + 0 * x, n * x, D * (D + 2) + 0 * x, D * n * x, n * (n + 2) * x**2]
    return np.concatenate(moments if D == 2 else [*moments, D * x], axis=-1)


def moments_at_contact(T1, T2, x1, x2, rho, normal, eta, turn, dimension) -> list:
    """Return the moments of the first of two particles after contacts, times the contact frequency.

    The unit of the frequency is the contact frequency of a pair with T = 1. Components of
    velocities are Gaussian of the variances T1 and T2, of spins x1 and x2; rho is cov(v_i, w_i) of
    the first. With n along the line of centres, v' = v - `normal` g_n n - `eta` g_t and w' x n = w
    x n + `turn` g_t; in terms of u = w x n, g_t = v1_t - v2_t - u1 - u2. Contacts have a frequency
    proportional to |g_n|; averaged over them, <g_n^2> = 2 s and <g_n^4> = 8 s^2, s = T1 + T2:
    Gaussian moments with twice the variance and the fourth cumulant -4 s^2.
    """
    tangential_axes = dimension - 1
    normal_spins = dimension - 2  # spin components along the line of centres
    s = T1 + T2
    g_covariance = (1 - normal) * T1 - normal * T2  # cov(v_n', g_n)
    V = (1 - normal) ** 2 * T1 + normal**2 * T2 + g_covariance**2 / s
    Vw, w = (1 - normal + g_covariance / s) * rho, x1 + rho**2 / s
    V4 = 3 * V**2 - 4 * (g_covariance**2 / s) ** 2
    V2w2 = V * w + 2 * Vw**2 - 4 * (g_covariance * rho / s) ** 2
    w4 = 3 * w**2 - 4 * (rho**2 / s) ** 2

    t = (1 - eta) ** 2 * T1 + eta**2 * (T2 + x1 + x2)  # of a component of v_t'
    u = (1 - turn) ** 2 * x1 + turn**2 * (x2 + T1 + T2)
    tu = turn * (1 - eta) * T1 + eta * (1 - turn) * x1 - eta * turn * (T2 + x2)
    tw = (1 - eta - turn) * rho  # covariance of components of v_t' and w_t', not w' x n
    t4, u4 = (tangential_axes * (tangential_axes + 2) * moment**2 for moment in (t, u))
    t2u2 = tangential_axes**2 * t * u + 2 * tangential_axes * tu**2 + 4 * normal_spins * tw**2

    moments = [
        V + tangential_axes * t,
        normal_spins * w + tangential_axes * u,
        V4 + 2 * tangential_axes * V * t + t4,
        normal_spins * (V2w2 + tangential_axes * t * w) + tangential_axes * V * u + t2u2,
        normal_spins * (w4 + 2 * tangential_axes * w * u) + u4,
    ]
    if dimension == 3:
        moments.append(V2w2 + 4 * Vw * tw + 6 * tw**2 + 2 * t * u - 2 * tu**2)
    return [np.sqrt(s / 2) * moment for moment in moments]
