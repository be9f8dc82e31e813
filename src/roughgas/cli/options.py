"""Options that several commands share, what a shell completes them to, and their numbers."""

import math
from argparse import Namespace
from typing import Any

from roughgas.base.errors import InputError
from roughgas.base.legal import Interval
from roughgas.cli.parser import Option, flag, value


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
    from roughgas.config.reading import read_yaml

    return read_yaml(options.config or in_use())


SCALE = value(
    "--scale", "a scale of the configuration: small, ...", default="paper", completer=_scales
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
KERNEL = (EXPERIMENT, *SETTINGS, value("--r", RESTITUTION, required=True))
POINT = (*KERNEL, value("--beta", ROUGHNESS, required=True))
"""What names a point, except for its seed."""
FROM = value("--from POINT", "continue from the last state of this dataset", dest="start_from")
TAKE = (
    value("--start TIME", "time of the first frame (default: when steady)"),
    value("--length TIME", "time shown (default: by experiment)"),
    value("--frames NUMBER", "number of frames (default: 125 or 160)"),
)
"""Which part of a point is shown."""
REDUCED = value("inputs REDUCED", "reduced datasets", nargs="+")


def experiments(help: str) -> tuple[Option, ...]:
    """Declare the arguments that choose experiments of a configuration."""
    names = value("experiments EXPERIMENT", help, nargs="*", completer=_experiments)
    return names, SCALE, CONFIG


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


def print_completion(options: Namespace) -> None:
    """Print a shell's lines."""
    import argcomplete

    print(argcomplete.shellcode(["roughgas"], shell=options.shell))
