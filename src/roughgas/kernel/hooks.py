"""How the kernel asks the effects of a scene, and only those, for their part.

An effect is a NamedTuple whose file registers its hooks: the functions that are its part in the
simulation (effects/settings.py; docs/effects.md has an example). `scene.effects` has one entry per
effect, None where the scene does without it. While numba compiles, the types of these entries turn
each hook into a chain of the functions that are present: an absent effect leaves no instruction.

Where several effects have a say, each gets the value as those listed before it in `Effects` have
left it.
"""

from collections.abc import Callable, Mapping
from typing import Any, NamedTuple

from roughgas.kernel.jit import compiled, is_none, jit, overload

CODES = 8  # kinds of event per effect


class Hooks(NamedTuple):
    """What an effect takes part in; None or False is what it leaves alone.

    All functions are jitted but for `moment` and `displacement`. `index` is the effect's number
    among those present, and that of its account in State.ledger; `none` holds nothing. Times count
    from the clock's base. Times and velocities are in the units of a gas that is rescaled as it
    cools: with e = State.counts[EXPONENT], a velocity in a/T is the present one times 2^e, a time
    in T the present one over 2^e.
    """

    acceleration: Callable | None = None
    """(effect, index, none) -> downward acceleration along the last axis"""
    sliding: Callable | None = None
    """(effect, index, none, state) -> (offset, velocity) along the first axis of the image above,
    at the clock's base"""
    restitution: Callable | None = None
    """(effect, index, r, state, i, j, time, speed) -> normal restitution of a contact, from the
    value so far and the normal relative velocity, negative where the partners approach; j < 0 for
    a boundary"""
    roughness: Callable | None = None
    """(effect, index, beta, r, speed, slip, pair) -> tangential restitution of a contact of
    particles that spin, from the value so far, r and speed as above, the tangential relative
    velocity of the surfaces, a vector, and what is special about the two (bodies.Pair; None where
    all particles are alike); without the state, it can depend on ratios of velocities only"""
    after_contact: Callable | None = None
    """(effect, index, none, state, i, time): note that particle i has had a contact"""
    observe_contact: Callable | None = None
    """(effect, index, none, state, i, j, n, v, w, push): look at the contact of a pair, and change
    nothing but State.sums; n is the unit vector from j to i, v the relative velocity before the
    contact, w the sum of the spins (None without spin), push the momentum that passes from i to j
    """
    sums: Mapping[str, int] | None = None
    """Columns of samples in which the effect keeps running sums -> the power of velocity that each
    has as its unit; State.sums has them under the effect's name"""
    predict: Callable | None = None
    """(effect, index, state, scene, i) -> (time, what) of particle i's next event that is not a
    contact of a pair; 0 <= what < CODES"""
    resolve: Callable | None = None
    """(effect, index, what, state, scene, i, time): carry that event out, book the energy that it
    puts in, and count in State.changes each particle whose velocity it changes; returns another
    particle than i whose velocity has changed, or NOBODY"""
    transfer: Callable | None = None
    """(effect, index, none, state, work): book the energy that particles gain where they, or their
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
    closes: bool = False
    """The effect closes an axis of the box: the one that is its `axis`, else the first one"""


class Part(NamedTuple):
    """An effect's part in a hook."""

    place: int  # in Effects
    rank: int  # among the effects that are present
    own: Any  # the function, or True


def present(effects, name):
    """Return the parts of every effect that is there and has the hook, in listed order.

    `effects` is an Effects, or its type in numba.
    """
    kinds = getattr(effects, "types", effects)
    classes = [getattr(kind, "instance_class", type(kind)) for kind in kinds]
    there = [(k, getattr(c.hooks, name)) for k, c in enumerate(classes) if hasattr(c, "hooks")]
    return [Part(place, rank, own) for rank, (place, own) in enumerate(there) if own]


def accounts(effects):
    """Return how many effects have an account in the ledger: what only looks has none.

    It is listed last in Effects, so that the numbers of the others' accounts are their ranks.
    """
    return sum(effect is not None for effect in effects) - len(present(effects, "observe_contact"))


def displacement(effect, time):
    """Return how far an effect has moved what it moves by `time` (T), in a; None if absent."""
    return None if effect is None else effect.hooks.displacement(effect, time)


def _chain(parts, join):
    if not parts:
        return lambda effects, value, *args: value
    rest = compiled(_chain(parts[:-1], join))
    return join(*parts[-1], rest)


def _hook(name, join):
    def stub(effects, value, *args):
        return _chain(present(effects, name), join)(effects, value, *args)

    @overload(stub)
    def chosen(effects, value, *args):
        return _chain(present(effects, name), join)

    return stub


def _thread(place, rank, part, rest):
    """Pass the value through one effect after the other."""

    def step(effects, value, *args):
        return part(effects[place], rank, rest(effects, value, *args), *args)

    return step


def _earliest(place, rank, part, rest):
    """Find the earliest of the effects' events, as (time, code)."""

    def step(effects, value, *args):
        before = rest(effects, value, *args)
        time, what = part(effects[place], rank, *args)
        if time < before[0]:
            return time, CODES * rank + what
        return before

    return step


def _addressed(place, rank, part, rest):
    """Let only the effect act that the code names."""

    def step(effects, value, *args):
        if value // CODES == rank:
            return part(effects[place], rank, value % CODES, *args)
        return rest(effects, value, *args)

    return step


def _stored(place, rank, part, rest):
    """Put each effect's value in its own place in an array."""

    def step(effects, value, *args):
        rest(effects, value, *args)
        value[rank] = part(effects[place], rank, *args)
        return value

    return step


def either(present, absent):
    """Return a function that is `present`, or `absent` where its first argument is
    None; the other one is compiled away. Both take all arguments."""
    present, absent = jit(present), jit(absent)

    def stub(first, *args):
        return (absent if first is None else present)(first, *args)

    @overload(stub)
    def chosen_for(first, *args):
        chosen = absent if is_none(first) else present
        return lambda first, *args: chosen(first, *args)

    return stub


def unless_absent(function):
    """Jit `function`; a call whose first argument is None is compiled away and gives None."""
    return either(function, lambda first, *args: None)


acceleration = _hook("acceleration", _thread)
sliding = _hook("sliding", _thread)
restitution = _hook("restitution", _thread)
roughness = _hook("roughness", _thread)
after_contact = _hook("after_contact", _thread)
observe_contact = _hook("observe_contact", _thread)
next_boundary = _hook("predict", _earliest)
resolve_boundary = _hook("resolve", _addressed)
transfer = _hook("transfer", _thread)
set_phases = _hook("phase", _stored)
