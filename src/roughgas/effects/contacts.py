"""Contacts: the spins that they change, Coulomb friction, and sums by effects that only look.

Friction is O. R. Walton's rule with three parameters (r, beta_0, mu), in Particulate Two-Phase Flow
(1993), p. 884: a contact sticks, with the roughness beta_0, unless its tangential impulse would
then exceed mu times the normal one, and slides with just that impulse if it would:

    beta = min{beta_0, -1 + mu (1 + r) (1 + 1/q) |g_n|/|g_t|}

Where particles differ, 1 + 1/q is what an impulse along the surfaces moves them past each other by,
over what one along the normal moves the centres by; and mu is that of the pair.

Averages over collisions are what the theory is about. McNamara & Luding (1998) average over the
collisions of pairs: v_t is the tangential part of the relative velocity of the centres, v_r = -a
(w1 + w2) x n that of the surfaces due to both spins (Eq. collrule). Where nothing but contacts
changes the rotational energy of a steady state, their squares and their product are tied together
(theory.correlated_ratio). Where particles differ, v_t is weighted with the root of twice the
reduced mass of the pair, v_r with that of twice its reduced m q: if all species had one temperature
of translation and one of rotation, the mean squares would be 2 (D-1) times these. Then q = 1
belongs to the sums.

Collisional stress, for the observable `stress`: in a contact the momentum -push passes to particle
i, and is carried at once from the centre of j to that of i, over 2a where particles are alike.
Summed over contacts, per time and volume, that is the collisional part of the pressure tensor (the
virial of J. H. Irving & J. G. Kirkwood, J. Chem. Phys. 18, 817 (1950)).

Collisional heat flux, for the observables `heat_flux` and `flux_autocorrelation`: as far is carried
the energy that passes from j to i, half of what i gains and j loses. Where particles are alike that
is -push.(v_i + v_j)/2 + (n x push).(w_i - w_j)/2, with the velocities and spins after the contact.

Contacts are counted for the observable `contacts`, and the energy summed up that they take from
translation and rotation together. Of a mixture, each pair of species has sums of its own of all of
these.

The log of contacts keeps the last ones: a row of State.log for each, which the next one but `most`
overwrites. Contacts with floors and walls are there, too, unless these are thermal.
"""

import math
from itertools import product
from typing import NamedTuple

from roughgas.base import NeedsError
from roughgas.compiling.jit import jit
from roughgas.effects.settings import Number, Whole, register
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
from roughgas.kernel.particles import pair_of, reach_of, spin_mass_of, spin_of
from roughgas.kernel.state import BASE, EXPONENT, NOBODY, ORIGIN

SPIN_SETTINGS = {
    "inertia": Number("q = I/(m a^2), 1/2 for disks and 2/5 for spheres.", "[1e-06, 1]")
}


class Spin(NamedTuple):
    """Particles spin; rough contacts exchange energy between translation and rotation."""

    inertia: float


register(Spin, SPIN_SETTINGS)


FRICTION_SETTINGS = {"mu": Number("Coefficient of friction; 0 is a smooth gas.", "[0, inf)")}


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


@jit
def roughness(friction, index, beta, r, speed, slip, pair):
    mu = friction.mu if pair.mu is None else pair.mu
    ease = pair.mass * pair.inertia / pair.bulk + pair.mass / pair.bulk
    most = mu * (1.0 + r) * ease * abs(speed)
    sliding = math.sqrt(dot(slip, slip))
    return beta if (1.0 + beta) * sliding <= most else most / sliding - 1.0


register(Friction, FRICTION_SETTINGS, roughness=roughness)


SQUARES = {"v_t^2": 2, "v_r^2": 2, "v_t.v_r": 2}


class ContactAverages(NamedTuple):
    """Measures R averaged over collisions, from sums over all contacts of pairs."""

    @classmethod
    def from_settings(cls, settings, around):
        """Return the effect; raise InputError where nothing spins."""
        if "spin" not in around.effects:
            raise NeedsError("effects.contact_averages", "spin")
        return cls()


@jit
def observe_squares(averages, index, state, contact):
    sums, n, v = state.sums.contact_averages, contact.n, contact.v
    v_t = add_scaled(v, n, -dot(v, n))
    minus_v_r = spin_cross(contact.w, n)
    m, s = _weights(state.bodies, contact.i, contact.j)
    sums[0, 0] += m * dot(v_t, v_t)
    sums[0, 1] += s * dot(minus_v_r, minus_v_r)
    sums[0, 2] -= math.sqrt(m * s) * dot(v_t, minus_v_r)


@jit
def _weights(bodies, i, j):
    if bodies is None:
        return 1.0, 1.0
    pair = pair_of(bodies, None, i, j)
    return pair.mass, pair.bulk


register(ContactAverages, {}, observe_contact=observe_squares, sums=SQUARES)


def columns_of_pairs(names, kinds: int) -> list[str]:
    """Return the columns of sums over contacts: of so many species, those of each pair in turn,
    species k with each species, from k = 0 on."""
    pairs = product(range(kinds), repeat=2)
    return (
        [f"{name}[{k},{other}]" for k, other in pairs for name in names] if kinds > 1 else [*names]
    )


def _of_pairs(powers):
    """Return what `sums` of a hook is, for these columns of each pair of species."""

    def of(effects):
        kinds = 1 if effects.species is None else effects.species.kinds
        return {name: powers[name.partition("[")[0]] for name in columns_of_pairs(powers, kinds)}

    return of


@jit
def _number_of_pair(bodies, i, j):
    if bodies is None:
        return 0
    return bodies.pairs.shape[0] * bodies.species[i] + bodies.species[j]


AXES = "xyz"
STRESSES = {f"J_{k} s_{along}": 1 for k, along in product(AXES, AXES)}
"""Momentum times distance: its component k, carried along an axis."""


class ContactStress(NamedTuple):
    """Measures the collisional stress, from sums over all contacts of pairs."""


@jit
def observe_stress(stress, index, state, contact):
    sums, n, push = state.sums.contact_stress, contact.n, contact.push
    far = reach_of(state.bodies, contact.i, contact.j)
    first = 9 * _number_of_pair(state.bodies, contact.i, contact.j)
    for k in range(len(n)):
        for along in range(len(n)):
            sums[0, first + 3 * k + along] -= push[k] * far * n[along]


register(ContactStress, {}, observe_contact=observe_stress, sums=_of_pairs(STRESSES))


HEAT = {f"E s_{along}": 2 for along in AXES}
"""Energy times distance, carried along an axis."""


class ContactHeat(NamedTuple):
    """Measures the collisional heat flux, from sums over all contacts of pairs."""


@jit
def observe_heat(heat, index, state, contact):
    sums, bodies, along = state.sums.contact_heat, state.bodies, len(contact.n)
    i, j, n, push = contact.i, contact.j, contact.n, contact.push
    both = add_scaled(read(state.trajectory, i, along, n), read(state.trajectory, j, along, n), 1.0)
    passed = -0.5 * dot(push, both)
    if state.spin is not None:
        turn = cross_to_spin(n, push)
        passed += 0.5 * dot(turn, subtract(spin_of(state.spin, n, i), spin_of(state.spin, n, j)))
    if bodies is not None:
        passed -= 0.25 * dot(push, push) * (1.0 / bodies.mass[i] - 1.0 / bodies.mass[j])
    if bodies is not None and state.spin is not None:
        one, other = spin_mass_of(bodies, None, i), spin_mass_of(bodies, None, j)
        passed -= 0.25 * dot(turn, turn) * (1.0 / one - 1.0 / other)
    far, first = reach_of(bodies, i, j), 3 * _number_of_pair(bodies, i, j)
    for k in range(len(n)):
        sums[0, first + k] += passed * far * n[k]


register(ContactHeat, {}, observe_contact=observe_heat, sums=_of_pairs(HEAT))


COUNTS = {"contacts": 0, "loss": 2}


class ContactPairs(NamedTuple):
    """Counts the contacts of each pair of species, and sums up the energy that they take."""

    inertia: float  # q of the particles, 0 where they do not spin

    @classmethod
    def from_settings(cls, settings, around):
        """Return the effect."""
        return cls(float(around.effects.get("spin", {}).get("inertia", 0.0)))


@jit
def observe_pairs(effect, index, state, contact):
    i, j, push, bodies = contact.i, contact.j, contact.push, state.bodies
    lost = dot(push, contact.v) - dot(push, push) / pair_of(bodies, None, i, j).mass
    if state.spin is not None:
        w_i, w_j = contact.spins
        lost -= _gained(effect, state, i, w_i) + _gained(effect, state, j, w_j)
    sums, first = state.sums.contact_pairs, 2 * _number_of_pair(bodies, i, j)
    sums[0, first] += 1.0
    sums[0, first + 1] += lost


@jit
def _gained(effect, state, i, before):
    gained = dot(read(state.spin, i, 0, before), read(state.spin, i, 0, before))
    return 0.5 * spin_mass_of(state.bodies, effect, i) * (gained - dot(before, before))


register(ContactPairs, {}, observe_contact=observe_pairs, sums=_of_pairs(COUNTS))


class ContactLog(NamedTuple):
    """Keeps the last contacts: time, partners, normal, velocities and spins before and after."""

    most: int
    on: bool = True  # not while a gas is thermalised


@jit
def log_contact(effect, index, state, contact):
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
    # the image of j that i touches, if it is another than the one in the box
    before_i, before_j = contact.velocities
    image = subtract(subtract(before_i, before_j), contact.v)
    after_j = before_j if j == NOBODY else read(trajectory, j, dimension, n)
    write(rows, row, 3 + 2 * dimension, scale(before_i, unit))
    write(rows, row, 3 + 3 * dimension, scale(add_scaled(before_j, image, 1.0), unit))
    write(rows, row, 3 + 4 * dimension, scale(read(trajectory, i, dimension, n), unit))
    write(rows, row, 3 + 5 * dimension, scale(add_scaled(after_j, image, 1.0), unit))
    if state.spin is not None:
        w_i, w_j = contact.spins
        first, width = 3 + 6 * dimension, state.spin.shape[1]
        walled = 0.0 if j == NOBODY else unit
        after_j = w_j if j == NOBODY else read(state.spin, j, 0, w_j)
        write(rows, row, first, scale(w_i, unit))
        write(rows, row, first + width, scale(w_j, walled))
        write(rows, row, first + 2 * width, scale(read(state.spin, i, 0, w_i), unit))
        write(rows, row, first + 3 * width, scale(after_j, walled))


register(
    ContactLog,
    {"most": Whole("Number of contacts that are kept, the last ones.", 1, 1_000_000, 10_000)},
    observe_contact=log_contact,
    observe_wall=log_contact,
)
