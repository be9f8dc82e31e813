"""Averages over collisions, which the theory is about: this effect only looks.

McNamara & Luding (1998) average over the collisions of pairs: v_t is the tangential part of the
relative velocity of the centres, v_r = -a (w1 + w2) x n that of the surfaces due to both spins
(Eq. collrule). Where nothing but contacts changes the rotational energy of a steady state, their
squares and their product are tied together (theory.contact_share).

Where particles differ, v_t is weighted with the root of twice the reduced mass of the pair, v_r
with that of twice its reduced m q: if all species had one temperature of translation and one of
rotation, the mean squares would be 2 (D-1) times these. Then q = 1 belongs to the sums.
"""

import math
from typing import NamedTuple

from roughgas.base import NeedsError
from roughgas.effects.settings import register
from roughgas.kernel.hooks import either
from roughgas.kernel.jit import jit
from roughgas.kernel.particles import pair_of
from roughgas.kernel.vectors import add_scaled, dot, spin_cross

SUMS = {"v_t^2": 2, "v_r^2": 2, "v_t.v_r": 2}


class ContactAverages(NamedTuple):
    """Measures R averaged over collisions, from sums over all contacts of pairs."""

    @classmethod
    def from_settings(cls, settings, around):
        """Return the effect; raise InputError where nothing spins."""
        if "spin" not in around.effects:
            raise NeedsError("effects.contact_averages", "spin")
        return cls()


@jit
def observe_contact(averages, index, none, state, i, j, n, v, w, push):
    sums = state.sums.contact_averages
    v_t = add_scaled(v, n, -dot(v, n))
    minus_v_r = spin_cross(w, n)
    m, s = _weights(state.bodies, i, j)
    sums[0, 0] += m * dot(v_t, v_t)
    sums[0, 1] += s * dot(minus_v_r, minus_v_r)
    sums[0, 2] -= math.sqrt(m * s) * dot(v_t, minus_v_r)


def _of_pair(bodies, i, j):
    pair = pair_of(bodies, i, j)
    return pair.mass, pair.bulk


_weights = either(_of_pair, lambda bodies, i, j: (1.0, 1.0))


register(ContactAverages, {}, observe_contact=observe_contact, sums=SUMS)
