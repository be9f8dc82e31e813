"""Costs of both schemes for candidates of contacts, and the numbers up to which a sweep costs less.

    python -m benchmarks.schemes
    python -m benchmarks.schemes --dimensions 3 --packings .2 --numbers 300 600 --ratios 1 5
    python -m benchmarks.schemes --numbers 300 600 1000 --kicks 5 30

Prints a row for each gas: contacts per second of CPU time by the sweep and in cells, each relative
to the faster, and the scheme that the kernel chooses; then the break-even numbers for the tables of
kernel/scheme.py. The schemes run in turns, from the same state of a smooth elastic gas. At a ratio
of radii other than 1 small and large particles fill equal volumes. With kicks a thermostat kicks
each particle so many times, weakly, between two of its contacts.
"""

import argparse
import itertools
import math
import statistics
import time
from typing import NamedTuple

import numpy as np

from benchmarks.scenes import advance, present
from benchmarks.sizes import mixture
from roughgas.kernel.layout import new_state
from roughgas.kernel.scheme import CELLS, CHEAPEST, PACKINGS, SWEEP
from roughgas.kernel.state import COLLISIONS, State
from roughgas.scene import Scene, build
from roughgas.scene.initial import initial_state
from roughgas.scene.settings import scene_settings

NUMBERS = (300, 600, 1000, 3000, 10_000)
RATIOS, KICKS = (1.0,), (0,)
DIMENSIONS = (2, 3)
TURNS, SECONDS = 5, 0.2  # of CPU time for a turn of a scheme
SETTLING = 3  # contacts per particle, before
WEAK = 1e-12  # power of kicks, in m a^2/T^3: the gas hardly heats up
COLLISIONS_AT_ONCE = 300
TOLERANCE = 1.1  # of the chosen scheme's cost over the cheaper scheme's


class Gas(NamedTuple):
    """A smooth elastic gas in a periodic box; at a `ratio` of radii large particles fill half."""

    dimension: int
    ratio: float
    kicks: float  # per contact of a particle
    packing: float
    number: int

    def scene(self):
        """Return scene and settings of the gas."""
        if self.ratio != 1.0:
            settings = mixture(self.dimension, self.number, self.packing, self.ratio)
            return build(settings, 1.0, -1.0), settings
        unit_sphere = math.pi if self.dimension == 2 else 4.0 * math.pi / 3.0
        density = self.packing / unit_sphere
        side = (self.number / density) ** (1.0 / self.dimension)
        effects = {"thermostat": self.thermostat(density)} if self.kicks else {}
        raw = {"particles": self.number, "box": [side] * self.dimension, "effects": effects}
        settings = scene_settings(raw)
        return build(settings, 1.0, -1.0), settings

    def thermostat(self, density):
        """Return the settings of a thermostat with this number of kicks per contact.

        The contacts of a particle are those of a dilute gas in which each component of the velocity
        has the variance 1, in a^2/T^2. A particle is kicked twice per interval: as the first one,
        and as a partner.
        """
        contacts = 2.0**self.dimension * math.sqrt(math.pi) * density  # per T
        return {"power": WEAK, "spin_share": 0, "interval": 2.0 / (self.kicks * contacts)}


def main() -> None:
    """Print the table of costs, and the break-even numbers."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--dimensions", type=int, nargs="+", default=DIMENSIONS)
    parser.add_argument("--packings", type=float, nargs="+", default=PACKINGS)
    parser.add_argument("--numbers", type=int, nargs="+", default=NUMBERS)
    parser.add_argument("--ratios", type=float, nargs="+", default=RATIOS)
    parser.add_argument("--kicks", type=float, nargs="+", default=KICKS)
    options = parser.parse_args()
    print(
        "| D | ratio | kicks | packing | N | sweep | cells | chosen | its cost |\n|" + " --- |" * 9
    )
    break_evens, worst = [], 0.0
    axes = options.dimensions, options.ratios, options.kicks, options.packings
    for dimension, ratio, kicks, packing in itertools.product(*axes):
        costs = {}
        for number in options.numbers:
            sweep, cells, chosen = measure(Gas(dimension, ratio, kicks, packing, number))
            costs[number] = cells / sweep
            excess = (sweep if chosen == SWEEP else cells) / min(sweep, cells)
            worst = max(worst, excess)
            name = "sweep" if chosen == SWEEP else "cells"
            print(
                f"| {dimension} | {ratio:g} | {kicks:g} | {packing:g} | {number:,} "
                f"| {1 / sweep:.3g} | {1 / cells:.3g} | {name} | {excess:.2f} |",
                flush=True,
            )
        break_evens.append((dimension, ratio, kicks, packing, break_even_of(costs)))
    print("\n| D | ratio | kicks | packing | a sweep costs less up to N |\n|" + " --- |" * 5)
    for row in break_evens:
        print("| " + " | ".join(f"{entry:.3g}" for entry in row) + " |")
    print(f"\nThe chosen scheme costs at most {worst:.2f} of the cheaper; limit {TOLERANCE}.")


def measure(gas: Gas) -> tuple[float, float, int]:
    """Return median CPU seconds per contact of the sweep and of cells, and the chosen scheme."""
    scene, settings = gas.scene()
    state = initial_state(scene, settings, np.random.default_rng(1))
    advance(scene, state, collisions=SETTLING * gas.number)
    rows = rows_of(scene, state)
    states = [
        new_state(scene._replace(scheme=forced), *rows[:3], bodies=rows[3])
        for forced in (SWEEP, CELLS)
    ]
    costs = [[cost(scene, variant) for variant in states] for _ in range(TURNS + 1)][1:]
    default = new_state(scene._replace(scheme=CHEAPEST), *rows[:3], bodies=rows[3])
    sweep, cells = (statistics.median(column) for column in zip(*costs, strict=True))
    return sweep, cells, SWEEP if default.cells is None else CELLS


def rows_of(scene: Scene, state: State):
    """Return positions, velocities, spins and bodies of all particles, at the present."""
    return *present(scene, state), state.bodies


def cost(scene: Scene, state: State) -> float:
    """Return the CPU seconds per contact over SECONDS of CPU time."""
    before, begin = int(state.counts[COLLISIONS]), time.process_time()
    while (elapsed := time.process_time() - begin) < SECONDS:
        advance(scene, state, collisions=max(len(state.changes) // 4, COLLISIONS_AT_ONCE))
    return elapsed / (int(state.counts[COLLISIONS]) - before)


def break_even_of(costs: dict[int, float]) -> float:
    """Return N where the cost of cells over that of the sweep passes 1, on logarithmic scales.

    The costs are fitted by a straight line, weighted towards 1. NaN for a single number.
    """
    if len(costs) < 2:
        return math.nan
    numbers, ratios = np.log(list(costs)), np.log(list(costs.values()))
    slope, value = np.polyfit(numbers, ratios, 1, w=1.0 / (0.2 + abs(ratios)))
    return math.exp(-value / slope)


if __name__ == "__main__":
    main()
