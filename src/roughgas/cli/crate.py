"""`roughgas crate` packs a finished run as an RO-Crate, or checks one."""

import argparse
import json
import sys
from typing import Any

from roughgas.base.errors import InputError
from roughgas.cli.parser import examples

EXAMPLES = examples(
    "roughgas crate results/paper/*.nc results/paper/R.csv figures/fig*.png -o run.zip",
    "roughgas crate --verify run.zip",
    "roughgas crate --verify run.zip results/paper/cooling/r0.9/beta0/seed1.nc",
)


def add_commands(commands: Any) -> None:
    """Add the subcommand to argparse's `commands`."""
    parser = commands.add_parser(
        "crate",
        help="pack a finished run as an RO-Crate, or check one",
        description="Pack what a run in this folder has made, with its configuration, code and "
        "environment, as an RO-Crate with checksums; the same files give the same bytes.",
        epilog=EXAMPLES,
    )
    parser.add_argument(
        "files", nargs="*", metavar="FILE", help="results and figures; with --verify, points"
    )
    action = parser.add_mutually_exclusive_group(required=True)
    action.add_argument("-o", "--output", metavar="CRATE", help=".zip file, or a new folder")
    action.add_argument("--verify", metavar="CRATE", help="check the checksums in a crate")
    parser.add_argument(
        "--points", action="store_true", help="pack the points' files, too, not only their list"
    )
    parser.add_argument("--config", default="config.yaml", metavar="FILE", help="the configuration")
    parser.add_argument("--configuration", metavar="JSON", help="the same, in place of --config")
    parser.set_defaults(command=crate)


def crate(options: argparse.Namespace) -> None:
    """Write or check a crate."""
    from roughgas import config
    from roughgas.results.crate import verify, write_crate

    if options.verify is not None:
        wrong = verify(options.verify, options.files)
        for line in wrong:
            print(line, file=sys.stderr)
        if wrong:
            raise InputError("crate", options.verify, "be as it was packed")
        print(f"{options.verify}: all is as it was packed", file=sys.stderr)
        return
    if not options.files:
        raise InputError("number of files to pack", 0, "be at least 1")
    text = options.configuration
    settings = config.load(options.config) if text is None else json.loads(text)
    write_crate(options.files, options.output, settings, options.points)
    print(f"{options.output}: {len(options.files)} results, and what they rest on", file=sys.stderr)
