"""`roughgas bench`: how fast this machine simulates."""

from argparse import Namespace
from typing import Any

from roughgas.cli.options import whole_number

HEAD = ["experiment", "r", "beta", "particles", "collisions / s", "slowest", "fastest"]


def bench(options: Namespace) -> None:
    """Measure and print the speeds of experiments."""
    from roughgas import config
    from roughgas.base.layout import as_json, columns
    from roughgas.base.machine import description

    r, beta = config.restitution(options.r), config.roughness(options.beta)
    runs = whole_number("--runs", options.runs, 1)
    found = _experiments(options)

    from roughgas.simulation.progress import Bar
    from roughgas.simulation.speed import speed_of

    with Bar("bench", len(found) * (runs + 1), "runs") as bar:
        speeds = [
            speed_of(name, settings, r, beta, runs, bar.advance) for name, settings in found.items()
        ]
    about = [(one.median, min(one.rates), max(one.rates)) for one in speeds]
    machine = description()
    if options.json:
        names = ("collisions_per_second", "slowest", "fastest")
        records = [
            one._asdict() | dict(zip(names, rates, strict=True))
            for one, rates in zip(speeds, about, strict=True)
        ]
        print(as_json({"machine": machine, "speeds": records}))
        return
    rows = [HEAD]
    for one, rates in zip(speeds, about, strict=True):
        place = [one.experiment, f"{one.r:g}", f"{one.beta:g}", str(one.particles)]
        rows.append([*place, *(f"{float(f'{rate:.3g}'):,.0f}" for rate in rates)])
    print(f"{columns(rows, numbers=True)}\n\n{columns(machine.items())}")


def _experiments(options: Namespace) -> dict[str, dict[str, Any]]:
    """Return settings by name: for an experiment with a third axis, its first variant's."""
    from roughgas import config

    loaded = config.load(options.config)
    basic = [name for name, one in loaded["experiments"].items() if "extends" not in one]
    found = {}
    for name in options.experiments or basic:
        every = config.every_variant(name, config.experiment(loaded, name, options.scale))
        first = next(iter(every))
        found[first] = every[first]
    return found
