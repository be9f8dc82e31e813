"""Restitution that depends on the normal speed of a contact, or on the time since the last one.

A law has the restitution r at a reference speed, and defines how 1 - r depends on the normal speed;
without a law r is constant. A scene has at most one law.

Power law: 1 - r grows as a power p of the normal speed g, and r falls to a minimum,

    r(g) = max(r_min, 1 - (1 - r) (g/g_0)^p)

with r at g_0. C. Bizon, M. D. Shattuck, J. B. Swift, W. D. McCormick and H. L. Swinney, Phys. Rev.
Lett. 80, 57 (1998) have p = 3/4, g_0 the square root of gravity times the diameter, and r_min = r =
0.7. p is a multiple of 1/4, so that the power is made of square roots and products.

Table of the restitution over the normal speed, measured or computed: linear interpolation between
the speeds of the table, constant beyond. The table also applies to contacts of other materials:
their 1 - r is proportional to the table's, and r is their restitution at the speed `reference`.

Viscoelastic particles are more elastic in slower contacts. R. Ramirez, T. Poeschel,
N. V. Brilliantov and T. Schwager, Phys. Rev. E 60, 4465 (1999): the restitution depends on the
normal speed g through x ~ g^(1/5) alone,

    r = 1 - x + (3/5) x^2 - 0.315 x^3 + 0.161 x^4 -+ ...

with x = C_1 A alpha^(2/5) g^(1/5) and C_1 = 1.15344 in their notation. Their Pade approximation of
this series holds at all speeds; x follows from r at the reference speed. Roots are computed with
sums, products and quotients alone, so that they have the same bits on every machine.

Threshold: slow contacts are elastic, so that the gas does not collapse. In a cluster that collapses
particles meet at ever lower speeds, and in the end elastically. It is also the simplest model of
plastic particles, which are not dented in slow contacts: K. L. Johnson, Contact Mechanics (1985),
chapter 11.

The contact-time model also prevents the collapse of strongly inelastic gases. S. Luding and
S. McNamara, Granular Matter 1, 113 (1998): a contact within t_c of either particle's previous
contact dissipates no energy of the normal motion. Roughness does not change: if it did, the spins
would be driven towards equipartition.
"""

import math
from itertools import pairwise
from typing import Annotated, NamedTuple

import numpy as np

from roughgas.base import RESTITUTION, InputError
from roughgas.base.fields import Settings, number, numbers
from roughgas.compiling.jit import compiled, jit
from roughgas.effects.settings import register, whole_quarters
from roughgas.kernel.mathematics import quarter_power
from roughgas.kernel.state import EXPONENT

LAWS = ("viscoelastic", "power_law", "restitution_table")
"""Effects that define r as a function of the normal speed; a scene has at most one."""


def check_only_law(context):
    """Raise InputError for a scene with two laws of restitution; `context` is its SceneContext."""
    laws = [name for name in LAWS if name in context.effects]
    if len(laws) > 1:
        raise InputError("effects", " and ".join(laws), "not both define r of the speed")


class PowerLawSettings(Settings, frozen=True, kw_only=True):
    """Settings of `power_law`."""

    speed: Annotated[
        float,
        number(
            "[1e-09, 1e+09]", "Normal speed at which contacts have their restitution r, in a/T."
        ),
    ]
    exponent: Annotated[
        float, number("(0, 4]", "Power of the normal speed as which 1 - r grows: n/4, n whole.")
    ]
    least: Annotated[
        float,
        number(
            "[0, 1]",
            "Minimum of the restitution, in fast contacts; a material that has less at `speed` "
            "keeps that.",
        ),
    ] = 0.0


class PowerLaw(NamedTuple):
    """Restitution that falls as a power of the normal speed, down to a minimum."""

    speed: float  # at which contacts have the r of their material, in a/T
    quarters: int  # four times the exponent
    minimum: float

    @classmethod
    def from_settings(cls, settings, context):
        """Return the effect from PowerLawSettings and a SceneContext.

        Raises InputError beside another law, and for an exponent that is no multiple of 1/4.
        """
        check_only_law(context)
        quarters = whole_quarters(context, settings.exponent)
        return cls(settings.speed, quarters, settings.least)


@jit
def restitution_by_power(law, account, r, state, i, j, time, speed):
    """Return the restitution of a contact at its normal `speed`, by the power law.

    r is the restitution at the law's reference speed. Hook `restitution` (kernel.hooks), which does
    without the other arguments except State.counts.
    """
    ratio = math.ldexp(abs(speed), int(state.counts[EXPONENT])) / law.speed
    loss = (1.0 - r) * quarter_power(ratio, law.quarters)
    return max(min(r, law.minimum), 1.0 - loss)


register(PowerLaw, PowerLawSettings, restitution=restitution_by_power)


TABLE_SIZE = 32  # maximum; shorter tables are padded, so that all have the same machine code


class RestitutionTableSettings(Settings, frozen=True, kw_only=True):
    """Settings of `restitution_table`."""

    speed: Annotated[
        tuple[Annotated[float, number("[0, inf)")], ...],
        numbers(2, TABLE_SIZE, "Normal speeds, increasing, in a/T."),
    ]
    restitution: Annotated[
        tuple[Annotated[float, number("[0, 1]")], ...],
        numbers(2, TABLE_SIZE, "Restitution at each speed."),
    ]
    reference: Annotated[
        float,
        number("[0, inf)", "Normal speed at which contacts have their restitution r, in a/T."),
    ]


class RestitutionTable(NamedTuple):
    """Restitution interpolated in a table over the normal speed."""

    speed: float  # reference, at which contacts have the r of their material, in a/T
    lowest: float  # 1 - r at the lowest speed, over 1 - r at the reference
    begins: tuple[float, ...]  # lower speed of each interval
    widths: tuple[float, ...]  # of the intervals
    slopes: tuple[float, ...]  # of 1 - r, over 1 - r at the reference, in the intervals

    @classmethod
    def from_settings(cls, settings, context):
        """Return the effect from RestitutionTableSettings and a SceneContext.

        Raises InputError beside another law, and for columns that are no valid table.
        """
        check_only_law(context)
        speeds, values, reference = settings.speed, settings.restitution, settings.reference
        _check_table(speeds, values)
        losses = [1.0 - value for value in values]
        reference_loss = interpolated(*_intervals(speeds, losses), reference)
        if not reference_loss > 0.0:
            key = "effects.restitution_table.reference"
            raise InputError(key, reference, "be a speed at which the table has less than 1")
        return cls(reference, *_intervals(speeds, [loss / reference_loss for loss in losses]))


def _check_table(speeds, values):
    """Raise InputError unless there are as many values as speeds, and the speeds increase."""
    key = "effects.restitution_table"
    if len(values) != len(speeds):
        legal = f"have as many entries as speed, {len(speeds)}"
        raise InputError(f"{key}.restitution", list(values), legal)
    if any(later <= sooner for sooner, later in pairwise(speeds)):
        raise InputError(f"{key}.speed", list(speeds), "increase")


def _intervals(speeds, values):
    """Return a table's value at the lowest speed, and begins, widths and slopes of its intervals.

    The table has `values` at `speeds`. All but the first are tuples padded with zeros to TABLE_SIZE
    - 1 entries.
    """
    widths = [high - low for low, high in pairwise(speeds)]
    rises = [high - low for low, high in pairwise(values)]
    slopes = [rise / width for rise, width in zip(rises, widths, strict=True)]
    padded = (tuple(x) + (0.0,) * (TABLE_SIZE - 1 - len(x)) for x in (speeds[:-1], widths, slopes))
    return values[0], *padded


@compiled
def interpolated(lowest, begins, widths, slopes, speed):
    """Return the table's value at a speed, by linear interpolation: a sum over the intervals.

    `lowest` is the value at the lowest speed; the other arguments are as in `_intervals`.
    """
    value = lowest
    for k in range(len(begins)):
        value += slopes[k] * min(max(speed - begins[k], 0.0), widths[k])
    return value


@jit
def restitution_by_table(table, account, r, state, i, j, time, speed):
    """Return the restitution of a contact at its normal `speed`, by interpolation in the table.

    r is the restitution at the table's reference speed. Hook `restitution` (kernel.hooks), which
    does without the other arguments except State.counts.
    """
    speed = math.ldexp(abs(speed), int(state.counts[EXPONENT]))
    loss = (1.0 - r) * interpolated(table.lowest, table.begins, table.widths, table.slopes, speed)
    return 1.0 - min(max(loss, 0.0), 1.0)


register(RestitutionTable, RestitutionTableSettings, restitution=restitution_by_table)


ABOVE = 2.583  # (1 + ABOVE x)/(1 + b_1 x + ... + b_4 x^4), the Pade approximation
B_1, B_2, B_3, B_4 = 3.583, 2.983, 1.148, 0.326
FIFTH_ROOTS = (  # of 1, 2, 4, 8, 16
    1.0,
    1.148698354997035,
    1.3195079107728942,
    1.515716566510398,
    1.7411011265922482,
)


class ViscoelasticSettings(Settings, frozen=True, kw_only=True):
    """Settings of `viscoelastic`."""

    speed: Annotated[
        float,
        number("(0, inf)", "Normal speed at which contacts have their restitution r, in a/T."),
    ] = 1.0


class Viscoelastic(NamedTuple):
    """Restitution of viscoelastic particles, which falls with the normal speed."""

    speed: float  # at which contacts have the r of their material, in a/T
    root: float  # fifth root of that speed
    restitution: float  # r of the particles
    x: float  # the x of that r

    @classmethod
    def from_settings(cls, settings, context):
        """Return the effect from ViscoelasticSettings and a SceneContext.

        Raises InputError for a scene with another law of restitution.
        """
        check_only_law(context)
        r, speed = context.restitution, settings.speed
        return cls(speed, fifth_root(speed, 0), r, x_of(r) if 0.0 < r < 1.0 else 0.0)


@jit
def restitution_by_law(law, account, r, state, i, j, time, speed):
    """Return the restitution of a contact of viscoelastic particles at its normal `speed`.

    r is the restitution at the law's reference speed. Hook `restitution` (kernel.hooks), which does
    without the other arguments except State.counts.
    """
    if r <= 0.0 or r >= 1.0:
        return r  # at all speeds: limits of the law, x infinite and x = 0
    x = law.x if r == law.restitution else x_of(r)
    return pade(x * fifth_root(abs(speed), int(state.counts[EXPONENT])) / law.root)


@jit
def pade(x):
    """Return the restitution at x >= 0, by the Pade approximation of Ramirez et al. (1999).

    x is proportional to (normal speed)^(1/5).
    """
    return (1.0 + ABOVE * x) / (1.0 + x * (B_1 + x * (B_2 + x * (B_3 + x * B_4))))


@jit
def x_of(r):
    """Return the root x of `pade`(x) = r, for a restitution 0 < r < 1.

    It is the only positive root of r (1 + b_1 x + ...) - 1 - ABOVE x, which Newton's method
    approaches from above, since this polynomial is convex.
    """
    x = 1.0
    while pade(x) > r:
        x *= 2.0
    while True:
        value = (r - 1.0) + x * ((r * B_1 - ABOVE) + x * r * (B_2 + x * (B_3 + x * B_4)))
        slope = (r * B_1 - ABOVE) + x * r * (2.0 * B_2 + x * (3.0 * B_3 + x * 4.0 * B_4))
        next_x = x - value / slope
        if not next_x < x:
            return x
        x = next_x


@jit
def fifth_root(x, exponent):
    """Return the fifth root of x 2^exponent, for x >= 0, with a relative error below 1e-15.

    Halley's method for the mantissa, from an initial error of 0.004: a step reduces an error e to
    2 e^3.
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


register(Viscoelastic, ViscoelasticSettings, restitution=restitution_by_law)


class ThresholdSettings(Settings, frozen=True, kw_only=True):
    """Settings of `threshold`."""

    speed: Annotated[
        float, number("(0, inf)", "Contacts at a lower normal speed are slow, in a/T.")
    ]
    restitution: Annotated[
        float,
        number("[0, 1]", "Restitution of slow contacts; more elastic contacts keep their own."),
    ] = 1.0


class Threshold(NamedTuple):
    """Contacts slower than a threshold have a constant restitution, such as 1."""

    speed: float
    restitution: float


@jit
def restitution_above(threshold, account, r, state, i, j, time, speed):
    """Return the restitution of a contact, r, raised if it is slower than the threshold.

    It is then no less than the threshold's restitution. `speed` is the normal component of the
    relative velocity. Hook `restitution` (kernel.hooks), which does without the other arguments
    except State.counts.
    """
    slow = abs(speed) < math.ldexp(threshold.speed, -int(state.counts[EXPONENT]))
    return max(r, threshold.restitution) if slow else r


register(Threshold, ThresholdSettings, restitution=restitution_above)


BelowR = Annotated[
    float,
    number(
        RESTITUTION.text,
        "The model acts only at points whose r is smaller; if not given, at all points.",
    ),
]


class ContactTimeSettings(Settings, frozen=True, kw_only=True):
    """Settings of `contact_time`."""

    duration: Annotated[float, number("(0, 1e+09]", "Contact time t_c, in T.")]
    below_r: BelowR | None = None


class ContactTime(NamedTuple):
    """Contacts in quick succession are elastic, so that the gas cannot collapse."""

    duration: float

    @classmethod
    def from_settings(cls, settings, context):
        """Return the effect from ContactTimeSettings and a SceneContext.

        None if all restitutions are `below_r` or more.
        """
        min_r = min([context.restitution, *context.restitution_of_species])
        acts = settings.below_r is None or min_r < settings.below_r
        return cls(settings.duration) if acts else None


def previous_contacts(model, number, rng):
    """Return the initial times (N,) of the previous contacts of N = `number` particles.

    They are all -inf: no contact yet. Hook `particle_times` (kernel.hooks), which draws nothing
    from `rng` here.
    """
    return np.full(number, -math.inf)


@jit
def restitution_in_time(model, account, r, state, i, j, time, speed):
    """Return 1 if i or its partner j had a contact less than `duration` before `time`, else r.

    r is the restitution of the contact by the effects before. Hook `restitution` (kernel.hooks),
    which does without account and speed.
    """
    previous = state.particle_times.contact_time[i]
    if j >= 0:
        previous = max(previous, state.particle_times.contact_time[j])
    return 1.0 if time - previous < math.ldexp(model.duration, int(state.counts[EXPONENT])) else r


@jit
def after_contact(model, account, state, i, time):
    """Store `time` as the time of particle i's previous contact.

    Hook `after_contact` (kernel.hooks), which does without the account.
    """
    state.particle_times.contact_time[i] = time


register(
    ContactTime,
    ContactTimeSettings,
    restitution=restitution_in_time,
    after_contact=after_contact,
    particle_times=previous_contacts,
)
