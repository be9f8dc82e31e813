"""Restitution that depends on the contact: on its normal speed, or on the time since the last one.

A law has r at one normal speed, and says how 1 - r depends on the speed; without a law r is
constant. A scene has one law at most.

By a power: 1 - r grows as a power p of the normal speed g, and r falls to a least value,

    r(g) = max(r_min, 1 - (1 - r) (g/g_0)^p)

with r at g_0. C. Bizon, M. D. Shattuck, J. B. Swift, W. D. McCormick and H. L. Swinney, Phys. Rev.
Lett. 80, 57 (1998) have p = 3/4, g_0 the square root of gravity times the diameter, and r_min = r =
0.7. p is a multiple of 1/4, so that the power is made of square roots and products.

From a table over the normal speed, as it was measured, or made by any function. Between the table's
speeds the restitution is on straight lines, beyond them it stays as it is at the ends. What the
table has for the particles also says how other contacts depend on the speed: 1 - r of each is in
proportion to the table's, and r is what it is at the speed `reference`.

Of viscoelastic particles: the more slowly they meet, the more elastic they are. R. Ramirez,
T. Poeschel, N. V. Brilliantov and T. Schwager, Phys. Rev. E 60, 4465 (1999): their restitution
depends on the normal speed g through x ~ g^(1/5) alone,

    r = 1 - x + (3/5) x^2 - 0.315 x^3 + 0.161 x^4 -+ ...

with x = C_1 A alpha^(2/5) g^(1/5) and C_1 = 1.15344 in their terms. Their Pade approximation, which
has this series, holds at all speeds; x follows from r at one of them. Roots are taken by sums,
products and quotients alone, so that they have the same bits on every machine.

Above a threshold: contacts that are slow enough lose nothing, so that the gas does not collapse. In
a cluster that collapses particles meet more and more slowly, and in the end elastically. It is also
the simplest form of plastic particles, which leave no dent where they meet slowly: K. L. Johnson,
Contact Mechanics (1985), chapter 11.

The contact-time model keeps strongly inelastic gases from collapsing, too. S. Luding and
S. McNamara, Granular Matter 1, 113 (1998): a contact within t_c of either particle's previous one
dissipates nothing along the normal. Roughness is left as it is: switching it, too, would drive the
spins towards equipartition.
"""

import math
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from roughgas.base import InputError
from roughgas.compiling.jit import compiled, jit
from roughgas.effects.settings import Number, Numbers, register
from roughgas.kernel.state import EXPONENT

LAWS = ("viscoelastic", "power_law", "restitution_table")
"""Effects that say how r depends on the normal speed, of which a scene has one at most."""


def check_alone(around):
    """Raise InputError where a scene has two laws of restitution."""
    found = [name for name in LAWS if name in around.effects]
    if len(found) > 1:
        raise InputError("effects", " and ".join(found), "not both define r of the speed")


POWER_SETTINGS = {
    "speed": Number(
        "Normal speed at which contacts have their restitution r, in a/T.", "[1e-09, 1e+09]"
    ),
    "exponent": Number("Power of the normal speed as which 1 - r grows: n/4, n whole.", "(0, 4]"),
    "least": Number(
        "Restitution of fast contacts, below which it does not fall; those that have less at "
        "`speed` keep that.",
        "[0, 1]",
        default=0.0,
    ),
}


class PowerLaw(NamedTuple):
    """Restitution that falls as a power of the normal speed, down to a least value."""

    speed: float  # at which contacts have the r of their material, in a/T
    quarters: int  # four times the exponent
    least: float

    @classmethod
    def from_settings(cls, settings, around):
        """Return the effect; raise InputError beside another law, and for other exponents."""
        check_alone(around)
        speed, exponent, least = settings.values()
        if not (4.0 * exponent).is_integer():
            raise InputError("effects.power_law.exponent", exponent, "be a multiple of 1/4")
        return cls(speed, int(4.0 * exponent), least)


@jit
def restitution_by_power(law, index, r, state, i, j, time, speed):
    ratio = math.ldexp(abs(speed), int(state.counts[EXPONENT])) / law.speed
    root, power = math.sqrt(math.sqrt(ratio)), 1.0
    for _ in range(law.quarters):
        power *= root
    return max(min(r, law.least), 1.0 - (1.0 - r) * power)


register(PowerLaw, POWER_SETTINGS, restitution=restitution_by_power)


MOST = 32  # entries: a table that is shorter is filled up, so that all have the same machine code
TABLE_SETTINGS = {
    "speed": Numbers("Normal speeds, increasing, in a/T.", "[0, inf)", 2, MOST),
    "restitution": Numbers("Restitution at each speed.", "[0, 1]", 2, MOST),
    "reference": Number(
        "Normal speed at which contacts have their restitution r, in a/T.", "[0, inf)"
    ),
}


class RestitutionTable(NamedTuple):
    """A table gives the restitution at each normal speed."""

    speed: float  # the reference, at which contacts have the r of their material, in a/T
    lowest: float  # 1 - r at the lowest speed, over that at the reference
    begins: tuple[float, ...]  # speeds at which the straight lines begin,
    widths: tuple[float, ...]  # over how much of speed they go,
    slopes: tuple[float, ...]  # and how steeply the share of 1 - r rises

    @classmethod
    def from_settings(cls, settings, around):
        """Return the effect; raise InputError for columns that are no table."""
        check_alone(around)
        speeds, values, reference = settings.values()
        _check(speeds, values)
        losses = [1.0 - value for value in values]
        whole = share(*_lines(speeds, losses), reference)
        if not whole > 0.0:
            key = "effects.restitution_table.reference"
            raise InputError(key, reference, "be a speed at which the table has less than 1")
        return cls(reference, *_lines(speeds, [loss / whole for loss in losses]))


def _check(speeds, values):
    key = "effects.restitution_table"
    if len(values) != len(speeds):
        legal = f"have as many entries as speed, {len(speeds)}"
        raise InputError(f"{key}.restitution", list(values), legal)
    if any(later <= sooner for sooner, later in pairwise(speeds)):
        raise InputError(f"{key}.speed", list(speeds), "increase")


def _lines(speeds, values):
    """Return the value at the lowest speed, and begins, widths and slopes of the straight lines."""
    widths = [high - low for low, high in pairwise(speeds)]
    rises = [high - low for low, high in pairwise(values)]
    slopes = [rise / width for rise, width in zip(rises, widths, strict=True)]
    filled = (tuple(x) + (0.0,) * (MOST - 1 - len(x)) for x in (speeds[:-1], widths, slopes))
    return values[0], *filled


@compiled
def share(lowest, begins, widths, slopes, speed):
    """Return the value at a speed: the sum of what each straight line adds up to it."""
    found = lowest
    for k in range(len(begins)):
        found += slopes[k] * min(max(speed - begins[k], 0.0), widths[k])
    return found


@jit
def restitution_by_table(table, index, r, state, i, j, time, speed):
    speed = math.ldexp(abs(speed), int(state.counts[EXPONENT]))
    lost = (1.0 - r) * share(table.lowest, table.begins, table.widths, table.slopes, speed)
    return 1.0 - min(max(lost, 0.0), 1.0)


register(RestitutionTable, TABLE_SETTINGS, restitution=restitution_by_table)


VISCOELASTIC_SETTINGS = {
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
        check_alone(around)
        r, speed = around.restitution, settings["speed"]
        return cls(speed, fifth_root(speed, 0), r, x_of(r) if 0.0 < r < 1.0 else 0.0)


@jit
def restitution_by_law(law, index, r, state, i, j, time, speed):
    if r <= 0.0 or r >= 1.0:
        return r  # at all speeds: the ends of the law, x infinite and x = 0
    x = law.x if r == law.restitution else x_of(r)
    return pade(x * fifth_root(abs(speed), int(state.counts[EXPONENT])) / law.root)


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


register(Viscoelastic, VISCOELASTIC_SETTINGS, restitution=restitution_by_law)


THRESHOLD_SETTINGS = {
    "speed": Number("Contacts at a lower normal speed are slow, in a/T."),
    "restitution": Number(
        "Restitution of slow contacts; more elastic contacts keep their own.", "[0, 1]", default=1.0
    ),
}


class Threshold(NamedTuple):
    """Contacts slower than a threshold have a constant restitution, such as 1."""

    speed: float
    restitution: float


@jit
def restitution_above(threshold, index, r, state, i, j, time, speed):
    slow = abs(speed) < math.ldexp(threshold.speed, -int(state.counts[EXPONENT]))
    return max(r, threshold.restitution) if slow else r


register(Threshold, THRESHOLD_SETTINGS, restitution=restitution_above)


CONTACT_TIME_SETTINGS = {
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
def restitution_in_time(model, index, r, state, i, j, time, speed):
    previous = state.moments.contact_time[i]
    if j >= 0:
        previous = max(previous, state.moments.contact_time[j])
    return 1.0 if time - previous < math.ldexp(model.duration, int(state.counts[EXPONENT])) else r


@jit
def after_contact(model, index, state, i, time):
    state.moments.contact_time[i] = time


register(
    ContactTime,
    CONTACT_TIME_SETTINGS,
    restitution=restitution_in_time,
    after_contact=after_contact,
    moment=moment,
)
