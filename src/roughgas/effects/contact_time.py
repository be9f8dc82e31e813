"""The contact-time model, which keeps strongly inelastic gases from collapsing.

S. Luding and S. McNamara, Granular Matter 1, 113 (1998): a contact within t_c of either particle's
previous one dissipates nothing along the normal. Roughness is left as it is: switching it, too,
would drive the spins towards equipartition.
"""

import math
from typing import NamedTuple

from roughgas.effects.settings import number
from roughgas.kernel.jit import jit
from roughgas.kernel.state import EXPONENT


class ContactTime(NamedTuple):
    """Contacts in quick succession are elastic along the normal."""

    duration: float  # t_c > 0, in T

    @classmethod
    def from_settings(cls, settings, around):
        """The model, or None where the particles are too elastic to need it."""
        duration = number(settings, "contact_time", "duration")
        if "below_r" in settings:
            limit = number(settings, "contact_time", "below_r", "[0, 1]")
            return cls(duration) if around.restitution < limit else None
        return cls(duration)


@jit
def restitution(model, index, r, state, i, j, time):
    previous = state.last_contact[i]
    if j >= 0:
        previous = max(previous, state.last_contact[j])
    return 1.0 if time - previous < math.ldexp(model.duration, state.counts[EXPONENT]) else r
