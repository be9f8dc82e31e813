"""Closed forms: R, collision frequencies, and shear.

R = E_rot/(E_rot + E_tr) is the share of rotational energy per degree of freedom,
theta = T_rot/T_tr. r is the normal restitution, beta the roughness (tangential restitution),
`inertia` the moment of inertia q = I/(m a^2), `dimension` D. Source: McNamara & Luding (1998).
docs/references.md lists publications that have the formulae in other forms.

Collision frequencies are Enskog's, of a gas in equilibrium; radius a = 1. `packing` phi is the
fraction of the area or volume that particles fill, from 0 to close packing.
"""

import math
from collections.abc import Sequence

import numpy as np

from roughgas.base import Interval
from roughgas.theory import arguments
from roughgas.theory.arguments import check, check_dimension, material, quotient, shares


def lun_ratio(beta, inertia) -> np.ndarray:
    """Return the share R of rotational energy if the drive adds translational energy only.

    Lun's formula is R = q (1 + beta)/[q (1 + beta) + 1 - beta + 2 q]. It holds for any D and r;
    `beta` is the roughness and `inertia` q = I/(m a^2).
    """
    beta, q = check("roughness beta", beta), check("inertia q", inertia)
    gain = q * (1 + beta)
    return gain / (gain + (1 - beta) + 2 * q)


def correlated_ratio(beta, inertia, correlation) -> np.ndarray:
    """Return R averaged over collisions, in a state where these conserve the rotational energy.

    R is the share of rotational energy. The state is a steady state whose drive adds translational
    energy only. `beta` is the roughness and `inertia` q = I/(m a^2). `correlation` is <v_t.v_r>/
    sqrt(<v_t^2> <v_r^2>) over collisions, in [-1, 1], of the tangential velocities v_t due to
    translation and v_r due to rotation; where it vanishes this is Lun's formula. No velocity
    distribution is assumed: with Eq. (deltaEr), k = (1 + beta)/(2 + 2 q) and x^2 = <v_r^2>/<v_t^2>,
    the rotational energy is constant where k - (1 - k) x^2 - (1 - 2 k) x correlation = 0, and R = q
    x^2/(1 + q x^2).
    """
    beta, q = check("roughness beta", beta), check("inertia q", inertia)
    c = check("correlation at contacts", correlation)
    k = (1 + beta) / (2 + 2 * q)
    numerator, denominator = arguments.positive_root(1 - k, (2 * k - 1) * c, k)
    return shares(denominator**2, q * numerator**2, second_if_both_zero=0)[1][()]


def goldshtein_ratio(r, beta, inertia=2 / 5) -> np.ndarray:
    """Return R, the share of rotational energy, of freely cooling spheres: theory of free cooling.

    `r` is the normal restitution, `beta` the roughness, `inertia` q = I/(m a^2). Written such that
    nothing cancels for a_G > 0. Limits as in `cooling_ratio`, whose result for D = 3 it equals.
    """
    a, b = a_G(r, beta, inertia), b_G(beta, inertia)
    root = np.sqrt(a**2 + b**2)
    magnitude = np.abs(a)
    rough = quotient(b, b + root) * (1 + quotient(b, root + magnitude)) / 2
    smooth = (1 + quotient(magnitude, b + root)) / 2
    return np.where((a > 0) | (root == 0), rough, smooth)[()]


def cooling_ratio(r, beta, dimension=2, inertia=None) -> np.ndarray:
    """Return R = 1/(1 + K), the share of rotational energy, of a freely cooling gas by theory.

    K is the positive root of the quadratic equation of the theory of free cooling (`cooling_K`).
    Accurate to 1e-14 of R up to the ends of the ranges of r and beta, apart from the rounding of r
    and beta themselves: near beta = -1 and r = 1, R is a steep function of (1 - r)/(1 + beta).
    Limits: R = 1/2 at r = beta = 1. At beta = -1, where spin is decoupled, the limit beta -> -1
    from above: R = 1 for r < 1 (spin outlives translation), and R = 0 at r = 1 (the limit along
    r = 1 of all q < 1).
    """
    return _cooling_shares(r, beta, dimension, inertia)[1][()]


def cooling_K(r, beta, dimension=2, inertia=None) -> np.ndarray:
    """Return K = E_tr/E_rot of a freely cooling gas: the positive root of its quadratic equation.

    The energies are per degree of freedom. Limits as in `cooling_ratio`: K = 0 at beta = -1 and
    r < 1, K infinite at beta = -1 and r = 1.
    """
    return quotient(*_cooling_shares(r, beta, dimension, inertia))


def a_G(r, beta, inertia) -> np.ndarray:
    """Return a_G = (1 - beta^2)(1 - q)/(1 + q) - 1 + r^2 of the theory of free cooling."""
    r, beta, _, q = material(r, beta, inertia=inertia)
    return (1 - beta) * (1 + beta) * (1 - q) / (1 + q) - (1 - r) * (1 + r)


def b_G(beta, inertia) -> np.ndarray:
    """Return b_G = 2 q (1 + beta)^2/(1 + q)^2 of the theory of free cooling."""
    beta, q = check("roughness beta", beta), check("inertia q", inertia)
    return 2 * q * ((1 + beta) / (1 + q)) ** 2


def c_G(beta, inertia) -> np.ndarray:
    """Return the coefficient c_G of the theory of free cooling.

    c_G = (1 + beta)(2 q + q^2 - beta q^2)/(1 + q)^2. It has no weight for spheres.
    """
    beta, q = check("roughness beta", beta), check("inertia q", inertia)
    return (1 + beta) * (2 * q + q**2 * (1 - beta)) / (1 + q) ** 2


def _cooling_shares(r, beta, dimension, inertia) -> tuple[np.ndarray, np.ndarray]:
    """Return 1 - R and R, shares of the energy per degree of freedom, of a freely cooling gas.

    In the quadratic equation alpha = 2/(D - 1).
    """
    r, beta, dimension, q = material(r, beta, dimension, inertia)
    alpha = 2 / (dimension - 1)
    b = b_G(beta, q)
    linear = alpha * a_G(r, beta, q) + (alpha - 1) * c_G(beta, q)
    return shares(*arguments.positive_root(alpha * b / 2, linear, b / 2), second_if_both_zero=0)


CLOSE_PACKING = {2: np.pi / np.sqrt(12), 3: np.pi / np.sqrt(18)}
"""Packing fraction of the densest arrangement of disks and of spheres."""


VOLUME = {2: np.pi, 3: 4 * np.pi / 3}
"""Area of a disk and volume of a sphere, in a^D."""


def packing_fraction(particles: int, box: Sequence[float]) -> float:
    """Return the packing fraction phi of `particles` (a number) of radius a in a box.

    `box` has the lengths of its D sides in units of the particle radius a. Raises InputError unless
    D is 2 or 3.
    """
    return particles * VOLUME[check_dimension(len(box))] / math.prod(box)


def number_density(packing, dimension=2) -> np.ndarray:
    """Return the number density n, particles per area (2D) or volume (3D), in units of a^-D.

    `packing` is the fraction phi of the area or volume that particles of radius a fill.
    """
    packing, dimension = _checked_packing(packing, dimension)
    return packing / VOLUME[dimension]


def contact_value(packing, dimension=2) -> np.ndarray:
    """Return chi, the pair distribution at contact, of Henderson (2D), Carnahan & Starling (3D).

    With the packing fraction phi, chi = (1 - 7 phi/16)/(1 - phi)^2 in 2D and
    (1 - phi/2)/(1 - phi)^3 in 3D; accurate below the freezing of the fluid.
    """
    packing, dimension = _checked_packing(packing, dimension)
    if dimension == 2:
        return (1 - 7 * packing / 16) / (1 - packing) ** 2
    return (1 - packing / 2) / (1 - packing) ** 3


def collision_frequency(T_tr, packing, dimension=2) -> np.ndarray:
    """Return nu, collisions per particle per time, in 1/T; a collision counts for both particles.

    nu = 4 a n chi sqrt(pi T_tr/m) in 2D and 16 sqrt(pi) a^2 n chi sqrt(T_tr/m) in 3D, for a
    Maxwellian gas of number density n, with chi of `contact_value` at the packing fraction
    `packing`. T_tr = m <v^2>/D >= 0, in m a^2/T^2.
    """
    T_tr = check("temperature T_tr", T_tr)
    per_speed = {2: 4, 3: 16}[check_dimension(dimension)] * np.sqrt(np.pi)
    crowding = number_density(packing, dimension) * contact_value(packing, dimension)
    return per_speed * crowding * np.sqrt(T_tr)


def mean_free_path(packing, dimension=2) -> np.ndarray:
    """Return the mean free path <|v|>/nu in particle radii a; infinite at packing 0.

    With <|v|> = sqrt(pi T_tr/2) in 2D and sqrt(8 T_tr/pi) in 3D, and nu of `collision_frequency`.
    `packing` is the packing fraction phi.
    """
    speed = {2: np.sqrt(np.pi / 2), 3: np.sqrt(8 / np.pi)}[check_dimension(dimension)]
    return quotient(speed, collision_frequency(1.0, packing, dimension))


def _checked_packing(packing, dimension) -> tuple[np.ndarray, int]:
    """Return the packing fraction, checked to lie between 0 and close packing, and D."""
    dimension = check_dimension(dimension)
    return check("packing", packing, Interval(f"[0, {CLOSE_PACKING[dimension]:.4f}]")), dimension


def shear_factor(rate, stress, difference) -> np.ndarray:
    """Return theta = T_rot/T_tr of sheared disks over Lun's theta, which holds for all r, beta, q.

    Parameters: the shear rate g = Gamma a (m/T_tr)^(1/2); of the velocities without the mean flow,
    the stress p = -m <v_x v_y>/T_tr and the normal stress `difference` d = (T_x - T_y)/(2 T_tr);
    all three are dimensionless. To second order in g, p and d, with Gaussian velocities (an
    anisotropic Maxwellian; as Jenkins and Richman, J. Fluid Mech. 192, 313 (1988), have it) that
    are uncorrelated before contacts,

        theta/theta_lun = 1 + (p^2 + d^2)/4 + sqrt(pi) g p/4 + g^2/4.

    The drive adds no rotational energy: C_r1 <v_t^2> - C_r2 <v_t.v_r> - C_r3 <v_r^2> = 0, of
    velocities with the mean flow and the mean spin -Gamma/2, which take part in contacts; averaged
    over contacts, <v_t^2> = 2 T_tr [1 + (p^2 + d^2)/4 + sqrt(pi) g p/4 + 3 g^2/4]/m,
    <v_t.v_r> = -Gamma^2 and <v_r^2> = 2 T_rot/(q m) + Gamma^2 (a = 1). Temperatures are those
    without mean flow and mean spin.
    """
    g, p, d = check("shear rate g", rate), np.asarray(stress), np.asarray(difference)
    return 1 + (p**2 + d**2) / 4 + np.sqrt(np.pi) * g * p / 4 + g**2 / 4
