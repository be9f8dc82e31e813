"""`roughgas reduce`, `plot` and `crate`: what is made of results; `roughgas experiments`."""

import sys
from argparse import Namespace
from math import prod
from textwrap import fill

from roughgas import config
from roughgas.base import InputError, on_one_line
from roughgas.base.formatting import as_json, from_json
from roughgas.cli.options import number
from roughgas.cli.parser import WIDTH


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


def experiments(options: Namespace) -> None:
    """Print each experiment with its sweep at a scale."""
    loaded = config.load(options.config)
    found = {}
    for name, written in loaded["experiments"].items():
        settings = config.experiment(loaded, name, options.scale)
        sweep = {key: settings["sweep"][key] for key in _axes(settings)}
        points = prod(map(len, sweep.values()))
        about = {"description": written.get("description", ""), "extends": written.get("extends")}
        found[name] = about | {"points": points, "sweep": sweep}
    if options.json:
        print(as_json(found))
    else:
        print("\n\n".join(_text(name, about) for name, about in found.items()))


def _axes(settings):
    """Return the axes of a sweep, the third one first."""
    third = config.third_axis(settings)
    return [*([third] if third else []), "r", "beta"]


def _text(name, about):
    counts = ", ".join(f"{len(labels)} {key}" for key, labels in about["sweep"].items())
    extends = f"; extends {about['extends']}" if about["extends"] else ""
    description = on_one_line(" ".join(about["description"].split()))
    lines = [name, fill(description, WIDTH, initial_indent="  ", subsequent_indent="  ")]
    return "\n".join([*lines, f"  {about['points']} points: {counts}{extends}"])
