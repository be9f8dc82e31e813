"""Collisional stress: this effect only looks, for the observable `stress`.

In a contact the momentum -push passes to particle i, and is carried at once from the centre of j to
that of i, over 2a where particles are alike. Summed over contacts, per time and volume, that is the
collisional part of the pressure tensor (the virial of J. H. Irving & J. G. Kirkwood, J. Chem. Phys.
18, 817 (1950)).
"""

from itertools import product
from typing import NamedTuple

from roughgas.effects.settings import register
from roughgas.kernel.jit import jit
from roughgas.kernel.particles import radius_of

AXES = "xyz"
SUMS = {f"J_{k} s_{along}": 1 for k, along in product(AXES, AXES)}
"""Momentum times distance: its component k, carried along an axis."""


class ContactStress(NamedTuple):
    """Measures the collisional stress, from sums over all contacts of pairs."""


@jit
def observe_contact(stress, index, none, state, i, j, n, v, w, push):
    sums, bodies = state.sums.contact_stress, state.bodies
    far = radius_of(bodies, i) + radius_of(bodies, j)
    for k in range(len(n)):
        for along in range(len(n)):
            sums[0, 3 * k + along] -= push[k] * far * n[along]


register(ContactStress, {}, observe_contact=observe_contact, sums=SUMS)
