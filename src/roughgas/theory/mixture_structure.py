"""How dense mixtures of disks and spheres are packed: contact values and the equation of state.

The packing phi is the fraction of the area or volume that particles fill; at 0 a gas is dilute.
M_k is the mean of a^k over the particles.
"""

import numpy as np

from roughgas.base import Interval
from roughgas.theory.arguments import check
from roughgas.theory.frequencies import CLOSE_PACKING, VOLUME
from roughgas.theory.mixture_composition import Mixture
from roughgas.theory.mixtures import SURFACE, contact_frequencies


def mixture_contact_values(gas: Mixture, packing) -> np.ndarray:
    """Return chi_ij, the pair distribution at contact, (species, species).

    With z = 2 a_i a_j M_(D-1)/[(a_i + a_j) M_D]: disks 1/(1-phi) + 9 phi z/[16 (1-phi)^2] (J. T.
    Jenkins & F. Mancini, J. Appl. Mech. 54, 27, 1987), spheres 1/(1-phi) + 3 phi z/[2 (1-phi)^2] +
    phi^2 z^2/[2 (1-phi)^3] (T. Boublik, J. Chem. Phys. 53, 471, 1970; E. W. Grundke & D. Henderson,
    Mol. Phys. 24, 269, 1972; L. L. Lee & D. Levesque, Mol. Phys. 26, 1351, 1973). Equal radii give
    `contact_value`.
    """
    phi, D = _packing(gas, packing), gas.dimension
    relative = _mean_power(gas, D - 1) / _mean_power(gas, D)
    z = 2 * np.multiply.outer(gas.radius, gas.radius) / gas.distance * relative
    if D == 2:
        return 1 / (1 - phi) + 9 * phi * z / (16 * (1 - phi) ** 2)
    return 1 / (1 - phi) + 1.5 * phi * z / (1 - phi) ** 2 + (phi * z) ** 2 / (2 * (1 - phi) ** 3)


def mixture_density(gas: Mixture, packing) -> float:
    """Return particles per area or volume, in units of a^-D."""
    return float(_packing(gas, packing) / (VOLUME[gas.dimension] * _mean_power(gas, gas.dimension)))


def mixture_frequency(gas: Mixture, T_tr, packing) -> np.ndarray:
    """Return nu_ij, (species, species): contacts of a particle of i with those of j per time.

    `T_tr` are the temperatures of the species, or one of all. Their sum over j is how often a
    particle of i collides. Equal species give `collision_frequency` in all.
    """
    T_tr = np.broadcast_to(check("temperature T_tr", T_tr), gas.mass.shape)
    crowding = mixture_contact_values(gas, packing)
    return mixture_density(gas, packing) * contact_frequencies(gas, T_tr, crowding)


def compressibility(gas: Mixture, packing, T_tr=1.0) -> float:
    """Return Z = p/(n <T_tr>) of the gas: 1 + the virial of its contacts.

    At contacts, p - n <T_tr> = n^2 S_D/(2 D) sum x_i x_j chi_ij (a_i + a_j)^D (1 + r_ij) m_ij (s_i
    + s_j)/2, S_D as in `mixtures`, m_ij being the reduced mass and s = T_tr/m. In an elastic
    mixture that is the equation of state of A. Santos, S. B. Yuste & M. Lopez de Haro (Mol. Phys.
    96, 1, 1999) for disks, with Henderson's for equal ones, and of Boublik and of G. A. Mansoori,
    N. F. Carnahan, K. E. Starling & T. W. Leland (J. Chem. Phys. 54, 1523, 1971) for spheres.
    """
    T_tr = np.broadcast_to(check("temperature T_tr", T_tr), gas.mass.shape)
    speed, D = T_tr / gas.mass, gas.dimension
    met = np.multiply.outer(gas.fraction, gas.fraction) * mixture_contact_values(gas, packing)
    push = gas.normal * np.add.outer(speed, speed) / 2
    virial = SURFACE[D] / (2 * D) * (met * gas.distance**D * push).sum()
    return float(1 + mixture_density(gas, packing) * virial / (gas.fraction @ T_tr))


def _mean_power(gas: Mixture, power: int) -> float:
    return gas.fraction @ gas.radius**power


def _packing(gas: Mixture, packing) -> np.ndarray:
    """Check a packing fraction: smaller ones fill gaps, so that only a full box is too dense."""
    one = (gas.radius == gas.radius[0]).all()
    interval = Interval(f"[0, {CLOSE_PACKING[gas.dimension]:.4f}]" if one else "[0, 1)")
    return check("packing", packing, interval)
