"""Energies that a collision moves between translation and rotation, and averages for them.

v_n and v_t are the normal and tangential parts of v1 - v2 and v_r = -a (omega1 + omega2) x n is the
tangential velocity due to rotation, n pointing from particle 2 to particle 1. Squared velocities
are in a^2/T^2, energies in m a^2/T^2. Source: McNamara & Luding (1998).
"""

import numpy as np

from roughgas.theory.arguments import check, check_dimension


def translational_energy_change(
    normal_squared, tangential_squared, tangential_dot_spin, spin_squared, r, beta, inertia
) -> np.ndarray:
    """Return the change of the pair's translational energy, N D Delta E_tr: Eq. (deltaEt).

    The first four arguments are v_n^2, v_t^2, v_t.v_r and v_r^2 before the collision, of one
    collision or averaged over collisions.
    """
    r, beta, q = (
        check("restitution r", r),
        check("roughness beta", beta),
        check("inertia q", inertia),
    )
    exchanged = (
        -(2 + q * (1 - beta)) * np.asarray(tangential_squared)
        - (2 - 2 * q * beta) * np.asarray(tangential_dot_spin)
        + q * (1 + beta) * np.asarray(spin_squared)
    )
    return -(1 - r) * (1 + r) / 4 * np.asarray(normal_squared) + _prefactor(beta, q) * exchanged


def rotational_energy_change(
    tangential_squared, tangential_dot_spin, spin_squared, beta, inertia
) -> np.ndarray:
    """Return the change of the pair's rotational energy, N (2D-3) Delta E_rot: Eq. (deltaEr).

    Arguments as in `translational_energy_change`; v_n does not matter.
    """
    beta, q = check("roughness beta", beta), check("inertia q", inertia)
    return _prefactor(beta, q) * (
        (1 + beta) * np.asarray(tangential_squared)
        - 2 * (q - beta) * np.asarray(tangential_dot_spin)
        - (2 * q + 1 - beta) * np.asarray(spin_squared)
    )


def mean_normal_squared(E_tr) -> np.ndarray:
    """Return <v_n^2> = 8 E_tr/m over the collisions of a Maxwellian gas, in 2D and 3D.

    E_tr is the translational energy per degree of freedom, >= 0. Below Eq. (Energybalance), as are
    the two averages that follow; <v_t.v_r> = 0, translation and spin being uncorrelated.
    """
    return 8 * check("energy E_tr", E_tr)


def mean_tangential_squared(E_tr, dimension=2) -> np.ndarray:
    """Return <v_t^2> = 4 (D-1) E_tr/m over the collisions of a Maxwellian gas."""
    return 4 * (check_dimension(dimension) - 1) * check("energy E_tr", E_tr)


def mean_spin_squared(E_rot, dimension, inertia) -> np.ndarray:
    """Return <v_r^2> = 4 (D-1) E_rot/(q m), for any isotropic, uncorrelated spins.

    E_rot is the rotational energy per degree of freedom, >= 0.
    """
    dimension, q = check_dimension(dimension), check("inertia q", inertia)
    return 4 * (dimension - 1) * check("energy E_rot", E_rot) / q


def _prefactor(beta, q) -> np.ndarray:
    """Return S = m q (1 + beta)/[4 (1 + q)^2], below Eq. (deltaEt)."""
    return q * (1 + beta) / (4 * (1 + q) ** 2)
