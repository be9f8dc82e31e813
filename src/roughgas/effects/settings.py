"""Reading an effect's parameters from settings: numbers in their legal range, or an InputError."""

import math
from collections.abc import Mapping
from typing import Any, NamedTuple

from roughgas.errors import InputError


class Surroundings(NamedTuple):
    """What an effect may need to know of the scene that it is part of."""

    box: tuple[float | None, ...]  # lengths in a; None is open
    restitution: float  # of the particles
    roughness: float


def number(settings: Mapping[str, Any], effect: str, name: str, low=0.0, high=math.inf, ends=False):
    """Parameter `name` of an effect, between low and high; `ends` tells whether these are legal."""
    value = settings.get(name)
    valid = isinstance(value, int | float) and not isinstance(value, bool)
    if not valid or not (low <= value <= high if ends else low < value < high):
        raise InputError(f"effects.{effect}.{name}", value, _legal(low, high, ends))
    return float(value)


def material(settings: Mapping[str, Any], effect: str, around: Surroundings):
    """(restitution, roughness) of a boundary; `particles` stands for the particles' own."""
    r, beta = (
        own if settings.get(name) == "particles" else number(settings, effect, name, low, 1.0, True)
        for name, low, own in (
            ("restitution", 0.0, around.restitution),
            ("roughness", -1.0, around.roughness),
        )
    )
    return r, beta


def _legal(low, high, ends):
    if high == math.inf:
        return f"be a number above {low:g}"
    brackets = "[]" if ends else "()"
    return f"lie in {brackets[0]}{low:g}, {high:g}{brackets[1]}"
