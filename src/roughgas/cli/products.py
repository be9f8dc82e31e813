"""What is made from results: `roughgas reduce`, `plot`, `export` and `crate`."""

import os
import sys
from argparse import Namespace
from pathlib import Path

from roughgas.base.errors import InputError
from roughgas.base.layout import from_json
from roughgas.cli.options import number
from roughgas.cli.outputs import check_outputs


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


def export(options: Namespace) -> None:
    """Write tables, and print their names."""
    from roughgas.results.export import export as export_dataset

    output = Path(options.output or f"{os.path.splitext(options.input)[0]}.csv")
    if output.suffix != ".csv":
        raise InputError("--output", output, "end in .csv")
    if options.output is None:
        check_outputs(options, [output])
    for file in export_dataset(options.input, output):
        print(file, file=sys.stderr)


def crate(options: Namespace) -> None:
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
    settings = config.load(options.config) if text is None else from_json(text, "--configuration")
    write_crate(options.files, options.output, settings, options.points)
    print(f"{options.output}: {len(options.files)} results, and what they rest on", file=sys.stderr)
