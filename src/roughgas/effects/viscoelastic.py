"""Viscoelastic particles: the more slowly they meet, the more elastic they are.

R. Ramirez, T. Poeschel, N. V. Brilliantov and T. Schwager, Phys. Rev. E 60, 4465 (1999): the
restitution of viscoelastic spheres depends on the normal speed g through x ~ g^(1/5) alone,

    r = 1 - x + (3/5) x^2 - 0.315 x^3 + 0.161 x^4 -+ ...

with x = C_1 A alpha^(2/5) g^(1/5) and C_1 = 1.15344 in their terms. Their Pade approximation, which
has this series, holds at all speeds; x follows from r at one of them. Roots are taken by sums,
products and quotients alone, so that they have the same bits on every machine.
"""

import math
from typing import NamedTuple

from roughgas.base import InputError
from roughgas.effects.settings import Number, register
from roughgas.kernel.jit import jit
from roughgas.kernel.state import EXPONENT

SETTINGS = {
    "speed": Number("Normal speed at which contacts have their restitution r, in a/T.", default=1.0)
}
ABOVE = 2.583  # (1 + ABOVE x)/(1 + b_1 x + ... + b_4 x^4), the Pade approximation
B_1, B_2, B_3, B_4 = 3.583, 2.983, 1.148, 0.326
FIFTH_ROOTS = (  # of 1, 2, 4, 8, 16
    1.0,
    1.148698354997035,
    1.3195079107728942,
    1.515716566510398,
    1.7411011265922482,
)


class Viscoelastic(NamedTuple):
    """Restitution of viscoelastic particles, which falls with the normal speed."""

    speed: float  # at which contacts have the r of their material, in a/T
    root: float  # fifth root of that speed
    restitution: float  # r of the particles
    x: float  # where the law has that r

    @classmethod
    def from_settings(cls, settings, around):
        """Return the effect; raise InputError beside another law."""
        if "restitution_table" in around.effects:
            what = "viscoelastic and restitution_table"
            raise InputError("effects", what, "not both define r of the speed")
        r, speed = around.restitution, settings["speed"]
        return cls(speed, fifth_root(speed, 0), r, x_of(r) if 0.0 < r < 1.0 else 0.0)


@jit
def restitution(law, index, r, state, i, j, time, speed):
    if r <= 0.0 or r >= 1.0:
        return r  # at all speeds: the ends of the law, x infinite and x = 0
    x = law.x if r == law.restitution else x_of(r)
    return pade(x * fifth_root(abs(speed), state.counts[EXPONENT]) / law.root)


@jit
def pade(x):
    """Return the restitution at x >= 0."""
    return (1.0 + ABOVE * x) / (1.0 + x * (B_1 + x * (B_2 + x * (B_3 + x * B_4))))


@jit
def x_of(r):
    """Return the x at which the restitution is r, 0 < r < 1.

    It is the only positive root of r (1 + b_1 x + ...) - 1 - ABOVE x, which Newton's method
    approaches from above, since that polynomial is convex.
    """
    x = 1.0
    while pade(x) > r:
        x *= 2.0
    while True:
        value = (r - 1.0) + x * ((r * B_1 - ABOVE) + x * r * (B_2 + x * (B_3 + x * B_4)))
        slope = (r * B_1 - ABOVE) + x * r * (2.0 * B_2 + x * (3.0 * B_3 + x * 4.0 * B_4))
        nearer = x - value / slope
        if not nearer < x:
            return x
        x = nearer


@jit
def fifth_root(x, exponent):
    """Return the fifth root of x 2^exponent, for x >= 0, within 1e-15 of it.

    Halley's method for that of the mantissa, from within 0.004 of it: the error of a root, e, is
    2 e^3 after a step.
    """
    if x == 0.0:
        return 0.0
    mantissa, power = math.frexp(x)
    power += exponent
    fifth = power // 5
    root = 0.744 + 0.258 * mantissa
    for _ in range(2):
        square = root * root
        fifth_power = square * square * root
        root *= (2.0 * fifth_power + 3.0 * mantissa) / (3.0 * fifth_power + 2.0 * mantissa)
    return math.ldexp(root * FIFTH_ROOTS[power - 5 * fifth], fifth)


register(Viscoelastic, SETTINGS, restitution=restitution)
