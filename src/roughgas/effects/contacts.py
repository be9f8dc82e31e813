"""Effects in contacts: spins, Coulomb friction, and passive effects that accumulate sums.

Friction is O. R. Walton's rule with three parameters (r, beta_0, mu), in Particulate Two-Phase Flow
(1993), p. 884: a contact sticks, with the roughness beta_0, unless its tangential impulse would
then exceed mu times the normal impulse, and otherwise slides with exactly that tangential impulse:

    beta = min{beta_0, -1 + mu (1 + r) (1 + 1/q) |g_n|/|g_t|}

Where particles differ, 1 + 1/q is replaced by the change of the slip velocity per tangential
impulse, over the change of the normal velocity per normal impulse; mu belongs to the pair.

Theory is formulated with averages over collisions. McNamara & Luding (1998) average over the
collisions of pairs: v_t is the tangential part of the relative velocity of the centres, and
v_r = -a (w1 + w2) x n the relative velocity of the surfaces due to both spins (Eq. collrule). If
only contacts change the rotational energy of a steady state, their squares and their product are
related (theory.correlated_ratio). Where particles differ, v_t is weighted with the square root of
twice the reduced mass of the pair, v_r with the square root of twice its reduced m q: if all
species had the same translational and the same rotational temperature, the mean squares would be
2 (D-1) times these. With these weights the sums are to be used with q = 1.

Collisional stress, for the observable `stress`: in a contact the momentum -impulse passes to
particle i, from the centre of j to the centre of i, at a distance of 2a where particles are alike.
Summed over contacts, per time and volume, this is the collisional part of the pressure tensor (the
virial of J. H. Irving & J. G. Kirkwood, J. Chem. Phys. 18, 817 (1950)).

Collisional heat flux, for the observables `heat_flux` and `flux_autocorrelation`: energy passes
over the same distance from j to i, namely half the sum of the gain of i and the loss of j. Where
particles are alike it is -impulse.(v_i + v_j)/2 + (n x impulse).(w_i - w_j)/2, with the velocities
and spins after the contact.

The observable `contacts` needs the number of contacts, and the energy that they take from
translation and rotation together. In a mixture all these sums are kept for each pair of species.

The log of contacts is a ring buffer of the last `most` contacts, a row of State.log for each. It
includes contacts with floors and walls that are not thermal.
"""

import math
from itertools import product
from typing import Annotated, NamedTuple

from roughgas.base import NeedsError
from roughgas.base.fields import Settings, number, whole
from roughgas.compiling.jit import jit
from roughgas.effects.settings import register
from roughgas.kernel.mathematics import (
    add_scaled,
    cross_to_spin,
    dot,
    read,
    scale,
    spin_cross,
    subtract,
    write,
)
from roughgas.kernel.particles import contact_distance, pair_of, spin_mass_of, spin_of
from roughgas.kernel.state import BASE, EXPONENT, NOBODY, ORIGIN


class SpinSettings(Settings, frozen=True, kw_only=True):
    """Settings of `spin`."""

    inertia: Annotated[
        float, number("[1e-06, 1]", "q = I/(m a^2), 1/2 for disks and 2/5 for spheres.")
    ]


class Spin(NamedTuple):
    """Particles spin; rough contacts exchange energy between translation and rotation."""

    inertia: float


register(Spin, SpinSettings)


class FrictionSettings(Settings, frozen=True, kw_only=True):
    """Settings of `friction`."""

    mu: Annotated[float, number("[0, inf)", "Coefficient of friction; 0 is a smooth gas.")]


class Friction(NamedTuple):
    """Contacts slide where sticking would take more than mu times the normal impulse (Coulomb)."""

    mu: float
    inertia: float  # q of the particles

    @classmethod
    def from_settings(cls, settings, context):
        """Return the effect from FrictionSettings and a SceneContext.

        Raises InputError where nothing spins.
        """
        if "spin" not in context.effects:
            raise NeedsError("effects.friction", "spin")
        return cls(settings.mu, context.effects["spin"].inertia)


@jit
def roughness(friction, account, beta, r, speed, slip_velocity, pair):
    """Return beta of a contact with Coulomb friction: the given beta, reduced where it slides.

    Hook `roughness` (kernel.hooks), which does without the account. `beta` is the roughness of a
    contact that sticks, r the normal restitution; `speed` is the normal component of the relative
    velocity, `slip_velocity` its tangential part at the surfaces, `pair` the particles.Pair.
    """
    mu = friction.mu if pair.mu is None else pair.mu
    mobility_ratio = (
        pair.mass * pair.inertia / pair.reduced_spin_mass + pair.mass / pair.reduced_spin_mass
    )
    max_change = mu * (1.0 + r) * mobility_ratio * abs(speed)
    slip_speed = math.sqrt(dot(slip_velocity, slip_velocity))
    return beta if (1.0 + beta) * slip_speed <= max_change else max_change / slip_speed - 1.0


register(Friction, FrictionSettings, roughness=roughness)


SQUARES = {"v_t^2": 2, "v_r^2": 2, "v_t.v_r": 2}


class ContactAverages(NamedTuple):
    """Accumulates averages over collisions of pairs, for R averaged over collisions."""

    @classmethod
    def from_settings(cls, settings, context):
        """Return the effect for a SceneContext; raise InputError where nothing spins."""
        if "spin" not in context.effects:
            raise NeedsError("effects.contact_averages", "spin")
        return cls()


@jit
def observe_squares(averages, account, state, contact):
    """Add the terms v_t^2, v_r^2 and v_t.v_r of a Contact to the running sums.

    Hook `observe_contact` (kernel.hooks), which does without the account.
    """
    sums, n, v = state.sums.contact_averages, contact.n, contact.v
    v_t = add_scaled(v, n, -dot(v, n))
    minus_v_r = spin_cross(contact.w, n)
    m, s = _weights(state.bodies, contact.i, contact.j)
    sums[0, 0] += m * dot(v_t, v_t)
    sums[0, 1] += s * dot(minus_v_r, minus_v_r)
    sums[0, 2] -= math.sqrt(m * s) * dot(v_t, minus_v_r)


@jit
def _weights(bodies, i, j):
    """Return the weights of v_t^2 and v_r^2 for a pair: twice the reduced m and m q."""
    if bodies is None:
        return 1.0, 1.0
    pair = pair_of(bodies, None, i, j)
    return pair.mass, pair.reduced_spin_mass


register(ContactAverages, Settings, observe_contact=observe_squares, sums=SQUARES)


def columns_of_pairs(names, kinds: int) -> list[str]:
    """Return the column names of sums over contacts, for each ordered pair of species in turn.

    `names` are the sums of one pair, `kinds` is the number of species; just `names` for a single
    species.
    """
    pairs = product(range(kinds), repeat=2)
    return [f"{name}[{k},{m}]" for k, m in pairs for name in names] if kinds > 1 else [*names]


def _sums_of_pairs(powers):
    """Return the hook `sums` for columns that are repeated for each ordered pair of species.

    `powers` has the power of velocity in the unit of each column, by its name.
    """

    def sums(effects):
        """Return the power of velocity of each column, by its name, for the scene's species."""
        kinds = 1 if effects.species is None else effects.species.kinds
        return {name: powers[name.partition("[")[0]] for name in columns_of_pairs(powers, kinds)}

    return sums


@jit
def _number_of_pair(bodies, i, j):
    """Return the number of the ordered pair of the species of i and j, as in columns_of_pairs."""
    if bodies is None:
        return 0
    return bodies.pairs.shape[0] * bodies.species[i] + bodies.species[j]


AXES = "xyz"
STRESSES = {f"J_{k} s_{along}": 1 for k, along in product(AXES, AXES)}
"""Momentum times distance: component k of the momentum, carried along an axis."""


class ContactStress(NamedTuple):
    """Accumulates the collisional stress, over all contacts of pairs."""


@jit
def observe_stress(stress, account, state, contact):
    """Add the momentum times distance that a Contact transfers to the running sums.

    Their unit is m a^2/T, in current units of velocity. Hook `observe_contact` (kernel.hooks),
    which does without the account.
    """
    sums, n, impulse = state.sums.contact_stress, contact.n, contact.impulse
    distance = contact_distance(state.bodies, contact.i, contact.j)
    first = 9 * _number_of_pair(state.bodies, contact.i, contact.j)
    for k in range(len(n)):
        for along in range(len(n)):
            sums[0, first + 3 * k + along] -= impulse[k] * distance * n[along]


register(ContactStress, Settings, observe_contact=observe_stress, sums=_sums_of_pairs(STRESSES))


HEAT = {f"E s_{along}": 2 for along in AXES}
"""Energy times distance, carried along an axis."""


class ContactHeat(NamedTuple):
    """Accumulates the collisional heat flux, over all contacts of pairs."""


@jit
def observe_heat(heat, account, state, contact):
    """Add the energy times distance that a Contact transfers to the running sums.

    Their unit is m a^3/T^2, in current units of velocity. Hook `observe_contact` (kernel.hooks),
    which does without the account.
    """
    sums, bodies, along = state.sums.contact_heat, state.bodies, len(contact.n)
    i, j, n, impulse = contact.i, contact.j, contact.n, contact.impulse
    velocity_sum = add_scaled(
        read(state.trajectory, i, along, n), read(state.trajectory, j, along, n), 1.0
    )
    energy = -0.5 * dot(impulse, velocity_sum)
    if state.spin is not None:
        turn = cross_to_spin(n, impulse)
        energy += 0.5 * dot(turn, subtract(spin_of(state.spin, n, i), spin_of(state.spin, n, j)))
    if bodies is not None:
        energy -= 0.25 * dot(impulse, impulse) * (1.0 / bodies.mass[i] - 1.0 / bodies.mass[j])
    if bodies is not None and state.spin is not None:
        s_i, s_j = spin_mass_of(bodies, None, i), spin_mass_of(bodies, None, j)
        energy -= 0.25 * dot(turn, turn) * (1.0 / s_i - 1.0 / s_j)
    distance, first = contact_distance(bodies, i, j), 3 * _number_of_pair(bodies, i, j)
    for k in range(len(n)):
        sums[0, first + k] += energy * distance * n[k]


register(ContactHeat, Settings, observe_contact=observe_heat, sums=_sums_of_pairs(HEAT))


COUNTS = {"contacts": 0, "loss": 2}


class ContactPairs(NamedTuple):
    """Counts the contacts of each pair of species, and accumulates the energy lost in them."""

    inertia: float  # q of the particles, 0 where they do not spin

    @classmethod
    def from_settings(cls, settings, context):
        """Return the effect for a SceneContext, with q of the particles.

        q is 0 where they do not spin.
        """
        spin = context.effects.get("spin")
        return cls(0.0 if spin is None else spin.inertia)


@jit
def observe_pairs(effect, account, state, contact):
    """Count a Contact for its pair of species, and add the energy lost in it to the running sums.

    Hook `observe_contact` (kernel.hooks), which does without the account.
    """
    i, j, impulse, bodies = contact.i, contact.j, contact.impulse, state.bodies
    loss = dot(impulse, contact.v) - dot(impulse, impulse) / pair_of(bodies, None, i, j).mass
    if state.spin is not None:
        w_i, w_j = contact.spins
        loss -= _rotational_gain(effect, state, i, w_i) + _rotational_gain(effect, state, j, w_j)
    sums, first = state.sums.contact_pairs, 2 * _number_of_pair(bodies, i, j)
    sums[0, first] += 1.0
    sums[0, first + 1] += loss


@jit
def _rotational_gain(effect, state, i, before):
    """Return the rotational energy gained by particle i since its spin was `before`."""
    square = dot(read(state.spin, i, 0, before), read(state.spin, i, 0, before))
    return 0.5 * spin_mass_of(state.bodies, effect, i) * (square - dot(before, before))


register(ContactPairs, Settings, observe_contact=observe_pairs, sums=_sums_of_pairs(COUNTS))


LoggedContacts = Annotated[int, whole(1, 1_000_000, "Number of last contacts that are kept.")]


class ContactLogSettings(Settings, frozen=True, kw_only=True):
    """Settings of `contact_log`."""

    most: LoggedContacts = 10_000


class ContactLog(NamedTuple):
    """Logs the last contacts: time, partners, normal, velocities and spins before and after."""

    most: int  # contacts in the log
    on: bool = True  # False while a gas is thermalised


@jit
def log_contact(effect, account, state, contact):
    """Write a Contact to the next row of the log, in units of a and T, unless the log is off.

    Hooks `observe_contact` and `observe_wall` (kernel.hooks), which do without the account.
    """
    if not effect.on:
        return
    log, i, j, n = state.log, contact.i, contact.j, contact.n
    row, dimension = log.made[0] % len(log.rows), len(contact.n)
    log.made[0] += 1
    unit = math.ldexp(1.0, int(state.counts[EXPONENT]))
    rows, trajectory = log.rows, state.trajectory
    rows[row, 0] = state.clock[ORIGIN] + (state.clock[BASE] + contact.time) / unit
    rows[row, 1] = state.label[i]
    rows[row, 2] = NOBODY if j == NOBODY else state.label[j]
    write(rows, row, 3, n)
    write(rows, row, 3 + dimension, read(trajectory, i, 0, n))
    # relative to the image of j in the box, the image that i touches moves with `image_velocity`
    before_i, before_j = contact.velocities
    image_velocity = subtract(subtract(before_i, before_j), contact.v)
    after_j = before_j if j == NOBODY else read(trajectory, j, dimension, n)
    write(rows, row, 3 + 2 * dimension, scale(before_i, unit))
    write(rows, row, 3 + 3 * dimension, scale(add_scaled(before_j, image_velocity, 1.0), unit))
    write(rows, row, 3 + 4 * dimension, scale(read(trajectory, i, dimension, n), unit))
    write(rows, row, 3 + 5 * dimension, scale(add_scaled(after_j, image_velocity, 1.0), unit))
    if state.spin is not None:
        w_i, w_j = contact.spins
        first, width = 3 + 6 * dimension, state.spin.shape[1]
        spin_unit = 0.0 if j == NOBODY else unit
        after_j = w_j if j == NOBODY else read(state.spin, j, 0, w_j)
        write(rows, row, first, scale(w_i, unit))
        write(rows, row, first + width, scale(w_j, spin_unit))
        write(rows, row, first + 2 * width, scale(read(state.spin, i, 0, w_i), unit))
        write(rows, row, first + 3 * width, scale(after_j, spin_unit))


register(
    ContactLog,
    ContactLogSettings,
    observe_contact=log_contact,
    observe_wall=log_contact,
)
