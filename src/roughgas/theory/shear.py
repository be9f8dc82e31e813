"""Lun's formula in a gas that is sheared: what the mean flow and the stress change at contacts."""

import numpy as np

from roughgas.theory.arguments import check
from roughgas.theory.closed_forms import lun_ratio


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
