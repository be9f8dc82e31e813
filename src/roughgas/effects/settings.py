"""The parameters of effects: what each means, which values are legal, and how they are read.

An effect's file registers its parameters and its hooks; what config.yaml may hold, and what error
messages quote, is made from the parameters.
"""

from collections.abc import Callable, Mapping, Sequence
from typing import Any, NamedTuple

from roughgas.base import RESTITUTION, ROUGHNESS, InputError, Interval
from roughgas.kernel.hooks import Hooks

SPEED = "[0, 10000]"
"""Speeds that a drive may have, in a/T, beside an initial one of 1: faster, and no run ends."""
TEMPERATURE = "(0, 1e+08]"
"""Temperatures (m a^2/T^2) of such speeds."""
LENGTH, TIME = "[0, 1e+06]", "[1e-09, 1e+09]"


class SceneContext(NamedTuple):
    """What an effect may need to know of the scene that it is part of."""

    box: tuple[float | None, ...]  # lengths in a; None is open
    restitution: float  # of the particles
    roughness: float
    effects: Mapping[str, Any]  # the settings of all effects, by name
    restitution_of_species: Sequence[float] = ()  # what some of them have in place of that above
    roughness_of_species: Sequence[float] = ()
    name: str = ""  # of the effect itself


class Number(NamedTuple):
    """A parameter that is a number in an interval; it must be given unless it has a default."""

    description: str
    interval: str = "(0, inf)"
    default: float | None = None

    def read(self, key: str, value: Any, around: SceneContext | None = None) -> float:
        """Return the number as a float; raise InputError unless it is one in the interval."""
        if value is None and self.default is not None:
            return self.default
        is_number = isinstance(value, int | float) and not isinstance(value, bool)
        if not is_number or not Interval(self.interval).holds(value):
            given = "(nothing)" if value is None else value
            raise InputError(key, given, f"be a number in {self.interval}")
        return float(value)

    def schema(self) -> dict[str, Any]:
        """Return the same as a JSON schema."""
        return {"description": self.description} | Interval(self.interval).schema()


class Whole(NamedTuple):
    """A parameter that is a whole number in a range."""

    description: str
    low: int
    high: int
    default: int

    @property
    def interval(self) -> str:
        """The range."""
        return f"[{self.low}, {self.high}]"

    def read(self, key: str, value: Any, around: SceneContext | None = None) -> int:
        """Return the number; raise InputError for any other value."""
        if value is None:
            return self.default
        if type(value) is not int or not self.low <= value <= self.high:
            raise InputError(key, value, f"be a whole number in {self.interval}")
        return value

    def schema(self) -> dict[str, Any]:
        """Return the same as a JSON schema."""
        ends = {"minimum": self.low, "maximum": self.high}
        return {"description": self.description, "type": "integer"} | ends


class Numbers(NamedTuple):
    """A parameter that is a list of numbers in an interval; it must be given."""

    description: str
    interval: str
    fewest: int
    most: int
    default: None = None

    def read(self, key: str, value: Any, around: SceneContext) -> tuple[float, ...]:
        """Return the numbers as floats; raise InputError unless they are as many as is legal."""
        if not isinstance(value, list | tuple) or not self.fewest <= len(value) <= self.most:
            raise InputError(key, value, f"be a list of {self.fewest} to {self.most} numbers")
        one = Number(self.description, self.interval)
        return tuple(one.read(f"{key}[{k}]", x, around) for k, x in enumerate(value))

    def schema(self) -> dict[str, Any]:
        """Return the same as a JSON schema."""
        items = {"items": Interval(self.interval).schema()}
        size = {"minItems": self.fewest, "maxItems": self.most}
        return {"description": self.description, "type": "array"} | items | size


class Word(NamedTuple):
    """A parameter that is one of some words; the first is what it is if not given."""

    description: str
    words: tuple[str, ...]

    @property
    def default(self) -> str:
        """The word that is taken if none is given."""
        return self.words[0]

    def read(self, key: str, value: Any, around: SceneContext) -> str:
        """Return the word; raise InputError for any other."""
        value = self.default if value is None else value
        if value not in self.words:
            raise InputError(key, value, f"be one of {', '.join(self.words)}")
        return value

    def schema(self) -> dict[str, Any]:
        """Return the same as a JSON schema."""
        return {"description": self.description, "enum": list(self.words)}


class OfParticles(NamedTuple):
    """A number that is the particles' own where it is given as `particles`."""

    number: Number
    own: str  # the name of theirs in Surroundings
    default: float | None = None

    def read(self, key: str, value: Any, around: SceneContext) -> float:
        """Return the number; raise InputError if it is illegal, or a roughness without spins."""
        value = self.default if value is None else value
        if value == "particles" and getattr(around, f"{self.own}_of_species"):
            raise InputError(key, value, "be a number where a species has one of its own")
        found = getattr(around, self.own) if value == "particles" else None
        found = self.number.read(key, value, around) if found is None else found
        if self.own == "roughness" and "spin" not in around.effects and found != -1.0:
            raise InputError(key, value, "be -1 where particles do not spin")
        return found

    def schema(self) -> dict[str, Any]:
        """Return the same as a JSON schema."""
        number = self.number.schema()
        description = f"{number.pop('description')}; `particles` takes the particles' own."
        return {"description": description, "anyOf": [number, {"const": "particles"}]}


MATERIAL = {
    "restitution": OfParticles(
        Number("Restitution of contacts with it", RESTITUTION.text), "restitution"
    ),
    "roughness": OfParticles(Number("Roughness of contacts with it", ROUGHNESS.text), "roughness"),
}
"""The parameters of what particles bounce off."""


def schema_of_kinds(
    description: str, kinds: Mapping[str, Any], parameters: Callable[[Any], Mapping[str, Any]]
) -> dict[str, Any]:
    """Return what may be listed by these names, with the parameters of each, as a JSON schema.

    null takes an inherited one away.
    """
    return {
        "description": description,
        "type": "object",
        "additionalProperties": False,
        "properties": {
            name: {
                "description": kind.__doc__,
                "type": ["object", "null"],
                "additionalProperties": False,
                "properties": {key: one.schema() for key, one in parameters(kind).items()},
            }
            for name, kind in kinds.items()
        },
    }


def register(kind: Any, parameters: Mapping[str, Any] | None = None, **hooks: Any) -> None:
    """Give an effect's class its parameters and its hooks (see roughgas.kernel.hooks.Hooks).

    `parameters` maps names to Number, Whole, Numbers, Word or OfParticles; None is a variant that
    another effect's `from_settings` returns. A class without `from_settings` is made from its
    parameters as they are. Raises TypeError for a hook that does not exist.
    """
    kind.hooks = Hooks(**hooks)
    kind.parameters = parameters
    if not hasattr(kind, "from_settings"):
        kind.from_settings = lambda settings, around: kind(**settings)


def check_speed(around: SceneContext, amplitude: float, period: float) -> None:
    """Raise InputError where what is shaken moves faster than a drive may."""
    if not Interval(SPEED).holds(amplitude / period):
        key = f"effects.{around.name}: amplitude/period"
        raise InputError(key, amplitude / period, f"lie in {SPEED} a/T")


def make(kind: Any, name: str, settings: Mapping[str, Any], around: SceneContext) -> Any:
    """Return the effect called `name` from its settings, None where it has nothing to do.

    Raises InputError for parameters that are illegal, unknown, or contradict their surroundings.
    """
    known, around = kind.parameters, around._replace(name=name)
    for key in settings:
        if key not in known:
            legal = f"be one of {', '.join(known)}" if known else "not be given"
            raise InputError(f"effects.{name}: key", key, legal)
    values = {
        key: parameter.read(f"effects.{name}.{key}", settings.get(key), around)
        for key, parameter in known.items()
    }
    return kind.from_settings(values, around)
