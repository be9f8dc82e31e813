"""Heat that flows through a gas at rest between two thermal walls.

Where the mean free path is much longer than the gap, particles fly from wall to wall. They leave a
wall of temperature T with the velocity component v across the gap distributed as
v exp(-m v^2/(2 T)), so that a flight takes gap sqrt(pi m/(2 T)) on average and carries the energy
[(D + 1)/2 + n_r/2] T, n_r = 2 D - 3 where they spin. Where it is much shorter, Fourier's law holds.
Fluxes are in m/T^3 (times a^(3-D)): energy per time and per length or area of a wall.
"""

import math

import numpy as np

from roughgas.theory.arguments import POSITIVE, check, check_dimension


def free_molecular_flux(hot, cold, particles, gap, dimension=2, spins=False) -> np.ndarray:
    """Return the flux from the wall at temperature `hot` to the one at `cold`, without collisions.

    `particles` is their number per length (2D) or area (3D) of a wall, in a^(1-D); `gap` the room
    that their centres have between the walls, in a. `spins`: they have spins that walls change.
    """
    hot, cold = check("temperature hot", hot, POSITIVE), check("temperature cold", cold, POSITIVE)
    dimension, gap = check_dimension(dimension), check("gap", gap, POSITIVE)
    carried = (dimension + 1 + (2 * dimension - 3 if spins else 0)) / 2 * (hot - cold)
    round_trip = gap * math.sqrt(math.pi / 2) * (1 / np.sqrt(hot) + 1 / np.sqrt(cold))
    return check("particles", particles) * carried / round_trip


def thermal_conductivity(T, dimension=2) -> np.ndarray:
    """Return kappa of dilute smooth elastic disks or spheres of radius 1, in m a^(2-D)/T.

    By Enskog's theory in first Sonine approximation, kappa = [D (D + 2)^2 Gamma(D/2)/(16 (D - 1)
    pi^((D-1)/2))] sqrt(T/m)/(2 a)^(D-1): J. J. Brey and D. Cubero, in Granular Gases (2001), p. 59.
    """
    T, D = check("temperature", T), check_dimension(dimension)
    number = D * (D + 2) ** 2 * math.gamma(D / 2) / (16 * (D - 1) * math.pi ** ((D - 1) / 2))
    return number * np.sqrt(T) / 2 ** (D - 1)


def fourier_flux(hot, cold, gap, dimension=2) -> np.ndarray:
    """Return the flux by Fourier's law between walls with a gap of many mean free paths, in a.

    As kappa goes as T^(1/2), it is the difference of 2/3 kappa T at the walls, over the gap.
    """
    hot, cold = check("temperature hot", hot), check("temperature cold", cold)
    ends = (thermal_conductivity(T, dimension) * T for T in (hot, cold))
    one, other = ends
    return 2 / 3 * (one - other) / check("gap", gap, POSITIVE)


def heat_flux(hot, cold, particles, gap, dimension=2) -> np.ndarray:
    """Return the flux of smooth elastic particles for any gap, between the limits above.

    1/q = 1/q_free + 1/q_Fourier: F. S. Sherman, in Rarefied Gas Dynamics (1963), vol. 2, p. 228;
    within some per cent of measurements.
    """
    free = free_molecular_flux(hot, cold, particles, gap, dimension)
    fourier = fourier_flux(hot, cold, gap, dimension)
    return free * fourier / (free + fourier)
