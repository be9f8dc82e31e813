"""Rate equations for the two granular temperatures, and where they are stationary.

They are McNamara & Luding (1998), Eqs. (deltaEt) and (deltaEr), averaged over the collisions of a
Maxwellian gas with eta = q (1 + beta)/[2 (1 + q)], nu collisions per particle per time:

    dT_tr/dt  = (nu/D) {-[(1-r^2) + 2(D-1) eta (1-eta)] T_tr + 2(D-1) (eta^2/q) T_rot} + drive
    dT_rot/dt = (2(D-1) nu/(2D-3)) {(eta^2/q) T_tr - (eta/q) (1-eta/q) T_rot} + drive

They are those of M. Huthmann & A. Zippelius, Phys. Rev. E 56, R6275 (1997) for spheres, and of
S. Luding et al., Phys. Rev. E 58, 3416 (1998) for disks, too.

A drive is described by `spin_share`, the share s in [0, 1] of its power that goes into spin: 0 is
translational, 1 rotational driving (R. Cafiero, S. Luding & H. J. Herrmann, Europhys. Lett. 60,
854, 2002), and None no drive: free cooling. A. Megias & A. Santos, Front. Phys. 10, 971671 (2022)
drive disks so with any share.
"""

from typing import NamedTuple

import numpy as np

from roughgas.theory.arguments import check, check_dimension, material
from roughgas.theory.shares import positive_root, quotient, shares


class Rates(NamedTuple):
    """Coefficients of the rate equations, all >= 0, per collision per particle.

    With n counting collisions per particle: dT_tr/dn = -translational_loss T_tr +
    translational_gain T_rot and dT_rot/dn = rotational_gain T_tr - rotational_loss T_rot.
    """

    translational_loss: np.ndarray
    translational_gain: np.ndarray
    rotational_gain: np.ndarray
    rotational_loss: np.ndarray

    def changes(self, T_tr, T_rot, frequency=1.0) -> tuple[np.ndarray, np.ndarray]:
        """Return dT_tr/dt and dT_rot/dt at `frequency` collisions per particle per time."""
        return (
            frequency * (self.translational_gain * T_rot - self.translational_loss * T_tr),
            frequency * (self.rotational_gain * T_tr - self.rotational_loss * T_rot),
        )


def collision_rates(r, beta, dimension=2, inertia=None) -> Rates:
    """Return the coefficients of the rate equations."""
    gas = material(r, beta, dimension, inertia)
    (r, beta, dimension, q), eta = gas, gas.eta
    # 1 - eta and 1 - eta/q from sums of positive terms, exact towards beta = 1 and small q.
    kept = (2 + q * (1 - beta)) / (2 * (1 + q))
    kept_spin = (2 * q + 1 - beta) / (2 * (1 + q))
    tangential, spins = 2 * (dimension - 1), 2 * dimension - 3
    return Rates(
        translational_loss=((1 - r) * (1 + r) + tangential * eta * kept) / dimension,
        translational_gain=tangential * eta**2 / q / dimension,
        rotational_gain=tangential * eta**2 / q / spins,
        rotational_loss=tangential * (eta / q) * kept_spin / spins,
    )


def temperature_changes(
    T_tr, T_rot, r, beta, dimension=2, inertia=None, frequency=1.0
) -> tuple[np.ndarray, np.ndarray]:
    """Return dT_tr/dt and dT_rot/dt due to collisions; `frequency` is nu (`collision_frequency`).

    With the frequency 1 left as it is, they are per collision per particle.
    """
    T_tr, T_rot = check("temperature T_tr", T_tr), check("temperature T_rot", T_rot)
    nu = check("frequency", frequency)
    return collision_rates(r, beta, dimension, inertia).changes(T_tr, T_rot, nu)


def drive_changes(power, spin_share, dimension=2) -> tuple[np.ndarray, np.ndarray]:
    """Return dT_tr/dt and dT_rot/dt due to a drive of `power` per particle (m a^2/T^3)."""
    power, share = check("power", power), check("spin share of the drive", spin_share)
    dimension = check_dimension(dimension)
    return 2 * (1 - share) * power / dimension, 2 * share * power / (2 * dimension - 3)


def stationary_ratio(r, beta, dimension=2, inertia=None, spin_share=None) -> np.ndarray:
    """Return the stationary R = T_rot/(T_rot + T_tr).

    That is the theory of free cooling without a drive, Lun's formula at spin_share 0. At
    spin_share 1, theta is the loss over the gain of T_tr. In general, translation and spin lose
    energy to collisions in the ratio (1 - s) : s, for any power, even one that varies. If a drive
    takes out of one motion some of what it puts into the other, s lies below 0 or above 1; if it
    takes out more than collisions supply, R is 0 or 1. Limits at beta = -1 are those of beta -> -1
    (without a drive, see `cooling_ratio`).
    """
    return stationary_shares(r, beta, dimension, inertia, spin_share)[1][()]


def stationary_theta(r, beta, dimension=2, inertia=None, spin_share=None) -> np.ndarray:
    """Return the stationary theta = T_rot/T_tr; infinite where R = 1. See `stationary_ratio`."""
    translational, rotational = stationary_shares(r, beta, dimension, inertia, spin_share)
    return quotient(rotational, translational)


def stationary_shares(
    r, beta, dimension=2, inertia=None, spin_share=None
) -> tuple[np.ndarray, np.ndarray]:
    """Return the stationary T_tr and T_rot as shares of their sum: 1 - R and R."""
    r, beta, dimension, q = material(r, beta, dimension, inertia)
    rates = collision_rates(r, beta, dimension, q)
    if spin_share is None:
        difference = rates.translational_loss - rates.rotational_loss
        rotational, translational = positive_root(
            rates.translational_gain, difference, rates.rotational_gain
        )
        return shares(translational, rotational, neither=0)
    s, spins = check("net spin share of the drive", spin_share), 2 * dimension - 3
    rotational = s * dimension * rates.translational_loss + (1 - s) * spins * rates.rotational_gain
    translational = (
        s * dimension * rates.translational_gain + (1 - s) * spins * rates.rotational_loss
    )
    limit = np.clip(s * q / (s * q + 1 - s), 0, 1)
    return shares(np.maximum(translational, 0), np.maximum(rotational, 0), neither=limit)
