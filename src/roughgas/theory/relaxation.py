"""Relaxation rates of the temperatures of a driven gas, by the rate equations.

The temperatures are a vector (k,): T_tr of each species, then T_rot of each species that spins. Per
collision per particle, contacts change them by F(T). `slopes` returns dF/dT; rates are positive
where a disturbance decays.

The ratio R relaxes as temperatures exchange energy while the drive replaces the energy that
contacts dissipate, as in `rate_equations.relaxation_rate`: with the capacities c (energy c.T) and
the heating h of the drive (c.h = 1), by the slopes of F - h (c.F), for disturbances at constant
energy c.T. The slowest of all modes involves the energy as well. The frequency of contacts grows as
T_tr^(1/2), and the power of a drive is constant (a thermostat, a bath, a thermal wall) or grows
with the frequency of contacts (shear, a shaken floor).

R = T_rot/(T_rot + T_tr) is the share of rotational energy, q = I/(m a^2).
"""

import math
from collections.abc import Callable
from typing import Any

import numpy as np

from roughgas.theory.arguments import moment_of_inertia

LOG_T_STEP = 1e-5
"""Step of ln T, for central differences."""


def slopes(changes: Callable[[np.ndarray], Any], temperatures: np.ndarray) -> np.ndarray:
    """Return the derivatives dF_i/dT_j, (k, k), of `changes` F at positive `temperatures` T (k,).

    `changes` takes temperatures (k,) and returns their rates of change (k,). They are computed by
    central differences.
    """
    point = np.asarray(temperatures, float)
    columns = []
    for j, temperature in enumerate(point):
        step = np.zeros(len(point))
        step[j] = LOG_T_STEP * temperature
        difference = np.subtract(changes(point + step), changes(point - step))
        columns.append(difference / (2.0 * LOG_T_STEP * temperature))
    return np.transpose(columns)


def ratio_relaxation(matrix: np.ndarray, heating: np.ndarray, capacity: np.ndarray) -> float:
    """Return the rate of the slowest mode at constant energy; infinity for a single temperature.

    The rate is in the unit of `matrix`, per collision per particle or per T. `matrix` (k, k) has
    the slopes of all changes of temperatures except by the drive, `heating` (k,) the changes by the
    drive, in any unit, and `capacity` (k,) the energy per temperature.
    """
    if len(capacity) < 2:
        return np.inf
    constant_energy = matrix - np.outer(heating, capacity @ matrix) / (capacity @ heating)
    # Disturbances without energy: each temperature except the last, which compensates.
    share = capacity[:-1] / capacity[-1]
    return slowest_relaxation(constant_energy[:-1, :-1] - np.outer(constant_energy[:-1, -1], share))


def slowest_relaxation(matrix: np.ndarray) -> float:
    """Return the decay rate of the slowest mode of d(delta T)/dt = `matrix` delta T; 0 if it grows.

    `matrix` (k, k) has the slopes dF_i/dT_j of the changes of k temperatures; the rate has its
    unit.
    """
    if len(matrix) == 1:
        return max(0.0, -float(matrix[0, 0]))
    if len(matrix) == 2:  # most gases: without LAPACK, whose first call is slow
        (a, b), (c, d) = matrix.tolist()
        root = math.sqrt(max(0.0, (a - d) ** 2 + 4.0 * b * c))
        return max(0.0, -(a + d + root) / 2.0)
    return max(0.0, float(-np.linalg.eigvals(matrix).real.max()))


def wall_slopes(
    restitution: float, roughness: float, dimension: int = 2, inertia: float | None = None
) -> np.ndarray:
    """Return the derivatives (2, 2) of the changes of temperatures per hit of a heavy wall at rest.

    Rows and columns are in the order (T_tr, T_rot). The wall has the given restitution and
    roughness beta; `inertia` is q = I/(m a^2) of the particles, by default of uniform ones. Derived
    for this package. With kappa = (1 + beta)/(1 + q), a hit changes the tangential velocity by -q
    kappa (v_t + a w) and a w by -kappa (v_t + a w). Particles that hit a wall have <v_n^2> = 2
    T_tr/m and <v_t^2> = T_tr/m in every direction along the wall.
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
    """Return the derivatives (2, 2) of the changes of temperatures per hit of a thermal wall.

    Rows and columns are in the order (T_tr, T_rot). The wall replaces the velocity and the spin.
    Particles arrive with the mean energy (D + 1) T_tr/2, and leave with (D + 1)/2 times the
    temperature of the wall.
    """
    return np.diag([-(dimension + 1.0) / dimension, -1.0])


def wall_hit_frequency(T_tr: float, length: float) -> float:
    """Return the hits of a particle on a wall at the end of an axis, per unit T of time.

    `T_tr` is in m a^2/T^2, `length` the length of the axis in particle radii a. The frequency is
    the flux of a Maxwellian gas, (T_tr/2 pi m)^(1/2) per particle and length.
    """
    return float(np.sqrt(T_tr / (2.0 * np.pi))) / length


def floor_hit_frequency(T_tr: float, gravity: float) -> float:
    """Return the hits of a particle on the floor that bears its weight, per unit T of time.

    `T_tr` is in m a^2/T^2, `gravity` in a/T^2. A hit transfers the momentum 2 m v_n, on average 2
    (pi m T_tr/2)^(1/2) in a Maxwellian gas.
    """
    return gravity / float(2.0 * np.sqrt(np.pi * T_tr / 2.0))


def viscous_decay(T_tr: float, frequency: float, wavelength: float) -> float:
    """Return the decay rate, in 1/T, of a flow with this `wavelength` (in particle radii a).

    The kinematic viscosity of dilute elastic disks is T_tr/(m nu), nu being `frequency`, the
    contacts of a particle per T; for spheres it is 5/4 of that (S. Chapman & T. G. Cowling, The
    Mathematical Theory of Non-Uniform Gases, 1970, in the first Sonine approximation).
    """
    return T_tr / frequency * (2.0 * np.pi / wavelength) ** 2
