"""What is made to be looked at in a browser: `roughgas page`."""

import argparse
from typing import Any

PAGE_EXAMPLE = (
    "example: roughgas page results/small/vibrated.nc --points results/small -o explore.html"
)


def add_commands(commands: Any) -> None:
    """Add the subcommand to argparse's `commands`."""
    parser = commands.add_parser(
        "page",
        help="write an interactive page of experiments",
        description="Write one HTML file in which to look at every point of some experiments: its "
        "R beside theory, its time series, and the command that runs it again.",
        epilog=PAGE_EXAMPLE,
    )
    parser.add_argument("inputs", nargs="+", metavar="REDUCED", help="reduced datasets")
    parser.add_argument(
        "--points", required=True, metavar="FOLDER", help="where their points are: results/SCALE"
    )
    parser.add_argument("-o", "--output", required=True, metavar="FILE", help="HTML file to write")
    parser.set_defaults(command=page)


def page(options: argparse.Namespace) -> None:
    """Write the interactive page."""
    from roughgas.page import write_page

    write_page(options.inputs, options.points, options.output)
