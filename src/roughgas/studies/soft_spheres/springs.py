"""From (r, beta) and the duration of a contact to the forces that act in it."""

import math
from typing import NamedTuple

from roughgas.base.legal import ROUGHNESS, Interval

SOFT_RESTITUTION = Interval("(0, 1]")
"""Restitution of soft spheres: at r = 0 a contact would never end."""
POSITIVE = Interval("(0, inf)")


class Springs(NamedTuple):
    """What acts in a contact, per reduced mass; all in 1/T but q.

    The overlap x obeys x'' + 2 gamma x' + (w^2 + gamma^2) x = 0, and the tangential surface
    velocity is g_t(t) = g_t(0) cos(w_t t) while the normal stands still.
    """

    frequency: float  # w
    damping: float  # gamma
    turning: float  # w_t
    inertia: float  # q


def springs(r: float, beta: float, inertia: float, duration: float) -> Springs:
    """Return the forces of a contact of `duration` (T) with restitution r and roughness beta.

    Normal: the overlap is zero again after t_c = pi/sqrt(w0^2 - gamma^2), at exp(-gamma t_c) = r
    times the speed of approach (Luding, Granular Matter 10, 235 (2008), Eqs. 5 and 6). The force is
    attractive towards the end, and is left so. Tangential: an undamped spring turns g_t into
    cos(w_t t_c) g_t = -beta g_t, for every beta in [-1, 1]; the energy left in it when the contact
    ends is lost. A dashpot gives beta < 0 only, where g_t does not change its sign. Raises
    InputError for illegal values.
    """
    SOFT_RESTITUTION.check("restitution r of a soft sphere", r)
    ROUGHNESS.check("roughness beta", beta)
    POSITIVE.check("duration of a contact", duration)
    return Springs(
        frequency=math.pi / duration,
        damping=-math.log(r) / duration,
        turning=math.acos(-beta) / duration,
        inertia=POSITIVE.check("inertia", inertia),
    )
