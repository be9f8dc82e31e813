"""The options that say where the settings of a simulation come from."""

import argparse
from typing import Any

from roughgas.cli import completion


def add_settings(parser: argparse.ArgumentParser) -> None:
    """Add --scale, --config, --settings and --checked."""
    add_scale(parser)
    parser.add_argument("--settings", metavar="JSON", help="its settings, in place of --config")
    parser.add_argument(
        "--checked", action="store_true", help="take --settings for legal, which saves 0.1 s"
    )


def add_scale(parser: argparse.ArgumentParser) -> None:
    """Add --scale and --config."""
    scale: Any = parser.add_argument(
        "--scale", default="paper", help="as in the configuration: small, ... (default: paper)"
    )
    scale.completer = completion.scales
    parser.add_argument(
        "--config",
        default="config.yaml",
        metavar="FILE",
        help="the configuration (default: config.yaml)",
    )


def add_experiments(parser: argparse.ArgumentParser, **about: Any) -> None:
    """Add the positional argument(s) that name experiments, which a shell can complete."""
    name: Any = parser.add_argument(metavar="EXPERIMENT", **about)
    name.completer = completion.experiments
