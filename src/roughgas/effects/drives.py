"""What acts on all particles: gravity, shear, and random kicks.

Shear through Lees-Edwards boundaries. The box is periodic; its image above (along the second axis)
moves along the first axis at the velocity U, the one below at -U. What leaves at the top enters at
the bottom with U less. This is where the shear does its work: on particles that cross the boundary,
and in contacts across it, where the impulses on the two partners are opposite but the velocities at
which they act differ.

The thermostat kicks pairs of particles at random, a chosen share of the energy into the spins.
Every particle starts a kick once an `interval`, the particles in a random order and evenly spaced,
and draws a partner from all others. The two get opposite random velocities, so that momentum is
conserved, and spins of their own. Kicks are spread over time rather than given to all at once,
since a gas that is looked at right after its kicks seems hotter than it is on average.

Each component of a kick is uniform in [-k, k]; what many small ones add up to is Gaussian (white
noise). On average they put `power` into each particle per time, (1 - s) of it into translation and
s into rotation. Units: a = m = T = 1.

Where particles differ, it is the momenta of the two that are opposite: a kick has on average the
same energy whichever they are, of which the lighter one gets the more, m_j/(m_i + m_j).
"""

import math
from typing import NamedTuple

from roughgas.base import InputError, NeedsError
from roughgas.compiling.jit import jit
from roughgas.effects.settings import Number, register
from roughgas.kernel.mathematics import add_scaled, divide, random_vector, scale, uniform
from roughgas.kernel.particles import (
    enter_box,
    mass_of,
    pair_of,
    set_path_and_book,
    spin_mass_of,
    spin_of,
    turn_and_book,
)

GRAVITY_SETTINGS = {"acceleration": Number("g, in a/T^2.", "[1e-06, 1e+06]")}


class Gravity(NamedTuple):
    """Uniform gravity along the last axis, downwards."""

    acceleration: float


@jit
def acceleration(gravity, index):
    return gravity.acceleration


register(Gravity, GRAVITY_SETTINGS, acceleration=acceleration)


SHEAR_SETTINGS = {
    "velocity": Number("Velocity U of the images above relative to the box, in a/T.", "(0, 10000]")
}


class Shear(NamedTuple):
    """Lees-Edwards boundaries: images along the second axis slide along the first."""

    velocity: float
    length: float  # of the box along the first axis, in a
    begun: float = 0.0  # offset of the image above at time 0, from 0 to L

    @classmethod
    def from_settings(cls, settings, around):
        """Return the effect; raise InputError for a box that is not periodic."""
        if None in around.box[:2]:
            raise NeedsError("effects.shear", "a box periodic in both directions")
        return cls(**settings, length=around.box[0])

    def going_on(self, before: "Shear", time: float) -> "Shear":
        """Return the effect whose images are at `time` (T) where they were `before`."""
        return self._replace(begun=(offset_at(before, time) - self.velocity * time) % self.length)


@jit
def offset(shear, index, base):
    """Return the offset of the image above at absolute time `base`, from 0 to L."""
    found = shear.velocity * (base % (shear.length / abs(shear.velocity))) + shear.begun
    return found if found <= shear.length else found - shear.length


@jit
def transfer(shear, index, state, work):
    state.ledger[0, index, 0] += work


@jit
def sliding(shear, index, state):
    return state.phase[index], shear.velocity


def offset_at(shear, time):
    """Return the offset of the image above at `time`, from 0 to L, in a."""
    return (shear.begun + shear.velocity * time) % shear.length


register(
    Shear,
    SHEAR_SETTINGS,
    sliding=sliding,
    transfer=transfer,
    phase=offset,
    displacement=offset_at,
    drives=True,
)


THERMOSTAT_SETTINGS = {
    "power": Number("Energy put in per particle and time, in m a^2/T^3.", "(0, 1e+12]"),
    "spin_share": Number("Share of the power that goes into rotation.", "[0, 1]"),
    "interval": Number("Time between the kicks that a particle starts, in T.", "[0.0001, 1e+09]"),
}


class Thermostat(NamedTuple):
    """Random kicks to pairs of particles; a chosen share of their energy goes into rotation."""

    push: float  # largest component of a kick to the velocity, in a/T
    turn: float  # the same of a kick to the spin, as a surface velocity
    interval: float

    @classmethod
    def from_settings(cls, settings, around):
        """Return the effect; raise InputError for a share of the spins where there are none."""
        dimension, share = len(around.box), settings["spin_share"]
        if "spin" not in around.effects and share > 0.0:
            raise InputError("effects.thermostat.spin_share", share, "be 0 where nothing spins")
        inertia = around.effects["spin"]["inertia"] if "spin" in around.effects else 1.0
        energy = settings["power"] * settings["interval"]  # of one kick
        # <x^2> = k^2/3; two particles with m v^2/2 each, and as many spins with q m (a w)^2/2 each
        push = math.sqrt(3.0 * (1.0 - share) * energy / dimension)
        turn = math.sqrt(3.0 * share * energy / (inertia * (2 * dimension - 3)))
        return cls(push, turn, settings["interval"])


def first_kicks(thermostat, number, rng):
    """Return when each particle starts its next kick."""
    return thermostat.interval * (1.0 + rng.permutation(number)) / number


@jit
def predict_kick(thermostat, index, state, scene, i):
    return state.moments.thermostat[i], 0


@jit
def resolve_kick(thermostat, index, what, state, scene, i, time):
    """Kick particle i and another one; return the other."""
    others = len(state.changes) - 1
    j = int(uniform(state.random) * others)
    j += j >= i
    size = thermostat.push * math.sqrt(pair_of(state.bodies, scene.effects.spin, i, j).mass)
    kick = random_vector(state.random, scene.box, size)
    _push(state, scene, index, i, kick, 1.0, time)
    _push(state, scene, index, j, kick, -1.0, time)
    if state.spin is not None:
        _turn(thermostat, index, state, scene, i)
        _turn(thermostat, index, state, scene, j)
    state.moments.thermostat[i] += thermostat.interval
    return j


@jit
def _push(state, scene, index, i, kick, sign, time):
    position, before = enter_box(state, scene, i, time)
    after = add_scaled(before, divide(kick, mass_of(state.bodies, i)), sign)
    set_path_and_book(state, scene, i, position, before, after, time, state.ledger[0, index])
    state.changes[i] += 1


@jit
def _turn(thermostat, index, state, scene, i):
    """Kick the spin of particle i; every particle gets the same energy."""
    effect, before = scene.effects.spin, spin_of(state.spin, scene.box, i)
    turn = random_vector(state.random, before, thermostat.turn)
    if state.bodies is not None:
        turn = scale(turn, math.sqrt(effect.inertia / spin_mass_of(state.bodies, effect, i)))
    turn_and_book(state, scene, i, before, turn, state.ledger[0, index])


register(
    Thermostat,
    THERMOSTAT_SETTINGS,
    moment=first_kicks,
    predict=predict_kick,
    resolve=resolve_kick,
    random=True,
    drives=True,
)
