"""Closed forms, and sums of published numbers, for the gases of this study."""

import math

import numpy as np

from roughgas import theory
from roughgas.judging import Estimate, references

SERIES_TAIL_ERROR = 0.1
"""Relative error of the virial series beyond its last published term, summed as a geometric
series."""


def compressibility(packing: float, dimension: int) -> Estimate:
    """Return Z = p/(n T) of smooth elastic disks or spheres, from ten virial coefficients.

    N. Clisby & B. M. McCoy, J. Stat. Phys. 122, 15 (2006), Table 1: B_k/B_2^(k-1), with B_2 equal
    to 2^(D-1) volumes of a particle.
    """
    rows = _series(dimension)
    powers = (2.0 ** (dimension - 1) * packing) ** np.arange(1, len(rows) + 1)
    terms, errors = (powers * np.array(column) for column in zip(*rows, strict=True))
    ratio = terms[-1] / terms[-2]
    tail = terms[-1] * ratio / (1.0 - ratio)
    error = math.hypot(float(np.linalg.norm(errors)), SERIES_TAIL_ERROR * tail)
    return Estimate(1.0 + float(terms.sum()) + tail, error)


def fixed_number_correction(packing: float, dimension: int) -> float:
    """Return N times the deficit of Z - 1 of N particles in a periodic box.

    As the number does not fluctuate, contacts are fewer: n^2 g by S/(2 N) n^2 d^2(n^2 g)/dn^2, S
    being the structure factor at long waves. J. L. Lebowitz & J. K. Percus, Phys. Rev. 124, 1673
    (1961). Without correlations that is the 1/N of N (N - 1)/2 pairs.
    """
    rows = _series(dimension)
    k = np.arange(2, len(rows) + 2)
    c = np.array([value for value, _ in rows]) * 2.0 ** ((dimension - 1) * (k - 1))
    slope, curvature = (
        (k * c * packing ** (k - 1)).sum(),
        (k * (k - 1) * c * packing ** (k - 2)).sum(),
    )
    return float(packing * curvature / (2.0 * (1.0 + slope)))


def _series(dimension):
    rows = [row for row in references(__file__) if row["quantity"] == "virial"]
    rows = [row for row in rows if int(row["dimension"]) == dimension]
    return [(float(row["value"]), float(row["stderr"])) for row in rows]


def approximate_compressibility(packing: float, dimension: int) -> float:
    """Return Z of D. Henderson, Mol. Phys. 30, 971 (1975), for disks, and of N. F. Carnahan & K. E.
    Starling, J. Chem. Phys. 51, 635 (1969), for spheres."""
    x = packing
    if dimension == 2:
        return (1.0 + x**2 / 8.0) / (1.0 - x) ** 2
    return (1.0 + x + x**2 - x**3) / (1.0 - x) ** 3


def first_rates(dimension, r, beta, theta, q) -> tuple[float, float]:
    """Return -dT_tr/dn and dT_rot/dn over T_tr of Maxwellian velocities and spins, theta =
    T_rot/T_tr, n in collisions per particle.

    Exact while velocities are Maxwellian. M. Huthmann & A. Zippelius, Phys. Rev. E 56, R6275
    (1997); S. Luding, M. Huthmann, S. McNamara & A. Zippelius, Phys. Rev. E 58, 3416 (1998).
    """
    eta = q * (1.0 + beta) / (2.0 * (1.0 + q))
    tangents, spins = 2.0 * (dimension - 1), 2 * dimension - 3
    loss = 1.0 - r**2 + tangents * eta * (1.0 - eta) - tangents * eta**2 / q * theta
    gain = tangents * (eta**2 / q - eta / q * (1.0 - eta / q) * theta)
    return loss / dimension, gain / spins


def mixture_rates(r, beta, theta, mass, radius, crowding) -> dict[str, float]:
    """Return rates by name for two species of spheres, half of them of mass and radius 1: loss_1,
    loss_2, which are -dT_tr/dn over T_tr, and gain_1, gain_2, which are dT_rot/dn over T_tr. See
    `first_rates`; `crowding` is chi_ij.

    A. Santos, G. M. Kremer & V. Garzo, Prog. Theor. Phys. Suppl. 184, 31 (2010), in their notation.
    """
    m, sigma, kappa = np.array([1.0, mass]), np.add.outer([1.0, radius], [1.0, radius]), 0.4
    reduced = np.multiply.outer(m, m) / np.add.outer(m, m)
    alpha = reduced * (1.0 + r)
    beta = reduced * kappa / (1.0 + kappa) * (1.0 + beta)
    speed = np.add.outer(1.0 / m, 1.0 / m)
    nu = 4.0 * math.sqrt(2.0 * math.pi) / 3.0 * crowding * 0.5 * sigma**2 * np.sqrt(speed)
    both = speed * (1.0 + theta / kappa)  # T_i/m_i + T_j/m_j, and the same for spins over kappa
    loss = 2.0 * (alpha + beta) - alpha**2 * speed - beta**2 * both
    gain = beta / kappa * (beta * both - 2.0 * theta)
    contacts = 1.5 * nu.sum(axis=1).mean()  # of a particle per time
    rates = {"loss": loss, "gain": gain}
    species_rates = {name: (nu * rate).sum(axis=1) / m / contacts for name, rate in rates.items()}
    return {
        f"{name}_{k + 1}": float(values[k])
        for name, values in species_rates.items()
        for k in (0, 1)
    }


def tracer_ratio(r, mass) -> float:
    """Return T_0/T of a smooth tracer particle of a given mass among elastic particles of mass 1:
    P. A. Martin & J. Piasecki, Europhys. Lett. 46, 613 (1999)."""
    return (1.0 + r) / (2.0 + (1.0 - r) / mass)


def sonine_cooling(dimension, r) -> float:
    """Return a2 of a smooth cooling gas: T. P. C. van Noije & M. H. Ernst, Granular Matter 1, 57
    (1998)."""
    d = dimension
    return _excess(r) / (9 + 24 * d + (8 * d - 41) * r + 30 * r**2 * (1 - r))


def sonine_driven(dimension, r) -> float:
    """Return a2 of a smooth gas that white noise drives, by the same authors."""
    d = dimension
    return _excess(r) / (73 + 56 * d - 24 * d * r - 105 * r + 30 * r**2 * (1 - r))


def sonine_cooling_closer(dimension, r) -> float:
    """Return a2 of a smooth cooling gas by another way of linearising: J. M. Montanero & A. Santos,
    Granular Matter 2, 53 (2000); any dimension: F. Coppex, M. Droz, J. Piasecki & E. Trizac,
    Physica A 329, 114 (2003)."""
    d = dimension
    return _excess(r) / (25 + 24 * d + (8 * d - 57) * r - 2 * r**2 * (1 - r))


def tail(dimension, r, a2, driven) -> float:
    """Return A of the tails exp(-A c) of a smooth cooling gas, or exp(-A c^(3/2)) of a gas driven
    by white noise, c being v over sqrt(2 T/m), from its a2.

    Fast particles are lost at the rate beta_1 c, and nearly none gained; the gas loses energy at
    the rate mu_2: T. P. C. van Noije & M. H. Ernst, Granular Matter 1, 57 (1998).
    """
    d = dimension
    lost = math.pi ** ((d - 1) / 2) / math.gamma((d + 1) / 2)
    cooled = (1.0 - r**2) * math.pi ** ((d - 1) / 2) / (math.sqrt(2.0) * math.gamma(d / 2))
    ratio = lost / (cooled * (1.0 + 3.0 / 16.0 * a2))
    return 2.0 / 3.0 * math.sqrt(2.0 * d * ratio) if driven else d * ratio


def grazing_correction(dimension, r, driven) -> float:
    """Return the change of -d ln f/d ln c of a tail by grazing contacts, which take little of a
    fast particle's speed: to first order in 1/c, derived here; `tail` leaves it out.

    The gain of fast particles is the share K/(s k c) of their loss, where s = -d ln f/dc, k = 1 -
    ((1 - r)/2)^2, and K = 1, 2 for disks, spheres.
    """
    return (dimension - 1) / (1.0 - ((1.0 - r) / 2.0) ** 2) / (2.0 if driven else 1.0)


def _excess(r):
    return 16 * (1 - r) * (1 - 2 * r**2)


def diffusion(dimension) -> float:
    """Return D nu/T of smooth elastic particles in the first Enskog approximation, nu being
    collisions per particle and time: S. Chapman & T. G. Cowling (1970), section 14.2."""
    return dimension / 2.0


def rough_diffusion(dimension, q) -> float:
    """Return D of perfectly rough over D of smooth particles, to the same order; for spheres (1 +
    q)/(1 + 2 q): F. B. Pidduck, Proc. R. Soc. A 101, 101 (1922)."""
    rough, smooth = (theory.self_diffusion(1.0, 0.1, 1.0, b, dimension, q) for b in (1.0, -1.0))
    return float(rough / smooth)
