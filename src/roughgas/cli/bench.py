"""`roughgas bench`: how fast this machine simulates."""

from argparse import Namespace
from typing import Any

from roughgas import config
from roughgas.base.layout import as_json, columns
from roughgas.base.machine import description
from roughgas.cli.options import whole_number
from roughgas.simulation.progress import Bar
from roughgas.simulation.speed import speed_of

HEAD = ["experiment", "r", "beta", "particles", "collisions / s", "slowest", "fastest"]


def bench(options: Namespace) -> None:
    """Measure and print the speeds of experiments."""
    r, beta = config.restitution(options.r), config.roughness(options.beta)
    runs = whole_number("--runs", options.runs, 1)
    found = _experiments(options)
    records, rows = [], [HEAD]
    with Bar("bench", len(found) * (runs + 1), "runs") as bar:
        for name, settings in found.items():
            one = speed_of(name, settings, r, beta, runs, bar.advance)
            rates = one.median, min(one.rates), max(one.rates)
            named = zip(("collisions_per_second", "slowest", "fastest"), rates, strict=True)
            records.append(one._asdict() | dict(named))
            shown = [f"{float(f'{rate:.3g}'):,.0f}" for rate in rates]
            rows.append([name, f"{r:g}", f"{beta:g}", str(one.particles), *shown])
    machine = description()
    if options.json:
        print(as_json({"machine": machine, "speeds": records}))
    else:
        print(f"{columns(rows, numbers=True)}\n\n{columns(machine.items())}")


def _experiments(options: Namespace) -> dict[str, dict[str, Any]]:
    """Return settings by name: for an experiment with a third axis, its first variant's."""
    loaded = config.load(options.config)
    basic = [name for name, one in loaded["experiments"].items() if "extends" not in one]
    found = {}
    for name in options.experiments or basic:
        every = config.every_variant(name, config.experiment(loaded, name, options.scale))
        first = next(iter(every))
        found[first] = every[first]
    return found
