"""Lists of neighbours beside the cells around: layers, beds and free gases, from the same states.

    python -m benchmarks.neighbours [--runs 5]

Both run in turns on one core. Free gases are elastic and smooth; layers are those of the
study `patterns`, in a narrower box.
"""

import argparse
import math
import statistics
import time

import numpy as np

from benchmarks.scenes import ROOT, advance, present
from roughgas import config
from roughgas.kernel.memory import new_state
from roughgas.kernel.state import COLLISIONS
from roughgas.scene import build
from roughgas.scene.initial import initial_state

RUNS = 5
LAYERS = {"b": 30, "g": 30, "b, 100 D wide": 100, "g, 100 D wide": 100}  # width in D
GASES = [(3, 0.2), (3, 0.4), (2, 0.2), (2, 0.7)]  # dimension, packing
PARTICLES = 10_000
SETTLING, CYCLES = 8, 1
SETTLED, MEASURED = 10, 40  # collisions of each particle of a gas


def main() -> None:
    """Print a line for each scene."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--runs", type=int, default=RUNS)
    parser.add_argument("--scenes", nargs="+", help="of layers by their name, and `gases`")
    options = parser.parse_args()
    print("| scene | particles | lists / cells | lists | cells |\n|" + " --- |" * 5)
    for name, width in LAYERS.items():
        if name in (options.scenes or LAYERS):
            compare(f"layer {name}", *layer(name[0], width), options.runs)
    for dimension, packing in GASES:
        if "gases" in (options.scenes or ["gases"]):
            kind = "disks" if dimension == 2 else "spheres"
            compare(f"{kind}, packing {packing}", *gas(dimension, packing), options.runs)


def layer(case: str, width: float):
    """(settings, r, beta, how long to settle, how long to measure) of a layer."""
    configuration = config.load(ROOT / "config.yaml")
    found = config.experiment(configuration, f"patterns.layers/case{case}", "paper")
    changes = {"particles": 6 * width**2, "layer": {"width": width}, "observables": None}
    settings = config.fitted(config.changed_by(found, changes), "benchmark")
    period = settings["effects"]["floor"]["period"]
    return settings, 0.7, 0.35, {"time": SETTLING * period}, {"time": CYCLES * period}


def gas(dimension: int, packing: float):
    """The same of a free gas."""
    volume = math.pi if dimension == 2 else 4.0 * math.pi / 3.0
    side = (PARTICLES * volume / packing) ** (1.0 / dimension)
    settings = {
        "particles": PARTICLES,
        "box": [side] * dimension,
        "effects": {"spin": {"inertia": 0.4}},
    }
    lengths = [{"collisions": n * PARTICLES // 2} for n in (SETTLED, MEASURED)]
    return settings, 1.0, -1.0, *lengths


def compare(name, settings, r, beta, settling, measured, runs):
    """Print contacts a second of CPU time, and the median of their ratios."""
    scene = build(settings, r, beta)
    state = initial_state(scene, settings, np.random.default_rng(1))
    advance(scene, state, **settling)
    both = [scene._replace(lists=lists) for lists in (True, False)]
    rates = [[rate(one, present(scene, state), measured) for one in both] for _ in range(runs + 1)][
        1:
    ]  # the first compiles
    ratio = statistics.median(one / other for one, other in rates)
    lists, cells = (statistics.median(column) for column in zip(*rates, strict=True))
    number = settings["particles"]
    print(f"| {name} | {number:,} | {ratio:.2f} | {lists:.3g} | {cells:.3g} |", flush=True)


def rate(scene, rows, measured) -> float:
    """Contacts a second of CPU time, from a state."""
    state = new_state(scene, *rows)
    begin = time.process_time()
    advance(scene, state, **measured)
    return float(state.counts[COLLISIONS]) / (time.process_time() - begin)


if __name__ == "__main__":
    main()
