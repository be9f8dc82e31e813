"""`roughgas bench`: how fast this machine simulates."""

import argparse
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from roughgas.base.errors import InputError
from roughgas.cli.layout import as_json, columns
from roughgas.cli.parser import examples
from roughgas.cli.settings import add_experiments, add_scale

if TYPE_CHECKING:
    from roughgas.simulation.speed import Speed

EXAMPLES = examples(
    "roughgas bench",
    "roughgas bench cooling vibrated --r 0.8 --beta 0.5 --runs 9",
    "roughgas bench cooling --scale small --json",
)


def add_commands(commands: Any) -> None:
    """Add the subcommand to argparse's `commands`."""
    parser = commands.add_parser(
        "bench",
        help="how fast this machine simulates",
        description="Measure how many collisions a second of CPU time experiments make on one core "
        "of this machine, after compiling: the median of several runs, and the slowest and the "
        "fastest. Kernels that are not there yet are compiled first, 12 s for each kind of scene.",
        epilog=EXAMPLES,
    )
    default = "default: those that extend no other"
    add_experiments(parser, dest="experiments", nargs="*", help=default)
    add_scale(parser)
    parser.add_argument("--r", default="0.9", help="normal restitution, in [0, 1] (default: 0.9)")
    parser.add_argument("--beta", default="0", help="roughness, in [-1, 1] (default: 0)")
    parser.add_argument("--runs", default="5", help="of about 0.3 s each (default: 5)")
    parser.add_argument("--json", action="store_true", help="for scripts")
    parser.set_defaults(command=bench)


def bench(options: argparse.Namespace) -> None:
    """Print the speeds."""
    from roughgas import config

    r, beta = config.restitution(options.r), config.roughness(options.beta)
    if not options.runs.isdecimal() or int(options.runs) < 1:
        raise InputError("--runs", options.runs, "be a whole number >= 1")
    found, runs = _experiments(options), int(options.runs)

    from roughgas.base.machine import description
    from roughgas.simulation.progress import Bar
    from roughgas.simulation.speed import measure

    speeds = []
    with Bar("bench", len(found) * (runs + 1), "runs") as bar:
        for name, settings in found.items():
            speeds.append(measure(name, settings, r, beta, runs, bar.advance))
    machine = description()
    if options.json:
        print(as_json({"machine": machine, "speeds": [_record(one) for one in speeds]}))
    else:
        print(f"{_table(speeds)}\n\n{columns(machine.items())}")


def _experiments(options: argparse.Namespace) -> dict[str, dict[str, Any]]:
    """The settings by name: of a third axis, unless it is said, the first variant."""
    from roughgas import config

    loaded = config.load(options.config)
    basic = [name for name, one in loaded["experiments"].items() if "extends" not in one]
    found = {}
    for name in options.experiments or basic:
        every = config.every_variant(name, config.experiment(loaded, name, options.scale))
        first = next(iter(every))
        found[first] = every[first]
    return found


def _record(speed: "Speed") -> dict[str, Any]:
    about = {
        "collisions_per_second": speed.median,
        "slowest": min(speed.rates),
        "fastest": max(speed.rates),
    }
    return speed._asdict() | about


def _table(speeds: Sequence["Speed"]) -> str:
    rows = [["experiment", "r", "beta", "particles", "collisions / s", "slowest", "fastest"]]
    for one in speeds:
        rates = (one.median, min(one.rates), max(one.rates))
        place = [one.experiment, f"{one.r:g}", f"{one.beta:g}", str(one.particles)]
        rows.append(place + [f"{float(f'{rate:.3g}'):,.0f}" for rate in rates])
    return columns(rows, numbers=True)
