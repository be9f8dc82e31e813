"""What names a point: r, beta, seed and a swept parameter as they stand in paths and on command
lines; and what a third axis changes of a species or of a box.
"""

import itertools
import re
from collections.abc import Callable, Iterable
from typing import Any, NamedTuple

from roughgas.base import (  # noqa: F401
    RESTITUTION,
    ROUGHNESS,
    SPECIES,
    InputError,
    Interval,
    holder,
    names_of,
)

NUMBER = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?", re.ASCII)
WORD = re.compile(r"[a-z][a-z0-9_]*")
WHOLE_NUMBER = re.compile(r"\d{1,19}", re.ASCII)
LARGEST_SEED = 2**63 - 1
SWEPT = "swept"
"""Key, in the settings of a variant, of what its experiment sweeps, such as spin.inertia."""
LEGAL_LEVEL = "be a number, or a word of lower-case letters, digits and _"


class Place(NamedTuple):
    """What names a point: numbers, and the labels of r, beta and the seed that stand for them."""

    r: float
    beta: float
    seed: int
    labels: tuple[str, str, str]


def places(
    r: Iterable[Any], beta: Iterable[Any], seed: Iterable[Any], *, prefix: str = ""
) -> list[Place]:
    """Return the places of each r with each beta and seed, all of them labels or numbers.

    This is where text becomes numbers. Raises InputError for an illegal label, and for one that is
    given twice; messages put `prefix` before the name of its axis.
    """
    by_r, by_beta, by_seed = (
        numbers_of(f"{prefix}{name}", labels, parse)
        for (name, parse), labels in zip(PARSE.items(), (r, beta, seed), strict=True)
    )
    every = itertools.product(by_r, by_beta, by_seed)
    return [Place(by_r[a], by_beta[b], by_seed[c], (a, b, c)) for a, b, c in every]


def numbers_of(key: str, labels: Iterable[Any], parse: Callable[[Any], Any]) -> dict[str, Any]:
    """Return the numbers of an axis by their labels. Raises InputError as `places`."""
    found: dict[Any, str] = {}
    for label in labels:
        value = parse(label)
        if value in found:
            raise InputError(key, label, "be given once")
        found[value] = str(label)
    return {label: value for value, label in found.items()}


def restitution(label: Any, key: str = "restitution r") -> float:
    """Return the normal restitution that `label` (text or a number) stands for, in [0, 1]."""
    return _number_in(RESTITUTION, key, label)


def roughness(label: Any, key: str = "roughness beta") -> float:
    """Return the roughness that `label` (text or a number) stands for, in [-1, 1]."""
    return _number_in(ROUGHNESS, key, label)


def seed(label: Any, key: str = "seed") -> int:
    """Return the seed that `label` (text or a number) stands for, from 0 to 2^63 - 1."""
    if not WHOLE_NUMBER.fullmatch(str(label)) or int(label) > LARGEST_SEED:
        raise InputError(key, label, "be a whole number in [0, 2^63 - 1]")
    return int(label)


PARSE: dict[str, Callable[[Any], Any]] = {"r": restitution, "beta": roughness, "seed": seed}
"""By axis of a place, what makes a number of its label."""


def level(label: Any, key: str = "swept parameter") -> float | str:
    """Return the value of an effect's parameter that `label` stands for: a number, or a word.

    Whether the effect takes it is another matter.
    """
    if NUMBER.fullmatch(str(label)):
        return float(label) + 0.0
    if WORD.fullmatch(str(label)):
        return str(label)
    raise InputError(key, label, LEGAL_LEVEL)


def parameter_of(key: str) -> str:
    """Return the name of what a third axis sweeps: `inertia` for spin.inertia."""
    return key.rpartition(".")[2]


def _number_in(interval: Interval, key: str, label: Any) -> float:
    if not NUMBER.fullmatch(str(label)) or not interval.holds(float(label)):
        raise interval.error(key, label)
    return float(label) + 0.0  # turns -0 into 0
