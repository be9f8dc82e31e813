"""What is made from results: `roughgas reduce`, `plot` and `crate`."""

import sys
from argparse import Namespace

from roughgas.base.errors import InputError
from roughgas.base.layout import from_json
from roughgas.cli.options import number


def reduce(options: Namespace) -> None:
    """Combine points into a reduced dataset."""
    from roughgas.results.reduce import reduce_points

    piped = options.inputs == ["-"]
    reduce_points(sys.stdin.read().splitlines() if piped else options.inputs, options.output)


def plot(options: Namespace) -> None:
    """Draw any reduced dataset."""
    from roughgas.show import gallery

    names = ("r", "beta")
    chosen = {n: [number(f"--{n}", one) for one in getattr(options, n) or ()] for n in names}
    for line in gallery.plot(options.input, options.output, options.over, **chosen):
        print(line, file=sys.stderr)


def crate(options: Namespace) -> None:
    """Write a crate."""
    from roughgas import config
    from roughgas.results.crate import write_crate

    if not options.output.endswith(".zip"):
        raise InputError("--output", options.output, "end in .zip")
    text = options.configuration
    settings = config.load(options.config) if text is None else from_json(text, "--configuration")
    write_crate(options.files, options.output, settings)
