"""Speed of a grid of cells for each class of sizes relative to a single grid, in mixtures.

    python -m benchmarks.sizes [--dimension 2] [--particles 5000] [--packing 0.2] [--runs 5]

Gases are elastic and smooth, of small particles and of large ones that fill equal volumes. From the
same state both grids, and the sweep, run in turns on one core.
"""

import argparse
import math
import statistics
import time

import numpy as np

from benchmarks.scenes import advance, present
from roughgas.kernel import hierarchy
from roughgas.kernel.layout import new_state
from roughgas.kernel.scheme import CELLS, SWEEP
from roughgas.kernel.state import COLLISIONS
from roughgas.scene import build
from roughgas.scene.initial import initial_state
from roughgas.scene.settings import scene_settings

RUNS = 5
RATIOS = (1.0, 2.0, 5.0, 10.0, 20.0)
SETTLING_COLLISIONS, MEASURED_COLLISIONS = 5, 10  # per particle
SCHEMES = {
    "chosen": (CELLS, None),
    "classes": (CELLS, math.inf),
    "single grid": (CELLS, 0.0),
    "sweep": (SWEEP, None),
}
"""Forced schemes, and limits of the time with classes over the time with one grid."""


def main() -> None:
    """Print a row of the table for each ratio of sizes."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--dimension", type=int, default=2)
    parser.add_argument("--particles", type=int, default=5000)
    parser.add_argument("--packing", type=float, default=0.2)
    parser.add_argument("--ratios", type=float, nargs="+", default=RATIOS)
    parser.add_argument("--runs", type=int, default=RUNS)
    parser.add_argument("--schemes", nargs="+", default=["classes", "single grid"])
    options = parser.parse_args()
    first, *others = options.schemes
    ratios = [f"{first} / {scheme}" for scheme in others]
    print("|", " | ".join(["sizes", "large", *options.schemes, *ratios]), "|")
    print("|" + " --- |" * (2 + len(options.schemes) + len(ratios)))
    for ratio in options.ratios:
        gas = mixture(options.dimension, options.particles, options.packing, ratio)
        rates = compare(gas, options.schemes, options.runs)
        medians = [statistics.median(column) for column in zip(*rates, strict=True)]
        gains = [
            statistics.median(row[0] / row[k] for row in rates) for k in range(1, len(rates[0]))
        ]
        cells = [*(f"{rate:.3g}" for rate in medians), *(f"{gain:.2f}" for gain in gains)]
        number = gas.species[0].number
        print(f"| 1 : {ratio:g} | {number} |", " | ".join(cells), "|", flush=True)


def mixture(dimension: int, particles: int, packing: float, ratio: float):
    """Return the settings of a gas whose large and small particles fill equal volumes."""
    large = max(1, round(particles / (1.0 + ratio**dimension)))
    numbers = [large, particles - large]
    volume = math.pi if dimension == 2 else 4.0 * math.pi / 3.0
    filled = volume * (numbers[0] * ratio**dimension + numbers[1])
    species = [
        {"number": number, "radius": radius}
        for number, radius in zip(numbers, (ratio, 1.0), strict=True)
    ]
    side = (filled / packing) ** (1.0 / dimension)
    return scene_settings(
        {"particles": particles, "box": [side] * dimension, "effects": {}, "species": species}
    )


def compare(gas, schemes: list[str], runs: int) -> list[list[float]]:
    """Return the collisions per second of CPU time of each scheme in each run, from one state."""
    scene = build(gas, 1.0, -1.0)
    state = initial_state(scene, gas, np.random.default_rng(1))
    advance(scene, state, collisions=SETTLING_COLLISIONS * gas.particles)
    collisions = MEASURED_COLLISIONS * gas.particles
    rates = [
        [rate(scene, state, collisions, *SCHEMES[scheme]) for scheme in schemes]
        for _ in range(runs + 1)
    ]
    return rates[1:]  # the first compiles


def rate(scene, settled, collisions: int, scheme: int, worthwhile: float | None) -> float:
    """Return the collisions per second of CPU time, from a settled state.

    `worthwhile` is the maximum of the estimated time with classes over the time with a single grid,
    None for the kernel's.
    """
    limit = hierarchy.WORTHWHILE
    hierarchy.WORTHWHILE = limit if worthwhile is None else worthwhile
    forced = scene._replace(scheme=scheme)
    state = new_state(forced, *present(scene, settled), bodies=settled.bodies)
    hierarchy.WORTHWHILE = limit
    begin = time.process_time()
    advance(scene, state, collisions=collisions)
    return float(state.counts[COLLISIONS]) / (time.process_time() - begin)


if __name__ == "__main__":
    main()
