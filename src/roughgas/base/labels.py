"""Labels: r, beta, seed and a swept parameter of a point as text, in paths and on command lines.

r is the normal restitution, beta the roughness. A user may write a number in many ways, such as
0.90 or 9e-1; its label in paths is its `spelling`, 0.9. So a number has a single label, and a point
a single path. A third axis of a sweep changes a setting of an effect, of a species or of the box;
functions here find that setting.
"""

import itertools
import re
from collections.abc import Callable, Iterable, Sequence
from decimal import Decimal
from typing import Any, NamedTuple

from roughgas.base import RESTITUTION, ROUGHNESS, InputError, Interval, NamedValues
from roughgas.base.fields import RawSettings

NUMBER = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?", re.ASCII)
WORD = re.compile(r"[a-z][a-z0-9_]*")
WHOLE_NUMBER = re.compile(r"\d{1,19}", re.ASCII)
LARGEST_SEED = 2**63 - 1
SWEPT = "swept"
"""Key, in the settings of a variant, for the parameter that its experiment sweeps, such as
spin.inertia."""
LEGAL_LEVEL = "be a number, or a word of lower-case letters, digits and _"


SPECIES_PREFIX = "species."
"""Prefix of the key of a third axis that sweeps a quantity of a species."""
RADIUS_DISTRIBUTION_KEYS = "mean", "deviation"
"""Keys of a distribution of radii that can be swept."""


class GridPoint(NamedTuple):
    """r, beta and seed of a point, as numbers, and as their spellings (`labels`)."""

    r: float
    beta: float
    seed: int
    labels: tuple[str, str, str]


def grid_points(
    r: Iterable[Any], beta: Iterable[Any], seed: Iterable[Any], *, prefix: str = ""
) -> list[GridPoint]:
    """Return the points of all combinations of r, beta and seed, each given as labels or numbers.

    Only here is text converted to numbers, and do numbers get their labels. The seed varies
    fastest. Raises InputError for an illegal label and for a number given twice; messages put
    `prefix` before the name of its axis.
    """
    by_r, by_beta, by_seed = (
        numbers_of(f"{prefix}{name}", labels, parse)
        for (name, parse), labels in zip(PARSE.items(), (r, beta, seed), strict=True)
    )
    combinations = itertools.product(by_r, by_beta, by_seed)
    return [GridPoint(by_r[a], by_beta[b], by_seed[c], (a, b, c)) for a, b, c in combinations]


def numbers_of(key: str, labels: Iterable[Any], parse: Callable[[Any], Any]) -> NamedValues:
    """Return the numbers along an axis, by their spellings, from labels as a user wrote them.

    `parse` returns the number of a label. Raises InputError, with this `key`, for a number given
    twice.
    """
    label_of: dict[Any, str] = {}
    for label in labels:
        value = parse(label)
        if value in label_of:
            raise InputError(key, label, "be given once")
        label_of[value] = spelling(value)
    return {label: value for value, label in label_of.items()}


def spelling(value: float | str) -> str:
    """Return the label of a number in paths: its shortest unique decimal form without an exponent.

    Examples are 0.9, -0.5, 1 and 0. A word is its own label.
    """
    if not isinstance(value, float):
        return str(value)
    text = f"{Decimal(repr(value + 0.0)):f}"  # without an exponent, and without the sign of -0
    return text.rstrip("0").removesuffix(".") if "." in text else text


def restitution(label: Any, key: str = "restitution r") -> float:
    """Return the normal restitution r that `label` (text or a number) stands for, in [0, 1].

    Raises InputError, with this `key`, for another label.
    """
    return _number_in(RESTITUTION, key, label)


def roughness(label: Any, key: str = "roughness beta") -> float:
    """Return the roughness beta that `label` (text or a number) stands for, in [-1, 1].

    Raises InputError, with this `key`, for another label.
    """
    return _number_in(ROUGHNESS, key, label)


def seed(label: Any, key: str = "seed") -> int:
    """Return the seed that `label` (text or a number) stands for, from 0 to 2^63 - 1.

    Raises InputError, with this `key`, for another label.
    """
    if not WHOLE_NUMBER.fullmatch(str(label)) or int(label) > LARGEST_SEED:
        raise InputError(key, label, "be a whole number in [0, 2^63 - 1]")
    return int(label)


PARSE: dict[str, Callable[[Any], Any]] = {"r": restitution, "beta": roughness, "seed": seed}
"""Parser of labels of each axis of a point."""


def parser_of(axis: str) -> Callable[[Any], Any]:
    """Return the function that parses labels along an axis of a sweep: `restitution` for "r".

    For a third axis, a swept setting other than r, beta and seed, it is `level`.
    """
    return PARSE[axis] if axis in PARSE else level


def level(label: Any, key: str = "swept parameter") -> float | str:
    """Return the value of a swept parameter that `label` stands for: a number, or a word.

    Whether it is legal for that parameter is not checked. Raises InputError, with this `key`, for
    text that is neither.
    """
    if NUMBER.fullmatch(str(label)):
        return float(label) + 0.0
    if WORD.fullmatch(str(label)):
        return str(label)
    raise InputError(key, label, LEGAL_LEVEL)


def parameter_of(key: str) -> str:
    """Return the name of a swept parameter from its key: `inertia` for spin.inertia."""
    return key.rpartition(".")[2]


def _number_in(interval: Interval, key: str, label: Any) -> float:
    """Return the number that `label` (text or a number) stands for; -0 becomes 0.

    Raises InputError, with this `key`, for text that is no number and for a number outside the
    `interval`.
    """
    if not NUMBER.fullmatch(str(label)) or not interval.holds(float(label)):
        raise interval.error(key, label)
    return float(label) + 0.0  # turns -0 into 0


def names_of(species: Iterable[Any]) -> list[str]:
    """Return the names of species from their settings; without a name, the index as text."""
    return [str(settings.get("name", k)) for k, settings in enumerate(species)]


def species_settings(species: Sequence[Any], name: str, key: str = "") -> NamedValues | None:
    """Return the mapping, in the settings of a list of species, that holds `key` of one species.

    `name` is its name or index, with or without the prefix "species.". The mapping has the settings
    of the species, or of its distribution of radii if `key` belongs there; None for an unknown
    species.
    """
    named = dict(zip(names_of(species), species, strict=True))
    settings = named.get(name.removeprefix(SPECIES_PREFIX))
    radius = settings.get("radius") if settings else None
    return radius if key in RADIUS_DISTRIBUTION_KEYS and isinstance(radius, dict) else settings


def level_in(settings: RawSettings, key: str) -> Any:
    """Return the value in settings of the parameter `key` of a sweep's third axis, or None.

    `settings` are an experiment's, `key` is such as "spin.inertia", "species.heavy.mass" or "box",
    whose value is the width of the box in particle radii a. None stands for an absent parameter.
    """
    name, _, parameter = key.rpartition(".")
    if name.startswith(SPECIES_PREFIX):
        species = settings.get("species") or []
        return (species_settings(species, name, parameter) or {}).get(parameter)
    if name:
        settings_of_name = settings if name == "schedule" else settings["effects"]
        return settings_of_name.get(name, {}).get(parameter)
    return settings["box"][0] if key == "box" else settings.get(key)
