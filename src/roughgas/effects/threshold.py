"""A threshold: contacts that are slow enough lose nothing, so that the gas does not collapse.

Event-driven simulations have used it in place of a contact time: in a cluster that collapses
particles meet more and more slowly, and in the end elastically. It is also the simplest form of
plastic particles, which leave no dent where they meet slowly: K. L. Johnson, Contact Mechanics
(1985), chapter 11.
"""

import math
from typing import NamedTuple

from roughgas.effects.settings import Number, register
from roughgas.kernel.jit import jit
from roughgas.kernel.state import EXPONENT

SETTINGS = {
    "speed": Number("Contacts at a lower normal speed are slow, in a/T."),
    "restitution": Number(
        "Restitution of slow contacts; more elastic contacts keep their own.",
        "[0, 1]",
        default=1.0,
    ),
}


class Threshold(NamedTuple):
    """Contacts slower than a threshold have a constant restitution, such as 1."""

    speed: float
    restitution: float


@jit
def restitution(threshold, index, r, state, i, j, time, speed):
    slow = abs(speed) < math.ldexp(threshold.speed, -state.counts[EXPONENT])
    return max(r, threshold.restitution) if slow else r


register(Threshold, SETTINGS, restitution=restitution)
