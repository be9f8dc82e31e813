"""What velocities that are not quite Maxwellian change in R of a cooling gas, to first order."""

import numpy as np

from roughgas.theory import collision_rates, moment_of_inertia
from roughgas.theory.shares import positive_root, shares


def corrected_ratio(r, beta, a20, a11, dimension=2, inertia=None) -> np.ndarray:
    """Stationary R of a cooling gas with the cumulants a20 and a11 (see dsmc.Samples); broadcasts.

    Fast particles collide more often than others. Averages over collisions therefore exceed those
    over particles: of v_n^2 and v_t^2 by the factor 1 + a20/4 beyond what a Maxwellian gas has, of
    the squared spin by 1 + a11/4 where fast particles spin faster. With these factors the rate
    equations are balanced again, as for Eq. (K), which is the case a20 = a11 = 0. First order in
    the cumulants, in any number of dimensions, but that spheres whose spin is not isotropic about
    their velocity have a further term, which is left out. Raises InputError.
    """
    q = moment_of_inertia(dimension) if inertia is None else inertia
    rates = collision_rates(r, beta, dimension, q)
    translation, rotation = 1 + np.asarray(a20) / 4, 1 + np.asarray(a11) / 4
    numerator, denominator = positive_root(
        rotation * rates.translational_gain,
        translation * rates.translational_loss - rotation * rates.rotational_loss,
        translation * rates.rotational_gain,
    )
    return shares(denominator, numerator, neither=0)[1][()]
