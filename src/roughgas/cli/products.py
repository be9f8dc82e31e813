"""What is made from points: `roughgas reduce`, `table`, `figure` and `claims`."""

import argparse
from typing import Any


def add_commands(commands: Any) -> None:
    """Add the four subcommands to argparse's `commands`."""
    parser = _add(commands, "reduce", reduce, "combine the points of an experiment")
    parser.add_argument(
        "inputs", nargs="+", metavar="POINT", help="datasets of points, or folders of them"
    )
    parser.add_argument("-o", "--output", required=True, metavar="FILE", help="reduced dataset")

    parser = _add(commands, "table", table, "write reduced datasets as one CSV table")
    _add_reduced(parser)
    parser.add_argument("-o", "--output", required=True, metavar="FILE", help="CSV file")

    parser = _add(commands, "figure", figure, "draw a figure from reduced datasets")
    parser.add_argument("name", metavar="NAME", help="of the figure, such as fig1a")
    _add_reduced(parser)
    parser.add_argument(
        "-o", "--output", required=True, nargs="+", metavar="FILE", help=".pdf or .png files"
    )

    parser = _add(commands, "claims", claims, "judge the claims of the paper on reduced datasets")
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
    from roughgas.reduce import reduce_points

    reduce_points(options.inputs, options.output)


def table(options: argparse.Namespace) -> None:
    """Write reduced datasets as one table."""
    from roughgas.table import write_table

    write_table(options.inputs, options.output)


def figure(options: argparse.Namespace) -> None:
    """Draw one figure."""
    from roughgas.plotting import draw

    draw(options.name, options.inputs, options.output)


def claims(options: argparse.Namespace) -> None:
    """Judge the claims of the paper, or what it leaves open."""
    from roughgas.claims import OPEN_QUESTIONS, PAPER, judge

    subject = OPEN_QUESTIONS if options.open_questions else PAPER
    judge(options.inputs, options.json, options.markdown, subject)


def _add(commands: Any, name: str, command: Any, summary: str) -> argparse.ArgumentParser:
    parser = commands.add_parser(name, help=summary, description=f"{summary.capitalize()}.")
    parser.set_defaults(command=command)
    return parser


def _add_reduced(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("inputs", nargs="+", metavar="REDUCED", help="reduced datasets")
