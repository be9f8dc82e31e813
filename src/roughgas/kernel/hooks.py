"""Dispatch: calls the hooks of active effects, resolved at compile time.

An effect is a NamedTuple whose file registers its hooks, the functions that the kernel calls
(effects/settings.py; docs/effects.md has an example). `scene.effects` has one entry per effect,
None where the effect is absent. Loops over active effects are unrolled before numba compiles them
(compiling/jit.py), so that an absent effect costs no instruction.

Where several effects change one value, they act in the order of `Effects`: each receives the
result of the effect before it.
"""

import functools
from collections.abc import Callable, Mapping
from typing import Any, NamedTuple

from roughgas.compiling.jit import jit, static

CODES = 8  # event codes per effect


class Hooks(NamedTuple):
    """The hooks of an effect; None or False stands for a missing hook.

    All functions are jitted except `particle_times` and `displacement`. `account` is the rank of
    the effect among the active ones, and the index of its account in State.ledger. Times count from
    the clock's base. Times and velocities are in the current units of a gas that is rescaled as it
    cools: with e = State.counts[EXPONENT], a velocity in a/T is the current value times 2^e, a time
    in T the current value over 2^e.
    """

    acceleration: Callable | None = None
    """(effect, account) -> acceleration along each axis, None where it vanishes"""
    image_shift: Callable | None = None
    """(effect, account, state) -> (offset, velocity) of the image above along the first axis,
    at the clock's base"""
    restitution: Callable | None = None
    """(effect, account, r, state, i, j, time, speed) -> normal restitution of a contact; r is the
    result of the effects before, `speed` the normal relative velocity, negative where the partners
    approach; j < 0 at a boundary"""
    sticking_roughness: Callable | None = None
    """(effect, account, beta, state, i, j, time, speed) -> tangential restitution of a contact that
    sticks; beta is the result of the effects before, the other arguments are as above"""
    roughness: Callable | None = None
    """(effect, account, beta, r, speed, slip_velocity, pair) -> tangential restitution of a contact
    of particles that spin, where it may slide; beta is the result of the effects before, r and
    speed as above, `slip_velocity` the tangential relative velocity of the surfaces, a vector, and
    `pair` the particles.Pair. The state is no argument, so the result depends on ratios of
    velocities only"""
    speed_gain: Callable | None = None
    """(effect, account) -> speed that a contact of a pair adds to the normal speed r |g_n| with
    which the particles part; the energy is entered in the effect's account"""
    after_contact: Callable | None = None
    """(effect, account, state, i, time): record that particle i has had a contact"""
    observe_contact: Callable | None = None
    """(effect, account, state, contact): observe a contact.Contact of a pair that has just
    collided; may change nothing but State.sums and State.log"""
    observe_wall: Callable | None = None
    """As `observe_contact`, for contacts with a floor or a wall that is not thermal"""
    observe_thermal_wall: Callable | None = None
    """As `observe_contact`, for particles that leave a thermal wall"""
    observe_flight: Callable | None = None
    """(effect, account, state, i, crossings, elapsed): observe the free flight that ends with an
    event of particle i, before its path and spin change; `crossings` are the periods of each axis
    by which it has left the box, `elapsed` its duration; may change nothing but State.paths"""
    sums: Mapping[str, int] | Callable | None = None
    """Sample columns of the effect's running sums -> the power of velocity in the unit of each; or
    a function of all Effects that returns this mapping. State.sums holds the sums under the
    effect's name"""
    predict: Callable | None = None
    """(effect, account, state, scene, i) -> (time, code) of particle i's next event that is not a
    contact of a pair; 0 <= code < CODES"""
    resolve: Callable | None = None
    """(effect, account, code, state, scene, i, time): carry that event out, enter the energy gained
    in the ledger, and count in State.changes each particle whose velocity it changes; returns a
    second particle whose velocity has changed, or NOBODY"""
    transfer: Callable | None = None
    """(effect, account, state, work): enter in the ledger the energy that particles gain where
    they, or their partners, are replaced by another periodic image"""
    phase: Callable | None = None
    """(effect, account, base) -> the effect's phase when the clock's base is at absolute time
    `base`"""
    particle_times: Callable | None = None
    """(effect, number, rng) -> an initial time for each of `number` particles (array), kept in
    State.particle_times under the effect's name"""
    displacement: Callable | None = None
    """(effect, time) -> displacement, in a, of the wall or image that the effect moves, relative to
    time 0, for movies; `time` is absolute, in T"""
    random: bool = False
    """Whether the effect draws random numbers, from State.random"""
    drives: bool = False
    """Whether the effect supplies energy"""


OBSERVING_HOOKS = ("observe_contact", "observe_wall", "observe_thermal_wall", "observe_flight")
"""Hooks that make an effect passive: it changes nothing, and has no account."""


class ActiveHook(NamedTuple):
    """A hook of an active effect."""

    effect_index: int  # of the effect in Effects
    account: int  # rank among the active effects, and index of the account in State.ledger
    function: Any  # the hook; a flag or a mapping where the hook is no function


@static
def active(effects, name):
    """Return the ActiveHook of each active effect that has the hook `name`, in order of acting.

    `effects` is an Effects, or its type in numba.
    """
    types = getattr(effects, "types", None)
    if types is None:
        return _active(tuple(map(type, effects)), name)
    return _active(tuple(getattr(kind, "instance_class", type(kind)) for kind in types), name)


@functools.cache
def _active(classes, name):
    """Return the ActiveHooks called `name` of effects of these classes; NoneType: an absent one."""
    hooks = [(k, getattr(c.hooks, name)) for k, c in enumerate(classes) if hasattr(c, "hooks")]
    return tuple(ActiveHook(k, account, hook) for account, (k, hook) in enumerate(hooks) if hook)


def accounts(effects):
    """Return the number of accounts in the ledger, one per active effect that is not passive.

    Passive effects are last in Effects, so that the accounts of the others equal their ranks.
    """
    passive = {hook.effect_index for name in OBSERVING_HOOKS for hook in active(effects, name)}
    return sum(effect is not None for effect in effects) - len(passive)


def sums(effects):
    """Return the columns of running sums, {index in Effects: {column: power of velocity}}.

    The power is of velocity in the unit of the column; effects without running sums are left out.
    """
    hooks = active(effects, "sums")
    return {
        hook.effect_index: hook.function(effects) if callable(hook.function) else hook.function
        for hook in hooks
    }


def displacement(effect, time):
    """Return the displacement of the effect's wall or image at absolute `time`; None if absent.

    Time in T, displacement in particle radii a.
    """
    return None if effect is None else effect.hooks.displacement(effect, time)


@jit
def acceleration(effects):
    """Return the acceleration along each axis, None where it vanishes; None without gravity."""
    components = None
    for hook in active(effects, "acceleration"):
        components = hook.function(effects[hook.effect_index], hook.account)
    return components


@jit
def image_shift(effects, state):
    """Return (offset, velocity) of the image above, along the first axis, at the clock's base.

    None where the image rests.
    """
    shift = None
    for hook in active(effects, "image_shift"):
        shift = hook.function(effects[hook.effect_index], hook.account, state)
    return shift


@jit
def transfer(effects, state, work):
    """Enter in the ledger the energy `work` that particles gain by a change of periodic image."""
    for hook in active(effects, "transfer"):
        hook.function(effects[hook.effect_index], hook.account, state, work)


@jit
def observe_flight(effects, state, i, crossings, elapsed):
    """Call the hooks that observe the end of a free flight of particle i.

    `crossings` are the periods per axis between the box and the end of the flight, `elapsed` is its
    duration.
    """
    for hook in active(effects, "observe_flight"):
        hook.function(effects[hook.effect_index], hook.account, state, i, crossings, elapsed)
