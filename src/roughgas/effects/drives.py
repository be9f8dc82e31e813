"""Effects that drive all particles: shear, random kicks, and the Delta model.

Shear through Lees-Edwards boundaries. The box is periodic; its image above (along the second axis)
moves along the first axis at the velocity U, the image below at -U. A particle that leaves at the
top enters at the bottom with its velocity reduced by U. The shear does work on particles that cross
the boundary, and in contacts across it, where the impulses on the two partners are opposite but
their velocities differ.

The thermostat kicks pairs of particles at random, a chosen share of the energy into the spins.
Every particle starts a kick once per `interval`, the particles in a random order and evenly spaced,
and draws a partner from all others. The two get opposite random velocities, so that momentum is
conserved, and independent spins. Kicks are spread over time rather than given to all at once, since
right after simultaneous kicks a gas is hotter than on average.

Each component of a kick is uniform in [-k, k]; the sum of many small kicks is Gaussian (white
noise). On average they supply the energy `power` per particle and time, a share 1 - s to
translation and s to rotation. Units: a = m = T = 1.

Where particles differ, their momenta change by opposite amounts: the mean energy of a kick is
independent of the pair, and particle i receives the share m_j/(m_i + m_j), larger if it is lighter.

The Delta model is a monolayer that is shaken from below, without its third axis: vertical motion
passes energy to horizontal motion in contacts. R. Brito, D. Risso & R. Soto, Phys. Rev. E 87,
022209 (2013): a pair that approaches at the normal speed g parts at r g + 2 Delta. A contact adds
(m/4) [(r^2 - 1) g^2 + 4 r Delta g + 4 Delta^2] to the energy. The first term is the contacts' loss,
the rest the drive's gain; where masses differ, m is twice the reduced mass. With Coulomb friction a
contact slides where sticking would take more than mu times the whole normal impulse.
"""

import math
from typing import Annotated, NamedTuple

from roughgas.base import InputError, NeedsError
from roughgas.base.fields import Settings, number
from roughgas.compiling.jit import jit
from roughgas.effects.settings import register
from roughgas.kernel.mathematics import add_scaled, divide, random_vector, scale, uniform
from roughgas.kernel.particles import (
    change_spin_and_book,
    enter_box,
    mass_of,
    pair_of,
    set_path_and_book,
    spin_mass_of,
    spin_of,
)


class ShearSettings(Settings, frozen=True, kw_only=True):
    """Settings of `shear`."""

    velocity: Annotated[
        float,
        number("(0, 10000]", "Velocity U of the images above relative to the box, in a/T."),
    ]


class Shear(NamedTuple):
    """Lees-Edwards boundaries: images along the second axis slide along the first."""

    velocity: float
    length: float  # of the box along the first axis, in a
    initial_offset: float = 0.0  # offset of the image above at time 0, from 0 to L

    @classmethod
    def from_settings(cls, settings, context):
        """Return the effect from ShearSettings and a SceneContext.

        Raises InputError for a box that is not periodic along its first two axes.
        """
        if None in context.box[:2]:
            raise NeedsError("effects.shear", "a box periodic in both directions")
        return cls(settings.velocity, context.box[0])

    def continuing(self, before: "Shear", time: float) -> "Shear":
        """Return the effect with the same offset of images at `time` (T) as the effect `before`."""
        return self._replace(
            initial_offset=(offset_at(before, time) - self.velocity * time) % self.length
        )


@jit
def offset(shear, account, base):
    """Return the offset of the image of the box above at absolute time `base`, from 0 to L.

    In particle radii a; L is the length of the box along the first axis. Hook `phase`
    (kernel.hooks), which does without the account.
    """
    shift = shear.velocity * (base % (shear.length / abs(shear.velocity))) + shear.initial_offset
    return shift if shift <= shear.length else shift - shear.length


@jit
def transfer(shear, account, state, work):
    """Enter the work of a drive where particles, or their partners, are replaced by other images.

    Hook `transfer` (kernel.hooks); `account` is the index of the effect's account in the ledger.
    """
    state.ledger[0, account, 0] += work


@jit
def image_shift(shear, account, state):
    """Return offset and velocity of the image of the box above, at the clock's base.

    Hook `image_shift` (kernel.hooks); `account` is the index of the offset in State.phase.
    """
    return state.phase[account], shear.velocity


def offset_at(shear, time):
    """Return the offset of the image of the box above at absolute `time` (T), from 0 to L.

    In particle radii a; L is the length of the box along the first axis.
    """
    return (shear.initial_offset + shear.velocity * time) % shear.length


register(
    Shear,
    ShearSettings,
    image_shift=image_shift,
    transfer=transfer,
    phase=offset,
    displacement=offset_at,
    drives=True,
)


class ThermostatSettings(Settings, frozen=True, kw_only=True):
    """Settings of `thermostat`."""

    power: Annotated[
        float, number("(0, 1e+12]", "Energy put in per particle and time, in m a^2/T^3.")
    ]
    spin_share: Annotated[float, number("[0, 1]", "Share of the power that goes into rotation.")]
    interval: Annotated[
        float, number("[0.0001, 1e+09]", "Time between the kicks that a particle starts, in T.")
    ]


class Thermostat(NamedTuple):
    """Random kicks to pairs of particles; a chosen share of their energy goes into rotation."""

    push: float  # maximum component of a kick to the velocity, in a/T
    turn: float  # the same for a kick to the spin, as a surface velocity
    interval: float

    @classmethod
    def from_settings(cls, settings, context):
        """Return the effect from ThermostatSettings and a SceneContext.

        Raises InputError for a single particle, and for a spin_share > 0 if particles do not spin.
        """
        if context.particles == 1:
            raise InputError("particles", 1, "be at least 2 where a thermostat kicks pairs")
        dimension, share = len(context.box), settings.spin_share
        if "spin" not in context.effects and share > 0.0:
            key = f"effects.{context.name}.spin_share"
            raise InputError(key, share, "be 0 where nothing spins")
        inertia = context.effects["spin"].inertia if "spin" in context.effects else 1.0
        energy = settings.power * settings.interval  # of one kick
        # <x^2> = k^2/3; two particles with m v^2/2 each, and as many spins with q m (a w)^2/2 each
        push = math.sqrt(3.0 * (1.0 - share) * energy / dimension)
        turn = math.sqrt(3.0 * share * energy / (inertia * (2 * dimension - 3)))
        return cls(push, turn, settings.interval)


def first_kick_times(thermostat, number, rng):
    """Return the times (N,) of the first kick that each of N = `number` particles starts, in T.

    They are spaced evenly over one interval, in a random order. Hook `particle_times`
    (kernel.hooks).
    """
    return thermostat.interval * (1.0 + rng.permutation(number)) / number


@jit
def predict_kick(thermostat, account, state, scene, i):
    """Return the time of the next kick that particle i starts, and 0, its only event code.

    Hook `predict` (kernel.hooks), which does without the account.
    """
    return state.particle_times.thermostat[i], 0


@jit
def resolve_kick(thermostat, account, code, state, scene, i, time):
    """Kick particle i and a random partner at `time`, in opposite directions; return the partner.

    Hook `resolve` (kernel.hooks): the energy gained is entered in the effect's account, whose index
    is `account`; the code is always 0.
    """
    partner = kick_pair(thermostat, account, state, scene, i, time)
    state.particle_times.thermostat[i] += thermostat.interval
    return partner


@jit
def kick_pair(thermostat, account, state, scene, i, time):
    """Kick particle i and a random partner at `time`; return the partner.

    The arguments are as in `resolve_kick`.
    """
    number_of_partners = len(state.changes) - 1
    partner = int(uniform(state.random) * number_of_partners)
    partner += partner >= i
    max_momentum = thermostat.push * math.sqrt(
        pair_of(state.bodies, scene.effects.spin, i, partner).mass
    )
    kick = random_vector(state.random, scene.box, max_momentum)
    _kick(state, scene, account, i, kick, 1.0, time)
    _kick(state, scene, account, partner, kick, -1.0, time)
    if state.spin is not None:
        _kick_spin(thermostat, account, state, scene, i)
        _kick_spin(thermostat, account, state, scene, partner)
    return partner


@jit
def _kick(state, scene, account, i, kick, sign, time):
    """Add `sign` times the momentum `kick` to particle i at `time`, and enter the energy gained."""
    position, before = enter_box(state, scene, i, time)
    after = add_scaled(before, divide(kick, mass_of(state.bodies, i)), sign)
    set_path_and_book(state, scene, i, position, before, after, time, state.ledger[0, account])
    state.changes[i] += 1


@jit
def _kick_spin(thermostat, account, state, scene, i):
    """Kick the spin of particle i, and enter the energy gained in the row `account` of the ledger.

    The mean energy of a kick is the same for all particles.
    """
    effect, before = scene.effects.spin, spin_of(state.spin, scene.box, i)
    spin_change = random_vector(state.random, before, thermostat.turn)
    if state.bodies is not None:
        spin_change = scale(
            spin_change, math.sqrt(effect.inertia / spin_mass_of(state.bodies, effect, i))
        )
    change_spin_and_book(state, scene, i, before, spin_change, state.ledger[0, account])


register(
    Thermostat,
    ThermostatSettings,
    particle_times=first_kick_times,
    predict=predict_kick,
    resolve=resolve_kick,
    random=True,
    drives=True,
)


class DeltaSettings(Settings, frozen=True, kw_only=True):
    """Settings of `delta`."""

    speed: Annotated[
        float,
        number("(0, 10000]", "Delta, half the normal speed that a contact of a pair adds, in a/T."),
    ]


class Delta(NamedTuple):
    """Contacts of pairs gain the normal speed 2 Delta, as in a monolayer that is shaken."""

    speed: float


@jit
def speed_gain(delta, account):
    """Return the speed 2 Delta that contacts of pairs add to the normal speed of parting.

    Hook `speed_gain` (kernel.hooks), which does without the account.
    """
    return 2.0 * delta.speed


register(Delta, DeltaSettings, speed_gain=speed_gain, drives=True)
