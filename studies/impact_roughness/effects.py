"""Roughness that falls with the speed of impact: slow contacts reverse the tangential velocity.

As restitution does in the effects `viscoelastic` and `power_law`, roughness approaches its elastic
value in slow contacts: 1 - beta grows as a power p of the normal speed g, up to 2,

    beta(g) = max(-1, 1 - (1 - beta) (g/g_0)^p)

with beta at g_0. p = 0 is a constant roughness.
"""

import math
from typing import Annotated, NamedTuple

import roughgas
from roughgas.base import NeedsError
from roughgas.base.fields import Settings, number
from roughgas.compiling.jit import jit
from roughgas.effects.settings import register, whole_quarters
from roughgas.kernel.mathematics import quarter_power
from roughgas.kernel.state import EXPONENT


class RoughnessLawSettings(Settings, frozen=True, kw_only=True):
    """Settings of `roughness_law`."""

    speed: Annotated[
        float,
        number("[1e-09, 1e+09]", "Normal speed at which contacts have their roughness, in a/T."),
    ]
    exponent: Annotated[
        float, number("[0, 4]", "Power of the normal speed as which 1 - beta grows: n/4, n whole.")
    ]


class RoughnessLaw(NamedTuple):
    """Roughness that falls as a power of the normal speed, from 1 down to -1."""

    speed: float  # at which contacts have the beta of their material, in a/T
    quarters: int  # four times the exponent

    @classmethod
    def from_settings(cls, settings, context):
        """Return the effect from RoughnessLawSettings and a SceneContext.

        Raises InputError where nothing spins, and for an exponent that is no multiple of 1/4.
        """
        if "spin" not in context.effects:
            raise NeedsError("effects.roughness_law", "spin")
        return cls(settings.speed, whole_quarters(context, settings.exponent))


@jit
def roughness_by_power(law, account, beta, state, i, j, time, speed):
    """Return the roughness of a contact at its normal `speed`; beta is that at the reference.

    Written such that the power 1 returns beta to the last bit.
    """
    ratio = math.ldexp(abs(speed), int(state.counts[EXPONENT])) / law.speed
    return max(-1.0, beta + (1.0 - beta) * (1.0 - quarter_power(ratio, law.quarters)))


register(RoughnessLaw, RoughnessLawSettings, sticking_roughness=roughness_by_power)
roughgas.register_effect("roughness_law", RoughnessLaw)
