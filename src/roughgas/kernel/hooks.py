"""How the kernel asks the effects of a scene, and only those, for their part.

An effect is a NamedTuple in a file of its own; the functions beside it that bear the name of a hook
are its part in the simulation. `scene.effects` has one entry an effect, None where the scene does
without it. Each hook below is turned, while numba compiles and by the types of these entries, into
the chain of the functions that are there: an absent effect leaves no instruction behind.

Where several have a say, each gets the value as those listed before it in `Effects` have left it.

What an effect's file must define: the NamedTuple, with `from_settings`, and SETTINGS, which are its
parameters (see effects/settings.py; docs/effects.md has an example).

What it may define, all jitted but for `moment`. A name that it merely imports counts, too. `index`
is the effect's number among those that are there, and that of its account in State.ledger; `none`
is there for the chain's sake, and holds nothing. Times count from the clock's base, and are, like
velocities, in the units of a gas that is rescaled as it cools: a velocity in a/T is the present one
times 2^e, a time in T the present one over 2^e, with e = State.counts[EXPONENT].

    acceleration(effect, index, none)
        downward acceleration along the last axis
    sliding(effect, index, none, state)
        (offset, velocity) along the first axis of the image above, at the clock's base
    restitution(effect, index, r, state, i, j, time, speed)
        normal restitution of one contact, from the value so far and the normal part of the relative
        velocity, negative where the partners approach; j < 0 for a boundary
    roughness(effect, index, beta, r, speed, slip)
        tangential restitution of one contact of particles that spin, from the value so far, r and
        speed as above, and the tangential relative velocity of the surfaces, a vector; it sees no
        state, so it cannot depend on how fast all this is but by ratios
    contact_made(effect, index, none, state, i, time)
        take note that particle i has had a contact
    predict(effect, index, state, scene, i)
        (time, what) of particle i's next event that is no contact of a pair; 0 <= what < 8
    resolve(effect, index, what, state, scene, i, time)
        carry that event out, book the energy that it puts in, and count State.changes of whoever's
        velocity it changes; returns another particle than i whose velocity it has changed, or
        NOBODY
    transfer(effect, index, none, state, work)
        book the energy that particles gain where they, or their partners, change images
    phase(effect, index, base)
        the effect's own phase when the clock's base is at the absolute time `base`
    moment(effect, number, rng)
        a time for each of so many particles (array), kept in State.moments under the effect's name
    RANDOM = True
        the effect draws random numbers, from State.random
    DRIVES = True
        the effect puts energy in
    CLOSES = True
        the effect closes the first axis of the box
"""

import sys
from typing import NamedTuple

from numba import types
from numba.extending import overload, register_jitable

from roughgas.kernel.jit import jit

CODES = 8  # kinds of event per effect


class Part(NamedTuple):
    """An effect's part in a hook, or what else its file defines."""

    place: int  # in Effects
    rank: int  # among the effects that are there
    own: object  # the function


def present(effects, name):
    """The parts of every effect that is there and defines the hook, in listed order."""
    if isinstance(effects, types.BaseTuple):
        classes = [getattr(kind, "instance_class", None) for kind in effects.types]
    else:
        classes = [None if effect is None else type(effect) for effect in effects]
    there = [(k, sys.modules[c.__module__]) for k, c in enumerate(classes) if c is not None]
    return [
        Part(place, rank, getattr(module, name))
        for rank, (place, module) in enumerate(there)
        if hasattr(module, name)
    ]


def _chain(parts, join):
    if not parts:
        return lambda effects, value, *args: value
    rest = register_jitable(_chain(parts[:-1], join))
    return join(*parts[-1], rest)


def _hook(name, join):
    def stub(effects, value, *args):
        return _chain(present(effects, name), join)(effects, value, *args)

    @overload(stub)
    def compiled(effects, value, *args):
        return _chain(present(effects, name), join)

    return stub


def _thread(place, rank, part, rest):
    """The value passes through one effect after the other."""

    def step(effects, value, *args):
        return part(effects[place], rank, rest(effects, value, *args), *args)

    return step


def _earliest(place, rank, part, rest):
    """The earliest of the effects' events, as (time, code)."""

    def step(effects, value, *args):
        before = rest(effects, value, *args)
        time, what = part(effects[place], rank, *args)
        if time < before[0]:
            return time, CODES * rank + what
        return before

    return step


def _addressed(place, rank, part, rest):
    """Only the effect that the code names acts."""

    def step(effects, value, *args):
        if value // CODES == rank:
            return part(effects[place], rank, value % CODES, *args)
        return rest(effects, value, *args)

    return step


def _stored(place, rank, part, rest):
    """Each effect's value goes to its own place in an array."""

    def step(effects, value, *args):
        rest(effects, value, *args)
        value[rank] = part(effects[place], rank, *args)
        return value

    return step


def either(present, absent):
    """A function that is `present` where its first argument is there, and `absent` where it is
    None; the other one is compiled away. Both take all arguments."""
    present, absent = jit(present), jit(absent)

    def stub(first, *args):
        return (absent if first is None else present)(first, *args)

    @overload(stub)
    def compiled(first, *args):
        chosen = absent if isinstance(first, types.NoneType) else present
        return lambda first, *args: chosen(first, *args)

    return stub


def unless_absent(function):
    """Jit `function`; where its first argument is None the call is compiled away and gives None."""
    return either(function, lambda first, *args: None)


def for_each(action):
    """A function that does `action` with every part of a tuple that is there: not None."""
    action = jit(action)

    def stub(parts, *args):
        for part in parts:
            if part is not None:
                action(part, *args)

    def chain(places):
        if not places:
            return lambda parts, *args: None
        place, rest = places[-1], register_jitable(chain(places[:-1]))

        def step(parts, *args):
            rest(parts, *args)
            action(parts[place], *args)

        return step

    @overload(stub)
    def compiled(parts, *args):
        kinds = enumerate(parts.types)
        return chain([k for k, kind in kinds if not isinstance(kind, types.NoneType)])

    return stub


acceleration = _hook("acceleration", _thread)
sliding = _hook("sliding", _thread)
restitution = _hook("restitution", _thread)
roughness = _hook("roughness", _thread)
contact_made = _hook("contact_made", _thread)
next_boundary = _hook("predict", _earliest)
resolve_boundary = _hook("resolve", _addressed)
transfer = _hook("transfer", _thread)
set_phases = _hook("phase", _stored)
