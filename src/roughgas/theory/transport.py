"""Collision frequencies, shear and heat flux: what depends on density and on gradients.

How often particles collide in a gas in equilibrium (Enskog), in 2D and 3D; radius a = 1.

`packing` phi is the fraction of the area or volume that particles fill, from 0 to close packing.

Lun's formula in a gas that is sheared: what the mean flow and the stress change at contacts.

Heat that flows through a gas at rest between two thermal walls.

Where the mean free path is much longer than the gap, particles fly from wall to wall. They leave a
wall of temperature T with the velocity component v across the gap distributed as
v exp(-m v^2/(2 T)), so that a flight takes gap sqrt(pi m/(2 T)) on average and carries the energy
[(D + 1)/2 + n_r/2] T, n_r = 2 D - 3 where they spin. Where it is much shorter, Fourier's law holds.
Fluxes are in m/T^3 (times a^(3-D)): energy per time and per length or area of a wall.
"""

import math
from collections.abc import Sequence

import numpy as np

from roughgas.base import Interval
from roughgas.theory.arguments import POSITIVE, check, check_dimension, quotient
from roughgas.theory.closed_forms import lun_ratio

CLOSE_PACKING = {2: np.pi / np.sqrt(12), 3: np.pi / np.sqrt(18)}
"""Packing fraction of the densest arrangement of disks and of spheres."""


VOLUME = {2: np.pi, 3: 4 * np.pi / 3}
"""Area of a disk and volume of a sphere, in a^D."""


def packing_fraction(particles: int, box: Sequence[float]) -> float:
    """Return phi of so many particles in a box with sides of these lengths (a)."""
    return particles * VOLUME[check_dimension(len(box))] / math.prod(box)


def number_density(packing, dimension=2) -> np.ndarray:
    """Return particles per area (2D) or volume (3D), in units of a^-D."""
    packing, dimension = _packing(packing, dimension)
    return packing / VOLUME[dimension]


def contact_value(packing, dimension=2) -> np.ndarray:
    """Return chi, the pair distribution at contact: Henderson (2D), Carnahan & Starling (3D).

    chi = (1 - 7 phi/16)/(1 - phi)^2 and (1 - phi/2)/(1 - phi)^3; good below the fluid's freezing.
    """
    packing, dimension = _packing(packing, dimension)
    if dimension == 2:
        return (1 - 7 * packing / 16) / (1 - packing) ** 2
    return (1 - packing / 2) / (1 - packing) ** 3


def collision_frequency(T_tr, packing, dimension=2) -> np.ndarray:
    """Return nu, collisions per particle per time (1/T); a collision counts for both particles.

    nu = 4 a n chi sqrt(pi T_tr/m) in 2D and 16 sqrt(pi) a^2 n chi sqrt(T_tr/m) in 3D, for a
    Maxwellian gas of number density n. T_tr = m <v^2>/D >= 0.
    """
    T_tr = check("temperature T_tr", T_tr)
    per_speed = {2: 4, 3: 16}[check_dimension(dimension)] * np.sqrt(np.pi)
    crowding = number_density(packing, dimension) * contact_value(packing, dimension)
    return per_speed * crowding * np.sqrt(T_tr)


def mean_free_path(packing, dimension=2) -> np.ndarray:
    """Return the mean path between collisions, <|v|>/nu, in radii a; infinite at packing 0.

    With <|v|> = sqrt(pi T_tr/2) in 2D and sqrt(8 T_tr/pi) in 3D.
    """
    speed = {2: np.sqrt(np.pi / 2), 3: np.sqrt(8 / np.pi)}[check_dimension(dimension)]
    return quotient(speed, collision_frequency(1.0, packing, dimension))


def _packing(packing, dimension) -> tuple[np.ndarray, int]:
    dimension = check_dimension(dimension)
    return check("packing", packing, Interval(f"[0, {CLOSE_PACKING[dimension]:.4f}]")), dimension


def shear_factor(rate, stress, difference) -> np.ndarray:
    """Return theta = T_rot/T_tr of sheared disks over Lun's formula, whatever r, beta and q.

    Parameters: the shear rate g = Gamma a (m/T_tr)^(1/2); of the velocities without the mean flow,
    the stress p = -m <v_x v_y>/T_tr and the normal stress difference d = (T_x - T_y)/(2 T_tr). To
    second order in g, p and d, with Gaussian velocities (an anisotropic Maxwellian; as Jenkins and
    Richman, J. Fluid Mech. 192, 313 (1988), have it) that are uncorrelated before contacts,

        theta/theta_lun = 1 + (p^2 + d^2)/4 + sqrt(pi) g p/4 + g^2/4.

    The drive puts in no rotation: C_r1 <v_t^2> - C_r2 <v_t.v_r> - C_r3 <v_r^2> = 0, of velocities
    with the mean flow and the mean spin -Gamma/2, which take part in contacts; averaged over
    contacts, <v_t^2> = 2 T_tr [1 + (p^2 + d^2)/4 + sqrt(pi) g p/4 + 3 g^2/4]/m,
    <v_t.v_r> = -Gamma^2 and <v_r^2> = 2 T_rot/(q m) + Gamma^2 (a = 1). Temperatures are those
    without mean flow and mean spin.
    """
    g, p, d = check("shear rate g", rate), np.asarray(stress), np.asarray(difference)
    return 1 + (p**2 + d**2) / 4 + np.sqrt(np.pi) * g * p / 4 + g**2 / 4


def sheared_ratio(beta, inertia, rate, stress, difference) -> np.ndarray:
    """Return R of sheared disks: that of Lun's formula, with theta times `shear_factor`."""
    lun = lun_ratio(beta, inertia)
    gain = lun * shear_factor(rate, stress, difference)
    return gain / (gain + 1 - lun)


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
