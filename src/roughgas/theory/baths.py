"""Gases in a Langevin bath whose medium rotates.

r is the normal restitution, beta the roughness, `inertia` q = I/(m a^2), `dimension` D, Omega the
angular velocity of the medium, W the mean angular velocity of the particles, nu the collisions per
particle per time.

A contact changes each of its two spins by -(1 + beta)/(2 (1 + q)) times the part of w1 + w2 across
the normal, which is all of it for disks and 2/3 on average for spheres, and by a multiple of the
relative velocity, whose mean vanishes where both are uncorrelated. Derived for this package.
"""

import numpy as np

from roughgas.theory.arguments import check, material, quotient


def mean_spin_decay(beta, dimension=2, inertia=None) -> np.ndarray:
    """Return the decay rate of the mean spin W due to contacts, per collision per particle.

    It is (1 + beta)/(1 + q) for disks, and 2/3 of this for spheres; the spins of the two partners
    are uncorrelated.
    """
    _, beta, dimension, q = material(1.0, beta, dimension, inertia)
    return (1 + beta) / (1 + q) * {2: 1.0, 3: 2.0 / 3.0}[dimension]


def mean_spin_of_spinners(beta, frequency, spin_drag, dimension=2, inertia=None) -> np.ndarray:
    """Return the mean spin of a gas over the spin velocity of its medium, W/Omega, from 0 to 1.

    Drag leads spins to Omega and contacts stop them: W/Omega = 1/(1 + nu c/`spin_drag`), with c =
    `mean_spin_decay` and nu = `frequency`, the collisions per particle per time
    (`collision_frequency`). It holds for a dilute gas with weak drag on velocities, whose partners
    are uncorrelated: where drag holds particles in place, the same ones meet again. Drag and
    frequency are in 1/T.
    """
    drag = check("drag of spins", spin_drag)
    nu = check("frequency", frequency)
    return quotient(drag, drag + nu * mean_spin_decay(beta, dimension, inertia))
