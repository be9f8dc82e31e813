"""The contact-time model, which keeps strongly inelastic gases from collapsing.

S. Luding and S. McNamara, Granular Matter 1, 113 (1998): a contact within t_c of either particle's
previous one dissipates nothing along the normal. Roughness is left as it is: switching it, too,
would drive the spins towards equipartition.
"""

import math
from typing import NamedTuple

import numpy as np

from roughgas.effects.settings import Number, register
from roughgas.kernel.jit import jit
from roughgas.kernel.state import EXPONENT

SETTINGS = {
    "duration": Number("Contact time t_c, in T.", "(0, 1e+09]"),
    "below_r": Number(
        "The model acts only at points whose r is smaller; if not given, at all points.",
        "[0, 1]",
        default=math.inf,
    ),
}


class ContactTime(NamedTuple):
    """Contacts in quick succession are elastic, so that the gas cannot collapse."""

    duration: float

    @classmethod
    def from_settings(cls, settings, around):
        """Return the model, or None where the particles are too elastic to need it."""
        least = min([around.restitution, *around.restitution_of_species])
        return cls(settings["duration"]) if least < settings["below_r"] else None


def moment(model, number, rng):
    """Return when each particle had its previous contact."""
    return np.full(number, -math.inf)


@jit
def restitution(model, index, r, state, i, j, time, speed):
    previous = state.moments.contact_time[i]
    if j >= 0:
        previous = max(previous, state.moments.contact_time[j])
    return 1.0 if time - previous < math.ldexp(model.duration, state.counts[EXPONENT]) else r


@jit
def after_contact(model, index, none, state, i, time):
    state.moments.contact_time[i] = time


register(ContactTime, SETTINGS, restitution=restitution, after_contact=after_contact, moment=moment)
