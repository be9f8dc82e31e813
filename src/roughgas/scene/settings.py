"""The settings of a scene: its box, its particles, and the active effects."""

from collections.abc import Mapping
from typing import Annotated, Any, Literal, Self

from msgspec import to_builtins
from msgspec.structs import replace

from roughgas.base.fields import (
    RawSettings,
    Settings,
    described,
    nested_key,
    number,
    numbers,
    read,
    read_each,
    whole,
)
from roughgas.effects import EFFECTS
from roughgas.effects.species import PairSettings, SpeciesSettings

OPEN = "open"
"""Value of a side in `box` that has no upper end."""
Side = Annotated[float, number("(0, 1e+09]", "Length, in a.")] | Literal["open"]
Particles = Annotated[int, whole(1, 100_000_000, "Number N of particles.")]
Box = Annotated[
    tuple[Side, ...],
    numbers(2, 3, "Lengths of the box in a, the last one vertical; `open` means no upper end."),
]
Neighbours = Annotated[
    Literal["cheapest", "sweep", "cells", "lists"],
    described(
        "How possible contacts are found: by a `sweep` over all particles; in `cells`; on "
        "neighbour `lists`, which are faster where particles are close together and move little "
        "between contacts, as in a `layer`, and slower elsewhere; or by the `cheapest` scheme, "
        "which follows from the number of particles, their sizes and the packing. A box without "
        "room for eight cells along each axis is swept. Paths differ by rounding errors alone."
    ),
]
SpinTemperature = Annotated[
    float,
    number(
        "[0, 1e+06]",
        "Initial temperature of the spins, in m a^2/T^2; that of velocities is 1.",
    ),
]


class SceneSettings(Settings, frozen=True, kw_only=True, forbid_unknown_fields=False):
    """Settings of a scene, except r and beta of the particles."""

    particles: Particles
    box: Box
    effects: Mapping[str, Any] = {}
    """Settings of the active effects by name; structs, after they have been read."""
    species: tuple[SpeciesSettings, ...] = ()
    species_pairs: tuple[PairSettings, ...] = ()
    neighbours: Neighbours = "cheapest"
    spin_temperature: SpinTemperature = 0.0

    @property
    def lengths(self) -> tuple[float | None, ...]:
        """Lengths of the box along each axis in particle radii a, None along an open axis."""
        return tuple(None if side == OPEN else float(side) for side in self.box)

    def with_effects(self, changes: Mapping[str, Mapping[str, Any] | None]) -> Self:
        """Return the settings with changes of effects, by name and key; None removes an effect.

        `changes` has {effect: {key of its settings: value}}. Raises InputError for values that are
        not legal.
        """
        raw = {name: to_builtins(settings) for name, settings in self.effects.items()}
        for name, change in changes.items():
            if change is None:
                raw.pop(name, None)
            else:
                raw[name] = raw.get(name, {}) | dict(change)
        return replace(self, effects=_in_order(read_each(EFFECTS, raw, "effects")))

    def changed(self, changes: Mapping[str, Any]) -> Self:
        """Return the settings with changes by key: effects are merged, other values replaced.

        `changes` is as in a configuration; `effects` in it is as in `with_effects`. Raises
        InputError for values that are not legal.
        """
        old = {
            name: to_builtins(getattr(self, name)) for name in _field_names() if name != "effects"
        }
        scene = read(SceneSettings, old | {**changes, "effects": {}}, "")
        values = {name: getattr(scene, name) for name in old}
        return replace(self.with_effects(changes.get("effects", {})), **values)


def _in_order(effects: dict[str, Settings]) -> dict[str, Settings]:
    """Return the settings of effects by name, in the order of acting."""
    return {name: effects[name] for name in EFFECTS if name in effects}


def _field_names() -> tuple[str, ...]:
    """Return the keys of a scene in a configuration."""
    return SceneSettings.__struct_fields__


def scene_settings(raw: RawSettings, key: str = "") -> SceneSettings:
    """Return the settings of a scene from a mapping of raw values, which may have other keys.

    Raises InputError for missing or illegal values; its key begins with `key`.
    """
    settings = read(SceneSettings, {name: raw[name] for name in _field_names() if name in raw}, key)
    return replace(
        settings,
        effects=_in_order(read_each(EFFECTS, settings.effects, nested_key(key, "effects"))),
    )
