"""What is made from points: `roughgas reduce`, `table`, `figure` and `claims`."""

import argparse
import sys
from typing import Any

from roughgas.cli.parser import examples


def add_commands(commands: Any) -> None:
    """Add the four subcommands to argparse's `commands`."""
    parser = _add(
        commands,
        "reduce",
        reduce,
        "combine the points of an experiment",
        "roughgas reduce results/paper/sheared/r*/beta*/seed*.nc -o sheared.nc",
    )
    parser.add_argument(
        "inputs",
        nargs="+",
        metavar="POINT",
        help="datasets of points, or folders of them; - reads their names from standard input, a "
        "line each: there may be more of them than fit on a command line",
    )
    parser.add_argument("-o", "--output", required=True, metavar="FILE", help="reduced dataset")

    parser = _add(
        commands,
        "table",
        table,
        "write reduced datasets as one CSV table",
        "roughgas table results/paper/sheared.nc results/paper/cooling.nc -o R.csv",
    )
    _add_reduced(parser)
    parser.add_argument("-o", "--output", required=True, metavar="FILE", help="CSV file")

    parser = _add(
        commands,
        "figure",
        figure,
        "draw a figure from reduced datasets",
        "roughgas figure fig2b results/paper/cooling.nc -o fig2b.pdf fig2b.png",
    )
    parser.add_argument("name", metavar="NAME", help="of the figure, such as fig1a")
    _add_reduced(parser)
    parser.add_argument(
        "-o", "--output", required=True, nargs="+", metavar="FILE", help=".pdf or .png files"
    )

    parser = _add(
        commands,
        "claims",
        claims,
        "judge the claims of the paper on reduced datasets",
        "roughgas claims results/paper/*.nc --json claims.json --markdown claims.md",
    )
    _add_reduced(parser)
    parser.add_argument(
        "--open-questions",
        action="store_true",
        help="judge what the paper leaves open, not what it claims of its own experiments",
    )
    parser.add_argument("--json", required=True, metavar="FILE", help="verdicts for programs")
    parser.add_argument("--markdown", required=True, metavar="FILE", help="verdicts for people")


def reduce(options: argparse.Namespace) -> None:
    """Combine points into a reduced dataset."""
    from roughgas.results.reduce import reduce_points

    piped = options.inputs == ["-"]
    reduce_points(sys.stdin.read().splitlines() if piped else options.inputs, options.output)


def table(options: argparse.Namespace) -> None:
    """Write reduced datasets as one table."""
    from roughgas.results.table import write_table

    write_table(options.inputs, options.output)


def figure(options: argparse.Namespace) -> None:
    """Draw one figure."""
    from roughgas.show import gallery
    from roughgas.studies import figures as of_studies

    if options.name in of_studies.FIGURES:
        of_studies.draw(options.name, *options.inputs, options.output)
    else:
        gallery.draw(options.name, options.inputs, options.output)


def claims(options: argparse.Namespace) -> None:
    """Judge the claims of the paper, or what it leaves open."""
    from roughgas.claims import OPEN_QUESTIONS, PAPER, judge

    subject = OPEN_QUESTIONS if options.open_questions else PAPER
    judge(options.inputs, options.json, options.markdown, subject)


def _add(
    commands: Any, name: str, command: Any, summary: str, example: str
) -> argparse.ArgumentParser:
    about = f"{summary[0].upper()}{summary[1:]}."
    parser = commands.add_parser(name, help=summary, description=about, epilog=examples(example))
    parser.set_defaults(command=command)
    return parser


def _add_reduced(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("inputs", nargs="+", metavar="REDUCED", help="reduced datasets")
