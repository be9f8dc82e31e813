"""The options that say where the settings of a simulation come from."""

import argparse


def add_settings(parser: argparse.ArgumentParser) -> None:
    """Add --scale, --config, --settings and --checked."""
    parser.add_argument("--scale", default="paper", help="its scale (default: paper)")
    parser.add_argument("--config", default="config.yaml", metavar="FILE", help="the configuration")
    parser.add_argument("--settings", metavar="JSON", help="its settings, in place of --config")
    parser.add_argument(
        "--checked", action="store_true", help="take --settings for legal, which saves 0.1 s"
    )
