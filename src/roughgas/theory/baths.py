"""Gases in a Langevin bath whose medium rotates, or flows.

r is the normal restitution, beta the roughness, `inertia` q = I/(m a^2), `dimension` D, Omega the
angular velocity of the medium, W the mean angular velocity of the particles, nu the collisions per
particle per time.

A contact changes each of its two spins by -(1 + beta)/(2 (1 + q)) times the part of w1 + w2 across
the normal, which is all of it for disks and 2/3 on average for spheres, and by a multiple of the
relative velocity, whose mean vanishes where both are uncorrelated. Derived for this package.
"""

from typing import NamedTuple

import numpy as np

from roughgas.theory.arguments import POSITIVE, check, material, quotient


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


class KineticPressure(NamedTuple):
    """Components of the kinetic pressure tensor m <c c> of a sheared gas, over its density n.

    c is the velocity relative to the flow v_x = G y; in m a^2/T^2.
    """

    xx: np.ndarray
    xy: np.ndarray
    yy: np.ndarray


def pressure_in_sheared_bath(shear_rate, drag, temperature, interval=0.0) -> KineticPressure:
    """Return the kinetic pressure of particles without contacts in a bath that flows, over n.

    The medium has the `shear_rate` G, and `drag` gamma and noise have the `temperature` T. With
    x = gamma h, h the `interval` between steps: yy = T, xy = -[G T/(2 gamma)] x coth x, and
    xx = T {1 + G^2/(2 gamma^2) [(x/sinh x)^2 + 2 x^2/3]}, averaged over the time between steps. At
    h = 0, x coth x and the bracket are 1; they are 1 + x^2/3 to the next order. Rates are in 1/T.
    Derived for this package.
    """
    G, gamma = check("shear rate", shear_rate), check("drag", drag, POSITIVE)
    T = check("temperature T", temperature)
    x = gamma * check("interval", interval)
    some = np.where(x > 0, x, 1.0)
    along = np.where(x > 0, some / np.tanh(some), 1.0)
    square = np.where(x > 0, (some / np.sinh(some)) ** 2, 1.0) + 2 * x**2 / 3
    ratio = G / gamma
    return KineticPressure(T * (1 + ratio**2 / 2 * square), -ratio * T / 2 * along, T + 0 * along)
