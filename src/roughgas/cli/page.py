"""What is made to be looked at: `roughgas page`, `html`, `times` and `config`."""

import argparse
from typing import Any

from roughgas.cli.parser import examples

PAGE_EXAMPLE = examples(
    "roughgas page results/small/vibrated.nc --points results/small -o explore.html"
)
HTML_EXAMPLE = examples("roughgas html results/small/claims.md -o claims.html")
TIMES_EXAMPLE = examples("roughgas times results/small/vibrated.nc -o run_times.md")
CONFIG_EXAMPLE = examples("roughgas config --scale small -o config_small.yaml")


def add_commands(commands: Any) -> None:
    """Add the four subcommands to argparse's `commands`."""
    parser = commands.add_parser(
        "page",
        help="write an interactive page of experiments",
        description="Write one HTML file in which to look at every point of some experiments: its "
        "R beside theory, its time series, and the command that runs it again.",
        epilog=PAGE_EXAMPLE,
    )
    _add_reduced(parser)
    parser.add_argument(
        "--points", required=True, metavar="FOLDER", help="where their points are: results/SCALE"
    )
    parser.add_argument("-o", "--output", required=True, metavar="FILE", help="HTML file to write")
    parser.set_defaults(command=page)

    parser = commands.add_parser(
        "html",
        help="write a table, a configuration or a movie as HTML",
        description="Write a Markdown, YAML, MP4 or GIF file as one HTML page, as Snakemake's "
        "report can show it.",
        epilog=HTML_EXAMPLE,
    )
    parser.add_argument("input", metavar="FILE", help="file to show")
    parser.add_argument("-o", "--output", required=True, metavar="FILE", help="HTML file to write")
    parser.set_defaults(command=html)

    parser = commands.add_parser(
        "times",
        help="say how long experiments took",
        description="Write, from reduced datasets, the CPU seconds that experiments took.",
        epilog=TIMES_EXAMPLE,
    )
    _add_reduced(parser)
    parser.add_argument("-o", "--output", required=True, metavar="FILE", help="Markdown file")
    parser.set_defaults(command=times)

    parser = commands.add_parser(
        "config",
        help="write the complete configuration of a scale",
        description="Write the configuration of a scale with nothing left to be looked up: what "
        "experiments take over from each other, and what the scale changes.",
        epilog=CONFIG_EXAMPLE,
    )
    parser.add_argument("--scale", default="paper", help="the scale (default: paper)")
    parser.add_argument("--config", default="config.yaml", metavar="FILE", help="the configuration")
    parser.add_argument(
        "--changes", default="{}", metavar="JSON", help="changes to it, as on a command line"
    )
    parser.add_argument("-o", "--output", required=True, metavar="FILE", help="YAML file to write")
    parser.set_defaults(command=effective_config)


def page(options: argparse.Namespace) -> None:
    """Write the interactive page."""
    from roughgas.show.page import write_page

    write_page(options.inputs, options.points, options.output)


def html(options: argparse.Namespace) -> None:
    """Write a file as HTML."""
    from roughgas.show.page.document import write_document

    write_document(options.input, options.output)


def times(options: argparse.Namespace) -> None:
    """Write how long experiments took."""
    from roughgas.results.times import write_times

    write_times(options.inputs, options.output)


def effective_config(options: argparse.Namespace) -> None:
    """Write the configuration of a scale."""
    from roughgas import config
    from roughgas.config.effective import write_effective

    changes = config.from_text(options.changes, "--changes", checked=True)
    write_effective(config.load(options.config, changes), options.scale, options.output)


def _add_reduced(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("inputs", nargs="+", metavar="REDUCED", help="reduced datasets")
