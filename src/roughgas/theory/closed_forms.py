"""Closed forms for R = E_rot/(E_rot + E_tr), the share of rotational energy per degree of freedom.

Source: McNamara & Luding (1998). docs/references.md says who has published them in other forms.
"""

import numpy as np

from roughgas.theory.arguments import check, material, positive_root, quotient, shares


def lun_ratio(beta, inertia) -> np.ndarray:
    """Return R of a gas whose drive adds translational energy only: Lun's formula, any D and r."""
    beta, q = check("roughness beta", beta), check("inertia q", inertia)
    gain = q * (1 + beta)
    return gain / (gain + (1 - beta) + 2 * q)


def correlated_ratio(beta, inertia, correlation) -> np.ndarray:
    """Return R averaged over collisions where collisions leave the rotational energy as it is.

    That is a steady state whose drive adds translational energy only. `correlation` is <v_t.v_r>/
    sqrt(<v_t^2> <v_r^2>) over collisions, in [-1, 1]; where it vanishes this is Lun's formula. No
    velocity distribution is assumed: with Eq. (deltaEr), k = (1 + beta)/(2 + 2 q) and
    x^2 = <v_r^2>/<v_t^2>, what collisions leave alone is k - (1 - k) x^2 - (1 - 2 k) x correlation
    = 0, and R = q x^2/(1 + q x^2).
    """
    beta, q = check("roughness beta", beta), check("inertia q", inertia)
    c = check("correlation at contacts", correlation)
    k = (1 + beta) / (2 + 2 * q)
    x, one = positive_root(1 - k, (2 * k - 1) * c, k)
    return shares(one**2, q * x**2, neither=0)[1][()]


def goldshtein_ratio(r, beta, inertia=2 / 5) -> np.ndarray:
    """Return R of a freely cooling gas of spheres, by the theory of free cooling.

    Written without its cancellation for a_G > 0. Limits as in `cooling_ratio`.
    """
    a, b = a_G(r, beta, inertia), b_G(beta, inertia)
    root = np.sqrt(a**2 + b**2)
    size = np.abs(a)
    rough = quotient(b, b + root) * (1 + quotient(b, root + size)) / 2
    smooth = (1 + quotient(size, b + root)) / 2
    return np.where((a > 0) | (root == 0), rough, smooth)[()]


def cooling_ratio(r, beta, dimension=2, inertia=None) -> np.ndarray:
    """Return R = 1/(1 + K) of a freely cooling gas, by the theory of free cooling.

    Accurate to 1e-14 of R up to the ends of the ranges of r and beta, apart from what the
    rounding of r and beta themselves leaves open: near beta = -1 and r = 1, where R is a steep
    function of (1 - r)/(1 + beta). Limits: R = 1/2 at r = beta = 1. At beta = -1, where spin is
    decoupled, the limit beta -> -1 from above: R = 1 for r < 1 (spin outlives translation), and
    R = 0 at r = 1 (the limit along r = 1 of all q < 1).
    """
    return _cooling_shares(r, beta, dimension, inertia)[1][()]


def cooling_K(r, beta, dimension=2, inertia=None) -> np.ndarray:
    """Return K = E_tr/E_rot of a freely cooling gas: the positive root of its quadratic.

    Limits as in `cooling_ratio`: K = 0 at beta = -1 and r < 1, K infinite at beta = -1 and r = 1.
    """
    return quotient(*_cooling_shares(r, beta, dimension, inertia))


def a_G(r, beta, inertia) -> np.ndarray:
    """Return a_G = (1 - beta^2)(1 - q)/(1 + q) - 1 + r^2, of the theory of free cooling."""
    r, beta, q = (
        check("restitution r", r),
        check("roughness beta", beta),
        check("inertia q", inertia),
    )
    return (1 - beta) * (1 + beta) * (1 - q) / (1 + q) - (1 - r) * (1 + r)


def b_G(beta, inertia) -> np.ndarray:
    """Return b_G = 2 q (1 + beta)^2/(1 + q)^2, of the theory of free cooling."""
    beta, q = check("roughness beta", beta), check("inertia q", inertia)
    return 2 * q * ((1 + beta) / (1 + q)) ** 2


def c_G(beta, inertia) -> np.ndarray:
    """Return c_G = (1 + beta)(2 q + q^2 - beta q^2)/(1 + q)^2, of the theory of free cooling."""
    beta, q = check("roughness beta", beta), check("inertia q", inertia)
    return (1 + beta) * (2 * q + q**2 * (1 - beta)) / (1 + q) ** 2


def _cooling_shares(r, beta, dimension, inertia) -> tuple[np.ndarray, np.ndarray]:
    """Return 1 - R and R, shares of the energy per degree of freedom; alpha = 2/(D - 1)."""
    r, beta, dimension, q = material(r, beta, dimension, inertia)
    alpha = 2 / (dimension - 1)
    b = b_G(beta, q)
    linear = alpha * a_G(r, beta, q) + (alpha - 1) * c_G(beta, q)
    return shares(*positive_root(alpha * b / 2, linear, b / 2), neither=0)
