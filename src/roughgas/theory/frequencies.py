"""How often particles collide in a gas in equilibrium (Enskog), in 2D and 3D; radius a = 1.

`packing` phi is the fraction of the area or volume that particles fill, from 0 to close packing.
"""

import math
from collections.abc import Sequence

import numpy as np

from roughgas.base import Interval
from roughgas.theory.arguments import check, check_dimension
from roughgas.theory.shares import quotient

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
