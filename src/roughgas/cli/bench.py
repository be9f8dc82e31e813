"""`roughgas bench`: how fast this machine simulates."""

from argparse import Namespace
from statistics import median
from typing import Any

from roughgas.cli.options import whole_number

HEAD = ["experiment", "r", "beta", "particles", "collisions / s", "slowest", "fastest"]
PICKS = {"collisions_per_second": median, "slowest": min, "fastest": max}


def bench(options: Namespace) -> None:
    """Measure and print the speeds of experiments."""
    from roughgas import config
    from roughgas.base.layout import as_json, columns
    from roughgas.base.machine import description

    r, beta = config.restitution(options.r), config.roughness(options.beta)
    runs = whole_number("--runs", options.runs, 1)
    found = _experiments(options)

    from roughgas.scene import build
    from roughgas.simulation.progress import Bar
    from roughgas.simulation.speed import rates_of

    speeds = []
    with Bar("bench", len(found) * (runs + 1), "runs") as bar:
        for name, settings in found.items():
            scene = build(settings, r, beta)
            rates = rates_of(scene, settings, runs, bar.advance)
            about = {"particles": settings["particles"], "dimension": len(scene.box)}
            speeds.append({"experiment": name, "r": r, "beta": beta, **about, "rates": rates})
            for key, pick in PICKS.items():
                speeds[-1][key] = pick(rates)
    machine = description()
    if options.json:
        print(as_json({"machine": machine, "speeds": speeds}))
        return
    rows = [HEAD]
    for one in speeds:
        place = [one["experiment"], f"{r:g}", f"{beta:g}", str(one["particles"])]
        rows.append([*place, *(f"{float(f'{one[key]:.3g}'):,.0f}" for key in PICKS)])
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
