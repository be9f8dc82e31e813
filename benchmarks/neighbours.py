"""Speed of lists of neighbours relative to cells: layers and free gases, from the same states.

    python -m benchmarks.neighbours [--runs 5]

Both run in turns on one core. Free gases are elastic and smooth; layers are from the study
`patterns`, in a narrower box.
"""

import argparse
import math
import statistics
import time

import numpy as np

from benchmarks.scenes import ROOT, advance, present
from roughgas import config
from roughgas.kernel.layout import new_state
from roughgas.kernel.state import COLLISIONS
from roughgas.scene import build
from roughgas.scene.initial import initial_state
from roughgas.scene.settings import scene_settings

RUNS = 5
LAYERS = {"b": 30, "g": 30, "b, 100 D wide": 100, "g, 100 D wide": 100}  # width in D
GASES = [(3, 0.2), (3, 0.4), (2, 0.2), (2, 0.7)]  # dimension, packing
PARTICLES = 10_000
SETTLING, CYCLES = 8, 1
SETTLING_COLLISIONS, MEASURED_COLLISIONS = 10, 40  # per particle of a gas


def main() -> None:
    """Print a row of the table for each scene."""
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
    """Return settings, r, beta, and the times to settle and to measure, of a layer."""
    configuration = config.load(ROOT / "config.yaml")
    experiment = configuration.experiment(f"patterns.layers/case{case}", "paper")
    changes = {"particles": 6 * width**2, "layer": {"width": width}, "observables": None}
    settings = experiment.changed(changes).fitted("benchmark").raw
    period = settings["effects"]["floor"]["period"]
    return settings, 0.7, 0.35, {"time": SETTLING * period}, {"time": CYCLES * period}


def gas(dimension: int, packing: float):
    """Return settings, r, beta, and the collisions to settle and to measure, of a free gas."""
    volume = math.pi if dimension == 2 else 4.0 * math.pi / 3.0
    side = (PARTICLES * volume / packing) ** (1.0 / dimension)
    settings = {
        "particles": PARTICLES,
        "box": [side] * dimension,
        "effects": {"spin": {"inertia": 0.4}},
    }
    lengths = [
        {"collisions": n * PARTICLES // 2} for n in (SETTLING_COLLISIONS, MEASURED_COLLISIONS)
    ]
    return settings, 1.0, -1.0, *lengths


def compare(name, settings, r, beta, settling, measured, runs):
    """Print the contacts per second of CPU time with lists and cells, and their median ratio."""
    scene_values = scene_settings(settings)
    scene = build(scene_values, r, beta)
    state = initial_state(scene, scene_values, np.random.default_rng(1))
    advance(scene, state, **settling)
    variants = [scene._replace(lists=lists) for lists in (True, False)]
    rates = [
        [rate(variant, present(scene, state), measured) for variant in variants]
        for _ in range(runs + 1)
    ][1:]  # the first compiles
    ratio = statistics.median(lists_rate / cells_rate for lists_rate, cells_rate in rates)
    lists, cells = (statistics.median(column) for column in zip(*rates, strict=True))
    number = settings["particles"]
    print(f"| {name} | {number:,} | {ratio:.2f} | {lists:.3g} | {cells:.3g} |", flush=True)


def rate(scene, rows, measured) -> float:
    """Return the contacts per second of CPU time, from a state."""
    state = new_state(scene, *rows)
    begin = time.process_time()
    advance(scene, state, **measured)
    return float(state.counts[COLLISIONS]) / (time.process_time() - begin)


if __name__ == "__main__":
    main()
