"""Contacts: the spins that they change, Coulomb friction, and sums by effects that only look.

Friction is O. R. Walton's rule with three parameters (r, beta_0, mu), in Particulate Two-Phase Flow
(1993), p. 884: a contact sticks, with the roughness beta_0, unless its tangential impulse would
then exceed mu times the normal one, and slides with just that impulse if it would:

    beta = min{beta_0, -1 + mu (1 + r) (1 + 1/q) |g_n|/|g_t|}

Where particles differ, 1 + 1/q is what an impulse along the surfaces moves them past each other by,
over what one along the normal moves the centres by; and mu is that of the pair.

Averages over collisions are what the theory is about. McNamara & Luding (1998) average over the
collisions of pairs: v_t is the tangential part of the relative velocity of the centres, v_r = -a
(w1 + w2) x n that of the surfaces due to both spins (Eq. collrule). Where nothing but contacts
changes the rotational energy of a steady state, their squares and their product are tied together
(theory.correlated_ratio). Where particles differ, v_t is weighted with the root of twice the
reduced mass of the pair, v_r with that of twice its reduced m q: if all species had one temperature
of translation and one of rotation, the mean squares would be 2 (D-1) times these. Then q = 1
belongs to the sums.

Collisional stress, for the observable `stress`: in a contact the momentum -push passes to particle
i, and is carried at once from the centre of j to that of i, over 2a where particles are alike.
Summed over contacts, per time and volume, that is the collisional part of the pressure tensor (the
virial of J. H. Irving & J. G. Kirkwood, J. Chem. Phys. 18, 817 (1950)).
"""

import math
from itertools import product
from typing import NamedTuple

from roughgas.base import NeedsError
from roughgas.effects.settings import Number, register
from roughgas.kernel.jit import jit
from roughgas.kernel.particles import pair_of, reach_of
from roughgas.kernel.vectors import add_scaled, dot, spin_cross

SPIN_SETTINGS = {
    "inertia": Number("q = I/(m a^2), 1/2 for disks and 2/5 for spheres.", "[1e-06, 1]")
}


class Spin(NamedTuple):
    """Particles spin; rough contacts exchange energy between translation and rotation."""

    inertia: float


register(Spin, SPIN_SETTINGS)


FRICTION_SETTINGS = {"mu": Number("Coefficient of friction; 0 is a smooth gas.", "[0, inf)")}


class Friction(NamedTuple):
    """Contacts slide where sticking would take more than mu times the normal impulse (Coulomb)."""

    mu: float
    inertia: float  # q of the particles

    @classmethod
    def from_settings(cls, settings, around):
        """Return the effect; raise InputError where nothing spins."""
        if "spin" not in around.effects:
            raise NeedsError("effects.friction", "spin")
        inertia = around.effects["spin"]["inertia"]
        return cls(**settings, inertia=float(inertia))


@jit
def roughness(friction, index, beta, r, speed, slip, pair):
    mu = friction.mu if pair.mu is None else pair.mu
    ease = pair.mass * pair.inertia / pair.bulk + pair.mass / pair.bulk
    most = mu * (1.0 + r) * ease * abs(speed)
    sliding = math.sqrt(dot(slip, slip))
    return beta if (1.0 + beta) * sliding <= most else most / sliding - 1.0


register(Friction, FRICTION_SETTINGS, roughness=roughness)


SQUARES = {"v_t^2": 2, "v_r^2": 2, "v_t.v_r": 2}


class ContactAverages(NamedTuple):
    """Measures R averaged over collisions, from sums over all contacts of pairs."""

    @classmethod
    def from_settings(cls, settings, around):
        """Return the effect; raise InputError where nothing spins."""
        if "spin" not in around.effects:
            raise NeedsError("effects.contact_averages", "spin")
        return cls()


@jit
def observe_squares(averages, index, state, i, j, n, v, w, push):
    sums = state.sums.contact_averages
    v_t = add_scaled(v, n, -dot(v, n))
    minus_v_r = spin_cross(w, n)
    m, s = _weights(state.bodies, i, j)
    sums[0, 0] += m * dot(v_t, v_t)
    sums[0, 1] += s * dot(minus_v_r, minus_v_r)
    sums[0, 2] -= math.sqrt(m * s) * dot(v_t, minus_v_r)


@jit
def _weights(bodies, i, j):
    if bodies is None:
        return 1.0, 1.0
    pair = pair_of(bodies, None, i, j)
    return pair.mass, pair.bulk


register(ContactAverages, {}, observe_contact=observe_squares, sums=SQUARES)


AXES = "xyz"
STRESSES = {f"J_{k} s_{along}": 1 for k, along in product(AXES, AXES)}
"""Momentum times distance: its component k, carried along an axis."""


class ContactStress(NamedTuple):
    """Measures the collisional stress, from sums over all contacts of pairs."""


@jit
def observe_stress(stress, index, state, i, j, n, v, w, push):
    sums = state.sums.contact_stress
    far = reach_of(state.bodies, i, j)
    for k in range(len(n)):
        for along in range(len(n)):
            sums[0, 3 * k + along] -= push[k] * far * n[along]


register(ContactStress, {}, observe_contact=observe_stress, sums=STRESSES)
