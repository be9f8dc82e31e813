"""How the kernel asks the effects of a scene, and only those, for their part.

An effect is a NamedTuple whose file registers its hooks: the functions that are its part in the
simulation (effects/settings.py; docs/effects.md has an example). `scene.effects` has one entry per
effect, None where the scene does without it: a loop over those present is written out before numba
compiles it (compiling/jit.py), and an absent effect leaves no instruction.

Where several effects have a say, each gets the value as those listed before it in `Effects` have
left it.
"""

import functools
from collections.abc import Callable, Mapping
from typing import Any, NamedTuple

from roughgas.compiling.jit import jit, of_types

CODES = 8  # kinds of event per effect


class Hooks(NamedTuple):
    """What an effect takes part in; None or False is what it leaves alone.

    All functions are jitted but for `moment` and `displacement`. `index` is the effect's number
    among those present, and that of its account in State.ledger. Times count from the clock's base.
    Times and velocities are in the units of a gas that is rescaled as it cools: with
    e = State.counts[EXPONENT], a velocity in a/T is the present one times 2^e, a time in T the
    present one over 2^e.
    """

    acceleration: Callable | None = None
    """(effect, index) -> downward acceleration along the last axis"""
    sliding: Callable | None = None
    """(effect, index, state) -> (offset, velocity) along the first axis of the image above,
    at the clock's base"""
    restitution: Callable | None = None
    """(effect, index, r, state, i, j, time, speed) -> normal restitution of a contact, from the
    value so far and the normal relative velocity, negative where the partners approach; j < 0 for
    a boundary"""
    roughness: Callable | None = None
    """(effect, index, beta, r, speed, slip, pair) -> tangential restitution of a contact of
    particles that spin, from the value so far, r and speed as above, the tangential relative
    velocity of the surfaces, a vector, and the particles.Pair; without the state, it can depend on
    ratios of velocities only"""
    after_contact: Callable | None = None
    """(effect, index, state, i, time): note that particle i has had a contact"""
    observe_contact: Callable | None = None
    """(effect, index, state, contact): look at a contact.Contact of a pair that has just been made,
    and change nothing but State.sums and State.log"""
    observe_wall: Callable | None = None
    """The same of a contact with a floor or a wall, unless that is thermal"""
    observe_flight: Callable | None = None
    """(effect, index, state, i, crossings, elapsed): look at the free flight that ends with an
    event of particle i, before its path and spin change: the periods of each axis by which it has
    left the box, and its duration; change nothing but State.paths"""
    sums: Mapping[str, int] | Callable | None = None
    """Columns of samples in which the effect keeps running sums -> the power of velocity that each
    has as its unit, or a function of all Effects that returns this; State.sums has them under the
    effect's name"""
    predict: Callable | None = None
    """(effect, index, state, scene, i) -> (time, what) of particle i's next event that is not a
    contact of a pair; 0 <= what < CODES"""
    resolve: Callable | None = None
    """(effect, index, what, state, scene, i, time): carry that event out, book the energy that it
    puts in, and count in State.changes each particle whose velocity it changes; returns another
    particle than i whose velocity has changed, or NOBODY"""
    transfer: Callable | None = None
    """(effect, index, state, work): book the energy that particles gain where they, or their
    partners, change images"""
    phase: Callable | None = None
    """(effect, index, base) -> the effect's phase when the clock's base is at absolute time
    `base`"""
    moment: Callable | None = None
    """(effect, number, rng) -> a time for each of `number` particles (array), which State.moments
    keeps under the effect's name"""
    displacement: Callable | None = None
    """(effect, time) -> how far what the effect moves is from where it was at time 0, in a, for
    movies; `time` is absolute, in T"""
    random: bool = False
    """The effect draws random numbers, from State.random"""
    drives: bool = False
    """The effect puts energy in"""


class Part(NamedTuple):
    """An effect's part in a hook."""

    place: int  # in Effects
    rank: int  # among the effects that are present
    own: Any  # the function, or True


@of_types
def present(effects, name):
    """Return the parts of every effect that is there and has the hook, in listed order.

    `effects` is an Effects, or its type in numba.
    """
    kinds = getattr(effects, "types", None)
    if kinds is None:
        return _present(tuple(map(type, effects)), name)
    return _present(tuple(getattr(kind, "instance_class", type(kind)) for kind in kinds), name)


@functools.cache
def _present(classes, name):
    there = [(k, getattr(c.hooks, name)) for k, c in enumerate(classes) if hasattr(c, "hooks")]
    return tuple(Part(place, rank, own) for rank, (place, own) in enumerate(there) if own)


def accounts(effects):
    """Return the number of effects with an account in the ledger: passive effects have none.

    Passive effects are last in Effects, so that the accounts of the others have their ranks.
    """
    passive = len(present(effects, "observe_contact")) + len(present(effects, "observe_flight"))
    return sum(effect is not None for effect in effects) - passive


def sums(effects):
    """Return the columns of each effect that keeps running sums, by its place in Effects."""
    parts = present(effects, "sums")
    return {part.place: part.own(effects) if callable(part.own) else part.own for part in parts}


def displacement(effect, time):
    """Return how far an effect has moved what it moves by `time` (T), in a; None if absent."""
    return None if effect is None else effect.hooks.displacement(effect, time)


@jit
def acceleration(effects):
    """Return the downward acceleration, None without any."""
    g = None
    for part in present(effects, "acceleration"):
        g = part.own(effects[part.place], part.rank)
    return g


@jit
def sliding(effects, state):
    """Return (offset, velocity) of the image above at the clock's base; None: at rest."""
    slide = None
    for part in present(effects, "sliding"):
        slide = part.own(effects[part.place], part.rank, state)
    return slide


@jit
def transfer(effects, state, work):
    """Book the energy that particles gain as other images."""
    for part in present(effects, "transfer"):
        part.own(effects[part.place], part.rank, state, work)


@jit
def observe_flight(effects, state, i, crossings, elapsed):
    """Report the end of a flight of particle i to the effects that observe flights."""
    for part in present(effects, "observe_flight"):
        part.own(effects[part.place], part.rank, state, i, crossings, elapsed)
