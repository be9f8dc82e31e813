"""Options that several commands share, what a shell completes them to, and their numbers."""

import math
import re
from argparse import Namespace
from collections.abc import Iterable
from decimal import Decimal
from typing import Any

from roughgas.base.errors import InputError
from roughgas.base.legal import Interval
from roughgas.cli.parser import flag, value

RANGE = re.compile(r"([^:]+):([^:]+):([^:]+)")
MOST = 100_000  # values in a range


def _experiments(prefix: str, parsed_args: Namespace, **others: Any) -> list[str]:
    """Return the names of experiments; after a `/`, those of an experiment's variants."""
    config = _configuration(parsed_args)
    base, slash, _ = prefix.partition("/")
    if not slash:
        return list(config["experiments"])
    from roughgas.config import experiment, variants

    scale = parsed_args.scale if parsed_args.scale in config["scales"] else config["scale"]
    return variants(base, experiment(config, base, scale))


def _scales(parsed_args: Namespace, **_: Any) -> list[str]:
    """Return the names of scales."""
    return list(_configuration(parsed_args)["scales"])


def _configuration(options: Namespace) -> Any:
    """Return the configuration unchecked; errors make argcomplete offer nothing."""
    from roughgas.config import in_use
    from roughgas.config.checking import read

    return read(options.config or in_use())[0]


SCALE = value(
    "--scale",
    "a scale of the configuration: small, ... (default: its own)",
    completer=_scales,
)
CONFIG = value("--config FILE", "the configuration (default: config.yaml here, or roughgas's own)")
SETTINGS = (
    SCALE,
    CONFIG,
    value("--settings JSON", "the settings, in place of --config"),
    flag("--checked", "trust --settings, which saves 0.1 s"),
)
"""Where the settings of a simulation come from."""
EXPERIMENT = value(
    "experiment EXPERIMENT",
    "its name in the configuration, or that of a variant: EXPERIMENT/VARIANT",
    completer=_experiments,
)
RESTITUTION = "normal restitution, in [0, 1]: 1 is elastic"
ROUGHNESS = "roughness, in [-1, 1]: -1 is smooth, 1 perfectly rough"
POINT = (
    EXPERIMENT,
    *SETTINGS,
    value("--r", RESTITUTION, required=True),
    value("--beta", ROUGHNESS, required=True),
)
"""What names a point, except for its seed."""
LISTED = "a list, or START:STOP:STEP"
POINTS = (
    EXPERIMENT,
    *SETTINGS,
    value("--r VALUE", f"{RESTITUTION}; {LISTED}", required=True, nargs="+"),
    value("--beta VALUE", f"{ROUGHNESS}; {LISTED}", required=True, nargs="+"),
    value(
        "--seed SEED",
        f"seeds of the random generator: 0, 1, ...; {LISTED} (default: 1)",
        nargs="+",
        default=["1"],
    ),
)
"""What names several points: each r with each beta and each seed."""
SET = value(
    "--set KEY=VALUE",
    "change settings: particles=80, schedule.measure=100, effects.friction.mu=0.3; null removes",
    nargs="+",
    default=(),
    dest="changes",
)
FROM = value("--from POINT", "continue from the last state of this dataset", dest="start_from")
TAKE = (
    value("--start TIME", "time of the first frame (default: when steady)"),
    value("--length TIME", "time shown (default: by experiment)"),
    value("--frames NUMBER", "number of frames (default: 125 or 160)"),
)
"""Which part of a point is shown."""


def whole_number(key: str, text: str, low: int, high: float = math.inf, of: str = "") -> int:
    """Return the number that the option `key` was given. Raises InputError outside [low, high]."""
    if text.isdecimal() and low <= int(text) <= high:
        return int(text)
    legal = f"in [{low}, {high}]" if high < math.inf else f">= {low}"
    raise InputError(key, text, f"be a whole number {of}{legal}")


def number(key: str, text: str, legal: Interval | None = None) -> float:
    """Return the number that the option `key` was given. Raises InputError if it is not legal."""
    try:
        found = float(text)
    except ValueError:
        raise InputError(key, text, "be a number") from None
    return legal.check(key, found) if legal else found


def labels(key: str, given: str | Iterable[str]) -> list[str]:
    """Return the one label, or those of a list, its ranges START:STOP:STEP written out."""
    if isinstance(given, str):
        return [given]
    return [label for text in given for label in _written_out(key, text)]


def _written_out(key: str, text: str) -> list[str]:
    """Return the labels from START to STOP, as exact as they are written; another text as it is."""
    ends = RANGE.fullmatch(text)
    if ends is None:
        return [text]
    try:
        start, stop, step = (Decimal(part) for part in ends.groups())
        count = int((stop - start) / step) + 1
    except (ArithmeticError, ValueError):
        raise InputError(key, text, "be START:STOP:STEP, such as -1:1:0.1") from None
    if not 0 < count <= MOST or stop < start:
        raise InputError(key, text, f"go up from START to STOP in at most {MOST:,} steps")
    return [str(start + k * step) for k in range(count)]


def print_completion(options: Namespace) -> None:
    """Print a shell's lines."""
    import argcomplete

    print(argcomplete.shellcode(["roughgas"], shell=options.shell))
