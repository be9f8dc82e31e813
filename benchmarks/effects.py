"""What each effect costs: added alone to the barest gas, smooth disks in a periodic box.

    python -m benchmarks.effects

Prints the table and draws docs/effects_cost.png, from the same measurement as `make bench`. All
scenes have as many particles, at the same packing where the box says what it is, and are timed in
turns, so that what else the machine does is about the same for all.
"""

import statistics
import time
from typing import NamedTuple

import numpy as np

from benchmarks.generality import run_kernel
from benchmarks.kernel import Counts, counts_of
from benchmarks.scenes import DOCS, SETTLING, advance
from roughgas.kernel.state import COLLISIONS
from roughgas.scene import build
from roughgas.scene.initial import initial_state

PARTICLES = 160
SQUARE = [50, 50]  # packing 0.2
CUBE = [14.96] * 3  # packing 0.2
LENGTH = 200_000  # collisions that are timed in a run
RUNS = 15


class Row(NamedTuple):
    """A scene: one effect, or what it takes to have it, added to the barest gas."""

    label: str
    effects: dict  # as in config.yaml
    box: list = SQUARE
    r: float = 1.0  # elastic, where nothing drives the gas or takes energy away
    beta: float = 1.0  # of particles that spin; the others are smooth


SMOOTH = {"restitution": 1, "roughness": -1}
OPEN = [50, "open"]
SPIN = {"spin": {"inertia": 0.5}}
HEAT = {"power": 0.1, "interval": 1, "spin_share": 0}
BED = {
    "gravity": {"acceleration": 1},
    "floor": {"amplitude": 5, "period": 1, **SMOOTH},
}
ROWS = (  # the barest gas comes first
    Row("barest gas: smooth disks", {}),
    Row("+ spin", SPIN),
    Row("+ contact time", {"contact_time": {"duration": 1e-4}}),
    Row("+ side walls", {"walls": SMOOTH}),
    Row("+ shear", {"shear": {"velocity": 2}}, r=0.9),
    Row("+ gravity and floor", BED, OPEN, 0.9),
    Row("+ gravity and floor, sine", BED | {"floor": BED["floor"] | {"wave": "sine"}}, OPEN, 0.9),
    Row("+ thermostat", {"thermostat": HEAT}, r=0.9),
    Row("+ spin, thermostat", SPIN | {"thermostat": HEAT}, r=0.9),
    Row("+ spin, thermostat, friction", SPIN | {"thermostat": HEAT, "friction": {"mu": 1}}, r=0.9),
    Row("+ third dimension", {}, box=CUBE),
)


class Cost(NamedTuple):
    """What was measured of one scene, run by run."""

    label: str
    rates: list[float]  # collisions per second of CPU
    relative: list[float]  # time per collision over that of the barest gas in the same round
    counts: Counts  # of all runs

    @property
    def rate(self) -> float:
        """Collisions per second in the median run."""
        return statistics.median(self.rates)


def measure(rows=ROWS, runs: int = RUNS) -> list[Cost]:
    """Time all scenes in turns, after SETTLING; one cost a row."""
    prepared = [prepare(row) for row in rows]
    before = [counts_of(state) for _, state in prepared]
    seconds = np.empty((runs, len(rows)))
    for run in range(runs):
        for k, (scene, state) in enumerate(prepared):
            target = int(state.counts[COLLISIONS]) + LENGTH
            begin = time.process_time()
            run_kernel(scene, state, target)
            seconds[run, k] = time.process_time() - begin
    relative = seconds / seconds[:, :1]
    costs = []
    for k, (row, (_, state)) in enumerate(zip(rows, prepared, strict=True)):
        counts = Counts(*np.subtract(counts_of(state), before[k]).tolist())
        rates = (LENGTH / seconds[:, k]).tolist()
        costs.append(Cost(row.label, rates, relative[:, k].tolist(), counts))
    return costs


def prepare(row: Row):
    """(scene, state) of a row, in the steady state."""
    experiment = {"particles": PARTICLES, "box": row.box, "effects": row.effects}
    scene = build(experiment, row.r, row.beta if "spin" in row.effects else -1.0)
    state = initial_state(scene, experiment, np.random.default_rng(1))
    advance(scene, state, time=SETTLING)
    return scene, state


def main() -> None:
    """Print the table, and draw."""
    from benchmarks import plot, report  # which import this file

    costs = measure()
    print(report.effects_table(costs))
    plot.draw_effects(costs, DOCS / "effects_cost.png")


if __name__ == "__main__":
    main()
