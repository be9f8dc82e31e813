"""Common parts of the settings of effects: legal speeds, materials, and registration of classes.

An effect's file registers its class with the struct of its settings and with its hooks. The schema
of config.yaml and the legal values in error messages are derived from the struct.
"""

from collections.abc import Mapping, Sequence
from typing import Annotated, Any, Literal, NamedTuple

from msgspec.structs import asdict

from roughgas.base import RESTITUTION, ROUGHNESS, InputError, Interval
from roughgas.base.fields import Settings, number
from roughgas.kernel.hooks import Hooks

SPEED_RANGE = "[0, 10000]"
"""Legal speeds of a drive, in a/T; initial speeds are about 1, and faster drives take for ever."""
TEMPERATURE_RANGE = "(0, 1e+08]"
"""Temperatures (m a^2/T^2) that belong to such speeds."""
SPIN_VELOCITY_RANGE = "[-10000, 10000]"
"""Spin velocities of a medium, in a/T."""
LENGTH_RANGE, PERIOD_RANGE = "[0, 1e+06]", "[1e-09, 1e+09]"
WallRestitution = (
    Annotated[
        float,
        number(
            RESTITUTION.text,
            "Restitution of contacts with it; `particles` takes the particles' own.",
        ),
    ]
    | Literal["particles"]
)
WallRoughness = (
    Annotated[
        float,
        number(
            ROUGHNESS.text, "Roughness of contacts with it; `particles` takes the particles' own."
        ),
    ]
    | Literal["particles"]
)


class SceneContext(NamedTuple):
    """The properties of a scene that an effect may depend on."""

    box: tuple[float | None, ...]  # lengths in a; None is open
    restitution: float  # of the particles
    roughness: float
    effects: Mapping[str, Any]  # the settings of each active effect, by name
    restitution_of_species: Sequence[float] = ()  # values that species or pairs set themselves
    roughness_of_species: Sequence[float] = ()
    spin_velocity_of_species: Sequence[float | None] = ()  # of each species, None if not given
    particles: int = 2  # their number
    name: str = ""  # of the effect to build


class Material(Settings, frozen=True, kw_only=True):
    """Material of a surface that particles bounce off."""

    restitution: WallRestitution
    roughness: WallRoughness

    def resolved(self, context: SceneContext) -> tuple[float, float]:
        """Return (restitution, roughness) of the material as numbers.

        The scene's values stand for `particles`. Raises InputError for `particles` where species
        differ, and for a roughness without spins.
        """
        r, beta = (self._resolved_value(context, name) for name in ("restitution", "roughness"))
        if "spin" not in context.effects and beta != -1.0:
            key = f"effects.{context.name}.roughness"
            raise InputError(key, self.roughness, "be -1 where particles do not spin")
        return r, beta

    def _resolved_value(self, context: SceneContext, name: str) -> float:
        """Return the restitution or roughness, by `name`, as a number: for `particles` the
        scene's."""
        value = getattr(self, name)
        if value != "particles":
            return value
        if getattr(context, f"{name}_of_species"):
            legal = "be a number where a species has one of its own"
            raise InputError(f"effects.{context.name}.{name}", value, legal)
        return getattr(context, name)


def register(kind: Any, settings: type[Settings] | None = None, **hooks: Any) -> None:
    """Attach to an effect's class the struct of its settings and its hooks (roughgas.kernel.hooks).

    `kind` is the class, a NamedTuple; `hooks` are functions and flags by the names of the fields of
    Hooks. Settings are None for a variant that another effect's `from_settings` returns. A class
    without `from_settings` is built from the fields of its settings. Raises TypeError for a hook
    that does not exist.
    """
    kind.hooks = Hooks(**hooks)
    kind.settings = settings
    if not hasattr(kind, "from_settings"):
        kind.from_settings = lambda settings, context: kind(**asdict(settings))


def check_speed(context: SceneContext, amplitude: float, period: float) -> None:
    """Raise InputError if a shaken wall moves faster than legal for a drive (SPEED_RANGE, in a/T).

    The amplitude is in particle radii a, the period in T.
    """
    if not Interval(SPEED_RANGE).holds(amplitude / period):
        key = f"effects.{context.name}: amplitude/period"
        raise InputError(key, amplitude / period, f"lie in {SPEED_RANGE} a/T")


def whole_quarters(context: SceneContext, exponent: float) -> int:
    """Return four times the `exponent` of an effect's power of a speed.

    Raises InputError unless the exponent is a multiple of 1/4: such powers consist of roots and
    products, the same bits on every machine.
    """
    quarters = 4.0 * exponent
    if not quarters.is_integer():
        raise InputError(f"effects.{context.name}.exponent", exponent, "be a multiple of 1/4")
    return int(quarters)
