"""How the kernel asks the effects of a scene, and only those, for their part.

An effect is a NamedTuple in a file of its own; the functions beside it that bear the name of a hook
are its part in the simulation. `scene.effects` has one entry an effect, None where the scene does
without it. Each hook below is turned, while numba compiles and by the types of these entries, into
the chain of the functions that are there: an absent effect leaves no instruction behind.

What an effect's file may define, all jitted, `index` being the effect's place in the list:

    acceleration(effect, index, none)
        downward acceleration along the last axis
    sliding(effect, index, none, state)
        (offset, velocity) along the first axis of the image above, at the clock's base
    restitution(effect, index, r, state, i, j, time)
        normal restitution of one contact, from the value so far; j < 0 for a boundary
    roughness(effect, index, beta, r, normal_speed, tangential_speed)
        tangential restitution of one contact, from the value so far
    predict(effect, index, state, scene, i)
        (time, what) of particle i's next meeting with a boundary; 0 <= what < 8
    resolve(effect, index, what, state, scene, i)
        carry that meeting out
    transfer(effect, index, none, state, work)
        book the energy that particles gain where they, or their partners, change images
    phase(effect, index, base)
        the effect's own phase when the clock's base is at the absolute time `base`
"""

import sys

from numba import types
from numba.extending import overload, register_jitable

from roughgas.kernel.jit import jit

CODES = 8  # kinds of boundary event per effect


def present(effects, name):
    """(index, function) of every effect that is there and defines the hook, in listed order."""
    if isinstance(effects, types.BaseTuple):
        classes = [getattr(kind, "instance_class", None) for kind in effects.types]
    else:
        classes = [None if effect is None else type(effect) for effect in effects]
    found = [(k, sys.modules[c.__module__]) for k, c in enumerate(classes) if c is not None]
    return [(k, getattr(module, name)) for k, module in found if hasattr(module, name)]


def _chain(parts, join):
    if not parts:
        return lambda effects, value, *args: value
    (index, part), rest = parts[-1], register_jitable(_chain(parts[:-1], join))
    return join(index, part, rest)


def _hook(name, join):
    def stub(effects, value, *args):
        return _chain(present(effects, name), join)(effects, value, *args)

    @overload(stub)
    def compiled(effects, value, *args):
        return _chain(present(effects, name), join)

    return stub


def _thread(index, part, rest):
    """The value passes through one effect after the other."""

    def step(effects, value, *args):
        return part(effects[index], index, rest(effects, value, *args), *args)

    return step


def _earliest(index, part, rest):
    """The earliest of the effects' events, as (time, code)."""

    def step(effects, value, *args):
        before = rest(effects, value, *args)
        time, what = part(effects[index], index, *args)
        if time < before[0]:
            return time, CODES * index + what
        return before

    return step


def _addressed(index, part, rest):
    """Only the effect that the code names acts."""

    def step(effects, value, *args):
        if value // CODES == index:
            part(effects[index], index, value % CODES, *args)
        else:
            rest(effects, value, *args)
        return value

    return step


def _stored(index, part, rest):
    """Each effect's value goes to its own place in an array."""

    def step(effects, value, *args):
        rest(effects, value, *args)
        value[index] = part(effects[index], index, *args)
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


acceleration = _hook("acceleration", _thread)
sliding = _hook("sliding", _thread)
restitution = _hook("restitution", _thread)
roughness = _hook("roughness", _thread)
next_boundary = _hook("predict", _earliest)
resolve_boundary = _hook("resolve", _addressed)
transfer = _hook("transfer", _thread)
set_phases = _hook("phase", _stored)
