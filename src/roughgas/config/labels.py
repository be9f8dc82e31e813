"""What names a point: r, beta, seed and a swept parameter as they stand in paths and on command
lines."""

import re
from typing import Any

from roughgas.base.errors import InputError
from roughgas.base.legal import RESTITUTION, ROUGHNESS, Interval

NUMBER = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?", re.ASCII)
WORD = re.compile(r"[a-z][a-z0-9_]*")
WHOLE_NUMBER = re.compile(r"\d{1,19}", re.ASCII)
LARGEST_SEED = 2**63 - 1
SWEPT = "swept"
"""Key, in the settings of a variant, of what its experiment sweeps, such as spin.inertia."""
LEGAL_LEVEL = "be a number, or a word of lower-case letters, digits and _"


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
