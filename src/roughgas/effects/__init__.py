"""The registry of effects: physical effects and passive measurements, by their names in settings.

Where several effects change one value, they act in this order (see kernel/hooks.py); passive
effects come last. `register_effect` adds effects from users' files; a scene without such effects
has the same type, and so the same kernel, as if none were registered.

Symbols in all files of effects: a and m, the radius and mass of a particle without species; T, the
unit of time; D, the dimension; r, the normal restitution; beta, the roughness (tangential
restitution); q = I/(m a^2), the reduced moment of inertia; mu, the coefficient of friction; w, the
angular velocity, with the spin a w. Functions that are passed to `register` as hooks have the
arguments that kernel.hooks.Hooks describes.
"""

import functools
import hashlib
from collections import namedtuple
from collections.abc import Mapping
from typing import NamedTuple, cast

from roughgas.base import InputError, NamedValues, short_repr
from roughgas.base.fields import Schema, Settings, schema_of_kinds
from roughgas.base.files import package_of_study
from roughgas.effects.bath import Langevin
from roughgas.effects.contacts import (
    ContactAverages,
    ContactHeat,
    ContactLog,
    ContactPairs,
    ContactStress,
    Friction,
    Spin,
)
from roughgas.effects.drives import Delta, Shear, Thermostat
from roughgas.effects.gravity import Gravity
from roughgas.effects.paths import Paths
from roughgas.effects.restitution import (
    ContactTime,
    PowerLaw,
    RestitutionTable,
    Threshold,
    Viscoelastic,
)
from roughgas.effects.settings import SceneContext
from roughgas.effects.species import Species
from roughgas.effects.user_code import (
    check_class,
    check_name,
    is_passive,
    is_same_definition,
    source_hash,
)
from roughgas.effects.wall_impulses import WallImpulses
from roughgas.effects.walls import Floor, ShakenWalls, Wall, Walls


class Effects(NamedTuple):
    """The effects of a scene; None for an absent effect."""

    spin: Spin | None = None
    species: Species | None = None
    gravity: Gravity | None = None
    floor: Floor | None = None
    walls: Walls | None = None
    shaken_walls: ShakenWalls | None = None
    left_wall: Wall | None = None
    right_wall: Wall | None = None
    front_wall: Wall | None = None
    back_wall: Wall | None = None
    bottom_wall: Wall | None = None
    lid: Wall | None = None
    shear: Shear | None = None
    thermostat: Thermostat | None = None
    langevin: Langevin | None = None
    delta: Delta | None = None
    friction: Friction | None = None
    viscoelastic: Viscoelastic | None = None
    power_law: PowerLaw | None = None
    restitution_table: RestitutionTable | None = None
    threshold: Threshold | None = None
    contact_time: ContactTime | None = None
    contact_averages: ContactAverages | None = None
    contact_stress: ContactStress | None = None
    contact_heat: ContactHeat | None = None
    contact_pairs: ContactPairs | None = None
    wall_impulses: WallImpulses | None = None
    contact_log: ContactLog | None = None
    paths: Paths | None = None


def inertia(effects: Effects) -> float | None:
    """Return q = I/(m a^2) of the particles; None if they do not spin."""
    return None if effects.spin is None else effects.spin.inertia


def reference_speed(effects: Effects) -> float | None:
    """Return the normal speed of contacts with the restitution r, in a/T; None if r is constant."""
    law = effects.viscoelastic or effects.power_law or effects.restitution_table
    return None if law is None else law.speed


def inertia_of_spin(effects: Effects) -> float:
    """Return q = I/(m a^2) of particles that spin; the effects must have `spin`."""
    assert effects.spin is not None
    return effects.spin.inertia


EFFECTS = {name: kind.__args__[0] for name, kind in Effects.__annotations__.items()}
del EFFECTS["species"]  # a separate key in settings
"""The classes of effects by their names in settings under `effects`, in the order of acting."""
_ORDER = [*Effects._fields]


_HASHES: dict[str, str] = {}
"""Hashes of the sources of added effects, by name."""


OF_STUDIES: dict[str, dict[str, tuple[type, str | None]]] = {}
"""Effects that studies define, by the study's package and by name: arguments of `add_effect`."""


def register_effect(name: str, kind: type, before: str | None = None) -> None:
    """Register a user's class `kind` as an effect of this name: see `roughgas.register_effect`.

    An effect of a study is only noted, in OF_STUDIES: experiments of the study add it, and check it
    then. Raises InputError as `add_effect`.
    """
    if package := package_of_study(kind):
        OF_STUDIES.setdefault(package, {})[name] = kind, before
    else:
        add_effect(name, kind, before)


def add_effect(name: str, kind: type, before: str | None = None) -> None:
    """Add a user's class `kind` to the effects, under this name, until `forget_effect`.

    `before` is the name of an effect that acts after it. Raises InputError for an illegal name,
    class or order.
    """
    redefined = name in _HASHES and is_same_definition(EFFECTS[name], kind)
    check_name("effect", name, taken=name in _ORDER and not redefined)
    check_class(name, kind)
    digest = source_hash(name, kind)
    order = [effect for effect in _ORDER if effect != name]
    order.insert(_rank(name, kind, before, order), name)
    _ORDER[:] = order
    _HASHES[name] = digest
    _update_registry(EFFECTS | {name: kind})


def forget_effect(name: str) -> None:
    """Remove a registered effect; raise InputError for any other name."""
    if name not in _HASHES:
        raise InputError("effect", short_repr(name), f"be one of {', '.join(_HASHES) or '(none)'}")
    del _HASHES[name]
    _ORDER.remove(name)
    _update_registry({effect: kind for effect, kind in EFFECTS.items() if effect != name})


def _rank(name, kind, before, order):
    """Return the index of an effect in the order of acting, at `before` or at the end of its group.

    `order` has the names of the other effects. Raises InputError for an effect that would act after
    a passive one.
    """
    passive = [effect for effect in order if effect in EFFECTS and is_passive(EFFECTS[effect])]
    first, end = order.index(passive[0]), len(order)
    if before is None:
        return end if is_passive(kind) else first
    legal = passive if is_passive(kind) else [e for e in order[: first + 1] if e in EFFECTS]
    if before not in legal:
        raise InputError(
            f"effect {name}: before", short_repr(before), f"be one of {', '.join(legal)}"
        )
    return order.index(before)


def _update_registry(kinds):
    """Replace the content of EFFECTS by `kinds`, classes by name, in the order of acting.

    The dictionary itself is imported elsewhere.
    """
    EFFECTS.clear()
    EFFECTS.update({name: kinds[name] for name in _ORDER if name in kinds})


def effects_tuple(effects: NamedValues) -> Effects:
    """Return the Effects of a scene from its effects by name; None for an absent effect.

    With registered effects it is a NamedTuple of the fields of Effects and of these. Its name
    contains a digest of their sources: machine code is cached by the names of types.
    """
    present = {name: effect for name, effect in effects.items() if effect is not None}
    registered = tuple((name, _HASHES[name]) for name in _ORDER if name in _HASHES.keys() & present)
    if not registered:
        return Effects(**present)
    names = {*Effects._fields, *present}
    fields = tuple(name for name in _ORDER if name in names)
    return cast(Effects, _effects_type(registered, fields)(**present))


def sources_of(effects: Effects) -> str:
    """Return "-" and a digest of the sources of the scene's registered effects; "" without them."""
    digest = getattr(effects, "source_hash", "")
    return f"-{digest}" if digest else ""


@functools.cache
def _effects_type(registered, fields):
    """Return the NamedTuple type of Effects with these fields, some of them registered effects.

    `registered` has (name, hash of the sources) of each registered effect.
    """
    digest = hashlib.sha256(repr((registered, fields)).encode()).hexdigest()[:16]
    names = "_".join(name for name, _ in registered)
    kind = namedtuple(f"Effects_{names}_{digest}", fields, defaults=[None] * len(fields))
    kind.source_hash = digest
    return kind


def build_effects(settings: Mapping[str, Settings], context: SceneContext) -> NamedValues:
    """Return the effects built from settings, by name; None for an effect without consequences.

    `settings` are structs by the effect's name, `context` the scene's other properties. Raises
    InputError for settings that contradict each other or the scene.
    """
    return {
        name: EFFECTS[name].from_settings(settings_of_effect, context._replace(name=name))
        for name, settings_of_effect in settings.items()
    }


def schema() -> Schema:
    """Return the JSON schema of `effects` in settings; null removes an effect."""
    description = "What acts in this experiment; an effect that is not listed costs nothing."
    return schema_of_kinds(description, EFFECTS)
