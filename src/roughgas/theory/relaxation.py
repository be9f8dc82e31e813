"""How fast the temperatures of a driven gas forget a disturbance, by the rate equations.

The temperatures are a vector (k,): T_tr of each species, then T_rot of each species that spins. Per
collision per particle, contacts change them by F(T). `slopes` holds dF/dT, all rates are positive
where a disturbance decays.

The ratio R relaxes as temperatures exchange energy while the drive replaces the energy that
contacts dissipate, as in `rate_equations.relaxation_rate`: with the capacities c (energy c.T) and
the heating h of the drive (c.h = 1), the slopes of F - h (c.F), among disturbances that leave the
energy c.T as it is. The slowest of all modes involves the energy as well. Contacts become more
frequent as T_tr^(1/2), and the power of a drive stays as it is (a thermostat, a bath, a thermal
wall) or becomes larger with the frequency of contacts (shear, a shaken floor).
"""

import math
from collections.abc import Callable
from typing import Any

import numpy as np

from roughgas.theory.arguments import moment_of_inertia

STEP = 1e-5
"""Of ln T, for a slope."""


def slopes(changes: Callable[[np.ndarray], Any], temperatures: np.ndarray) -> np.ndarray:
    """Return dF_i/dT_j, (k, k), of `changes` F at positive `temperatures` (k,)."""
    at = np.asarray(temperatures, float)
    columns = []
    for j, temperature in enumerate(at):
        step = np.zeros(len(at))
        step[j] = STEP * temperature
        difference = np.subtract(changes(at + step), changes(at - step))
        columns.append(difference / (2.0 * STEP * temperature))
    return np.transpose(columns)


def ratio_relaxation(matrix: np.ndarray, heating: np.ndarray, capacity: np.ndarray) -> float:
    """Return the rate of the slowest mode at constant energy; infinity for a single temperature.

    `matrix` (k, k) holds the slopes of all that changes temperatures but the drive, `heating` (k,)
    how the drive changes them, in any unit, and `capacity` (k,) the energy per temperature.
    """
    if len(capacity) < 2:
        return np.inf
    replaced = matrix - np.outer(heating, capacity @ matrix) / (capacity @ heating)
    # Disturbances without energy: each temperature but the last, which makes up for them.
    share = capacity[:-1] / capacity[-1]
    return slowest_relaxation(replaced[:-1, :-1] - np.outer(replaced[:-1, -1], share))


def slowest_relaxation(matrix: np.ndarray) -> float:
    """Return the rate of the slowest mode of d(delta T)/dt = `matrix` delta T; 0 if it grows."""
    if len(matrix) == 1:
        return max(0.0, -float(matrix[0, 0]))
    if len(matrix) == 2:  # most gases: without a library that takes a while to wake up
        (a, b), (c, d) = matrix.tolist()
        root = math.sqrt(max(0.0, (a - d) ** 2 + 4.0 * b * c))
        return max(0.0, -(a + d + root) / 2.0)
    return max(0.0, float(-np.linalg.eigvals(matrix).real.max()))


def wall_slopes(
    restitution: float, roughness: float, dimension: int = 2, inertia: float | None = None
) -> np.ndarray:
    """Return the slopes (2, 2) of T_tr and T_rot per hit of a heavy wall at rest.

    Derived for this package. With kappa = (1 + beta)/(1 + q), a hit changes the tangential velocity
    by -q kappa (v_t + a w) and a w by -kappa (v_t + a w). Particles that hit a wall have <v_n^2>
    = 2 T_tr/m and, in every direction along the wall, <v_t^2> = T_tr/m.
    """
    q = moment_of_inertia(dimension) if inertia is None else inertia
    kappa = (1.0 + roughness) / (1.0 + q)
    along, spins = dimension - 1, 2 * dimension - 3
    normal = 2.0 * (1.0 - restitution**2)
    return np.array(
        [
            [-(normal + along * q * kappa * (2.0 - q * kappa)), along * q * kappa**2],
            [along * q * kappa**2, -along * kappa * (2.0 - kappa)],
        ]
    ) / np.array([[dimension], [spins]])


def thermal_wall_slopes(dimension: int = 2) -> np.ndarray:
    """Return the slopes (2, 2) per hit of a thermal wall, which replaces the velocity and the spin.

    Particles bring (D + 1) T_tr/2 along, and leave with (D + 1)/2 of the wall's temperature.
    """
    return np.diag([-(dimension + 1.0) / dimension, -1.0])


def hits_of_wall(T_tr: float, length: float) -> float:
    """Return the hits of a particle per T on a wall that closes an axis of this `length` (a).

    That is the flux of a Maxwellian gas, (T_tr/2 pi m)^(1/2) per particle and length.
    """
    return float(np.sqrt(T_tr / (2.0 * np.pi))) / length


def hits_of_floor(T_tr: float, gravity: float) -> float:
    """Return the hits of a particle per T on the floor that bears its weight.

    A hit hands over 2 m v_n, on average 2 (pi m T_tr/2)^(1/2) in a Maxwellian gas.
    """
    return gravity / float(2.0 * np.sqrt(np.pi * T_tr / 2.0))


def viscous_decay(T_tr: float, frequency: float, wavelength: float) -> float:
    """Return the decay rate, per T, of a flow with this `wavelength` (a).

    The kinematic viscosity of dilute elastic disks is T_tr/(m nu), nu being the contacts of a
    particle per T; spheres have 5/4 of it (S. Chapman & T. G. Cowling, The Mathematical
    Theory of Non-Uniform Gases, 1970, in the first Sonine approximation).
    """
    return T_tr / frequency * (2.0 * np.pi / wavelength) ** 2
