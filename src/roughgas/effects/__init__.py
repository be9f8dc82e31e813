"""What a scene can be made of: effects, by their names in settings.

The order is that in which effects act where several have a say (see kernel/hooks.py). What only
looks comes last.
"""

from typing import Any, NamedTuple

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
from roughgas.effects.drives import Gravity, Shear, Thermostat
from roughgas.effects.paths import Paths
from roughgas.effects.restitution import (
    ContactTime,
    PowerLaw,
    RestitutionTable,
    Threshold,
    Viscoelastic,
)
from roughgas.effects.settings import schema_of_kinds
from roughgas.effects.species import Species
from roughgas.effects.walls import Floor, ShakenWalls, Wall, Walls


class Effects(NamedTuple):
    """The effects of a scene; None is an effect that the scene does without."""

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
    contact_log: ContactLog | None = None
    paths: Paths | None = None


def inertia(effects: Effects) -> float | None:
    """Return q of the particles, None where they do not spin."""
    return None if effects.spin is None else effects.spin.inertia


def speed_of_r(effects: Effects) -> float | None:
    """Return the normal speed at which contacts have their r, in a/T; None where it is any."""
    law = effects.viscoelastic or effects.power_law or effects.restitution_table
    return None if law is None else law.speed


def inertia_of_spin(effects: Effects) -> float:
    """Return q of particles that spin."""
    assert effects.spin is not None
    return effects.spin.inertia


KINDS = {name: kind.__args__[0] for name, kind in Effects.__annotations__.items()}
del KINDS["species"]  # a key of its own in settings
"""The effects by the names that they have in settings under `effects`."""


def schema() -> dict[str, Any]:
    """Return what `effects` may hold in settings, as a JSON schema; null takes an effect away."""
    description = "What acts in this experiment; an effect that is not listed costs nothing."
    return schema_of_kinds(description, KINDS, lambda kind: kind.parameters)


def required() -> dict[str, Any]:
    """Return what each effect must have once all settings are merged, as a JSON schema."""
    return {
        "properties": {
            name: {"required": [key for key, one in kind.parameters.items() if one.default is None]}
            for name, kind in KINDS.items()
        }
    }
