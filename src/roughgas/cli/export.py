"""`roughgas export` writes a dataset as CSV."""

import argparse
import sys
from pathlib import Path
from typing import Any

from roughgas.cli.parser import examples

EXAMPLE = examples("roughgas export results/paper/vibrated.nc -o vibrated.csv")


def add_commands(commands: Any) -> None:
    """Add the subcommand to argparse's `commands`."""
    parser = commands.add_parser(
        "export",
        help="write a dataset as CSV tables",
        description="Write any dataset of the pipeline as CSV: the time series of a point, the "
        "grid of a reduced dataset or the frames of a film to the file named, other tables, and "
        "FILE.about.csv with scalars, units and meanings, beside it.",
        epilog=EXAMPLE,
    )
    parser.add_argument("input", metavar="DATASET", help="dataset that the pipeline wrote")
    parser.add_argument(
        "-o", "--output", metavar="FILE", help="CSV file (default: DATASET with the ending .csv)"
    )
    parser.set_defaults(command=export)


def export(options: argparse.Namespace) -> None:
    """Write the tables, and say where."""
    from roughgas.base.errors import InputError
    from roughgas.results.export import export as export_dataset

    output = Path(options.output or Path(options.input).with_suffix(".csv"))
    if output.suffix != ".csv":
        raise InputError("--output", output, "end in .csv")
    for file in export_dataset(options.input, output):
        print(file, file=sys.stderr)
