"""Coulomb friction: rough contacts stick or slide.

O. R. Walton's rule with three parameters (r, beta_0, mu), in Particulate Two-Phase Flow (1993),
p. 884: a contact sticks, with the roughness beta_0, unless its tangential impulse would then exceed
mu times the normal one, and slides with just that impulse if it would:

    beta = min{beta_0, -1 + mu (1 + r) (1 + 1/q) |g_n|/|g_t|}

Where particles differ, 1 + 1/q is what an impulse along the surfaces moves them past each other by,
over what one along the normal moves the centres by; and mu is that of the pair.
"""

import math
from typing import NamedTuple

from roughgas.base import NeedsError
from roughgas.effects.settings import Number, register
from roughgas.kernel.hooks import either
from roughgas.kernel.jit import jit
from roughgas.kernel.vectors import dot

SETTINGS = {"mu": Number("Coefficient of friction; 0 is a smooth gas.", "[0, inf)")}


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


_mu = either(lambda pair, friction: pair.mu, lambda pair, friction: friction.mu)

_ease = either(
    lambda pair, friction: pair.mass * pair.inertia / pair.bulk + pair.mass / pair.bulk,
    lambda pair, friction: 1.0 + 1.0 / friction.inertia,
)


@jit
def roughness(friction, index, beta, r, speed, slip, pair):
    most = _mu(pair, friction) * (1.0 + r) * _ease(pair, friction) * abs(speed)
    sliding = math.sqrt(dot(slip, slip))
    return beta if (1.0 + beta) * sliding <= most else most / sliding - 1.0


register(Friction, SETTINGS, roughness=roughness)
