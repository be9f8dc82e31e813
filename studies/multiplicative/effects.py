"""Multiplicative driving: random kicks whose strength grows with the speed of the particle.

R. Cafiero, S. Luding & H. J. Herrmann, Phys. Rev. Lett. 84, 6014 (2000), drive each particle by
noise proportional to a power delta of its speed v. Here kicks are those of the thermostat, times
(v/v_0)^delta for the particle that starts the kick; its partner gets the opposite kick, so that
momentum is conserved. delta = 0 is the thermostat.
"""

import math
from typing import Annotated, NamedTuple

import roughgas
from roughgas.base.fields import number
from roughgas.compiling.jit import jit
from roughgas.effects.drives import Thermostat, ThermostatSettings, first_kick_times, kick_pair
from roughgas.effects.settings import register, whole_quarters
from roughgas.kernel.mathematics import dot, quarter_power
from roughgas.kernel.particles import position_in_box


class SpeedKicksSettings(ThermostatSettings, frozen=True, kw_only=True):
    """Settings of `speed_kicks`: of the thermostat at the reference speed, and the power."""

    speed: Annotated[float, number("[1e-09, 1e+09]", "Speed v_0 with the given power, in a/T.")]
    exponent: Annotated[
        float, number("[0, 4]", "Power delta of the speed as which kicks grow: n/4, n whole.")
    ]


class SpeedKicks(NamedTuple):
    """Random kicks whose strength grows as a power of the speed of the particle."""

    push: float  # maximum component of a kick to the velocity, at the reference speed, in a/T
    turn: float  # the same for a kick to the spin
    interval: float
    speed: float  # reference, in a/T
    quarters: int  # four times the exponent

    @classmethod
    def from_settings(cls, settings, context):
        """Return the effect from SpeedKicksSettings and a SceneContext.

        Raises InputError for an exponent that is no multiple of 1/4, and as the thermostat.
        """
        quarters = whole_quarters(context, settings.exponent)
        return cls(*Thermostat.from_settings(settings, context), settings.speed, quarters)


@jit
def predict_kick(kicks, account, state, scene, i):
    """Return the time of the next kick that particle i starts, and 0, its only event code."""
    return state.particle_times.speed_kicks[i], 0


@jit
def resolve_kick(kicks, account, code, state, scene, i, time):
    """Kick particle i and a random partner at `time`, by the speed of i; return the partner."""
    _, velocity = position_in_box(state, scene, i, time)
    growth = quarter_power(math.sqrt(dot(velocity, velocity)) / kicks.speed, kicks.quarters)
    thermostat = Thermostat(kicks.push * growth, kicks.turn * growth, kicks.interval)
    partner = kick_pair(thermostat, account, state, scene, i, time)
    state.particle_times.speed_kicks[i] += kicks.interval
    return partner


register(
    SpeedKicks,
    SpeedKicksSettings,
    particle_times=first_kick_times,
    predict=predict_kick,
    resolve=resolve_kick,
    random=True,
    drives=True,
)
roughgas.register_effect("speed_kicks", SpeedKicks, before="langevin")
