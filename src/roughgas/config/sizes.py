"""The size of a box from a packing: `packing` in place of lengths, `box` then its proportions.

An inherited box keeps its shape, and a packing that is inherited gives way to a box.
"""

import math
from collections.abc import Callable, Mapping
from typing import Any

from roughgas.base import InputError

PACKING = "packing"
SQUARE = [1, 1]
ROUNDING = 1e-9  # relative difference of a box from its packing
LONGEST = 1e9  # a


def layered(
    merged: Callable[..., dict[str, Any]], settings: Mapping[str, Any], changes: Mapping[str, Any]
) -> dict[str, Any]:
    """Return settings with changes merged in, where a box and a packing replace each other."""
    found = merged(settings, changes)
    if "box" in changes and PACKING not in changes:
        found.pop(PACKING, None)
    elif PACKING in found and "box" not in changes and "box" in settings:
        found["box"] = _proportions(settings["box"])
    return found


def fitted(settings: Mapping[str, Any], where: str) -> dict[str, Any]:
    """Return settings whose box has the `packing` asked for, if any: lengths in a.

    Values that the schema refuses are left to it. Raises InputError, whose key begins with `where`,
    for an open box, for a box of another packing, and for one that would be too large.
    """
    found, asked = dict(settings), settings.get(PACKING)
    number = settings.get("particles")
    if not isinstance(asked, int | float) or not asked > 0 or not isinstance(number, int):
        return found
    from roughgas.effects.species import packing  # needs numpy

    box = found.setdefault("box", SQUARE)
    if "open" in box:
        raise InputError(f"{where}.{PACKING}", asked, "not be given for a box that is open above")
    there = packing({"effects": {}} | found)
    if abs(there - asked) <= ROUNDING * asked:
        return found
    if min(box) != 1:
        legal = f"not stand beside packing = {asked}; or be proportions, the least 1: [1, 2]"
        raise InputError(f"{where}.box", box, legal)
    length = (there / asked) ** (1.0 / len(box))
    if not math.isfinite(length) or length * max(box) > LONGEST:
        legal = f"be so large that no side of the box is longer than {LONGEST:g} a"
        raise InputError(f"{where}.{PACKING}", asked, legal)
    return found | {"box": [length * side for side in box]}


def _proportions(box):
    return box if "open" in box else [side / min(box) for side in box]
