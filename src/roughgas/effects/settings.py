"""Reading an effect's parameters from settings: numbers in their legal range, or an InputError."""

from collections.abc import Mapping
from typing import Any, NamedTuple

from roughgas.errors import InputError


class Surroundings(NamedTuple):
    """What an effect may need to know of the scene that it is part of."""

    box: tuple[float | None, ...]  # lengths in a; None is open
    restitution: float  # of the particles
    roughness: float


def number(settings: Mapping[str, Any], effect: str, name: str, interval: str = "(0, inf)"):
    """Parameter `name` of an effect, which must lie in the interval."""
    value = settings.get(name)
    low, high = (float(end) for end in interval[1:-1].split(","))
    legal = (
        isinstance(value, int | float)
        and not isinstance(value, bool)
        and (low < value or (interval[0] == "[" and value == low))
        and (value < high or (interval[-1] == "]" and value == high))
    )
    if not legal:
        raise InputError(f"effects.{effect}.{name}", value, f"be a number in {interval}")
    return float(value)


def material(settings: Mapping[str, Any], effect: str, around: Surroundings):
    """(restitution, roughness) of a boundary; `particles` stands for the particles' own."""
    r, beta = (
        own if settings.get(name) == "particles" else number(settings, effect, name, interval)
        for name, own, interval in (
            ("restitution", around.restitution, "[0, 1]"),
            ("roughness", around.roughness, "[-1, 1]"),
        )
    )
    return r, beta
