"""`roughgas bench`: how fast this machine simulates."""

from argparse import Namespace
from collections.abc import Callable, Sequence
from statistics import median
from typing import Any

from roughgas import config
from roughgas.base.layout import as_json, columns
from roughgas.base.machine import description
from roughgas.cli.options import whole_number
from roughgas.scene import build
from roughgas.simulation.progress import Bar
from roughgas.simulation.speed import rates_of

HEAD = ["experiment", "r", "beta", "particles", "collisions / s", "slowest", "fastest"]
PICKS: dict[str, Callable[[Sequence[float]], float]] = {
    "collisions_per_second": median,
    "slowest": min,
    "fastest": max,
}


def bench(options: Namespace) -> None:
    """Measure and print the speeds of experiments."""
    r, beta = config.restitution(options.r), config.roughness(options.beta)
    runs = whole_number("--runs", options.runs, 1)
    loaded = config.load(options.config)
    found: dict[str, dict[str, Any]] = {}
    basic = [name for name, one in loaded["experiments"].items() if "extends" not in one]
    for name in options.experiments or basic:
        settings = config.experiment(loaded, name, options.scale)
        found |= list(config.every_variant(name, settings).items())[:1]  # of a third axis, one
    speeds, rows = [], [HEAD]
    with Bar("bench", len(found) * (runs + 1), "runs") as bar:
        for name, settings in found.items():
            scene, number = build(settings, r, beta), settings["particles"]
            rates = rates_of(scene, settings, runs, bar.advance)
            picked = {key: pick(rates) for key, pick in PICKS.items()}
            about = {"experiment": name, "r": r, "beta": beta, "particles": number}
            speeds.append(about | {"dimension": len(scene.box), "rates": rates} | picked)
            shown = [f"{float(f'{rate:.3g}'):,.0f}" for rate in picked.values()]
            rows.append([name, f"{r:g}", f"{beta:g}", str(number), *shown])
    machine = description()
    if options.json:
        print(as_json({"machine": machine, "speeds": speeds}))
    else:
        print(f"{columns(rows, numbers=True)}\n\n{columns(machine.items())}")
