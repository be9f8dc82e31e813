"""What each effect costs: added alone to the barest gas, smooth disks in a periodic box.

    python -m benchmarks.effects

Prints the table and draws docs/effects_cost.png, from the same measurement as `make bench`. All
scenes have as many particles, at the same packing where the box says what it is, and are timed in
turns, so that what else the machine does is about the same for all.
"""

import statistics
import time
from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np
from matplotlib import rc_context
from matplotlib.figure import Figure

from benchmarks import tables
from benchmarks.generality import run_kernel
from benchmarks.kernel import Counts, counts_of
from benchmarks.scenes import DOCS, SETTLING, advance
from roughgas.kernel.state import COLLISIONS
from roughgas.scene import build
from roughgas.scene.initial import initial_state
from roughgas.show.style import FAINT, LOOKS, PARAMETERS, THEORY, WIDTH, save

PARTICLES = 160
SQUARE = [50, 50]  # packing 0.2
CUBE = [14.96] * 3  # packing 0.2
WIDER = [79.06] * 2  # packing 0.2 of disks of radius 1 and 2, equally many
TWO = ({"fraction": 0.5}, {"fraction": 0.5, "radius": 2})
LENGTH = 200_000  # collisions that are timed in a run
RUNS = 15

EXPLANATION = f"""
Each effect is added alone to the barest gas, smooth disks in a periodic box; what a scene does
without is compiled away. N = {PARTICLES}, packing 0.2 (the bed finds its own), collisions
per second of CPU, medians of {RUNS} runs in turns of {LENGTH:,} collisions, with
the slowest and the fastest. `relative` is the time per collision over that of the barest gas;
`hits` of walls or floor, renewals and stale entries per collision are as above.
""".strip()


class Row(NamedTuple):
    """A scene: one effect, or what it takes to have it, added to the barest gas."""

    label: str
    effects: dict  # as in config.yaml
    box: list = SQUARE
    r: float = 1.0  # elastic, where nothing drives the gas or takes energy away
    beta: float = 1.0  # of particles that spin; the others are smooth
    species: Sequence[dict] = ()


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
    Row("+ spin, contact averages", SPIN | {"contact_averages": {}}),
    Row("+ contact time", {"contact_time": {"duration": 1e-4}}),
    Row("+ side walls", {"walls": SMOOTH}),
    Row("+ shear", {"shear": {"velocity": 2}}, r=0.9),
    Row("+ gravity and floor", BED, OPEN, 0.9),
    Row("+ gravity and floor, sine", BED | {"floor": BED["floor"] | {"wave": "sine"}}, OPEN, 0.9),
    Row("+ thermostat", {"thermostat": HEAT}, r=0.9),
    Row("+ spin, thermostat", SPIN | {"thermostat": HEAT}, r=0.9),
    Row("+ spin, thermostat, friction", SPIN | {"thermostat": HEAT, "friction": {"mu": 1}}, r=0.9),
    Row("+ third dimension", {}, box=CUBE),
    Row("+ disks twice as large, one in two", {}, box=WIDER, species=TWO),
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
    experiment |= {"species": list(row.species)} if row.species else {}
    scene = build(experiment, row.r, row.beta if "spin" in row.effects else -1.0)
    state = initial_state(scene, experiment, np.random.default_rng(1))
    advance(scene, state, time=SETTLING)
    return scene, state


def table(costs: Sequence[Cost]) -> str:
    """One row a scene."""
    heads = ["scene", "collisions/s", "slowest", "fastest", "relative"]
    heads += ["hits", "renewals", "stale"]
    rows = []
    for one in costs:
        rates = map(tables.short, (one.rate, min(one.rates), max(one.rates)))
        shares = [f"{count / one.counts.collisions:.2f}" for count in one.counts[1:]]
        rows.append([one.label, *rates, f"{statistics.median(one.relative):.2f}", *shares])
    return tables.table(heads, rows)


def draw(costs: list[Cost], output: Path) -> None:
    """One bar a scene, with the spread of its runs and its rate over that of the first."""
    with rc_context(PARAMETERS | {"ytick.minor.visible": False, "ytick.right": False}):
        figure = Figure(figsize=(WIDTH, 0.6 + 0.3 * len(costs)), layout="constrained")
        axes = figure.subplots()
        labels, rates = [one.label for one in costs], [one.rate / 1e6 for one in costs]
        low = [(one.rate - min(one.rates)) / 1e6 for one in costs]
        high = [(max(one.rates) - one.rate) / 1e6 for one in costs]
        axes.barh(
            labels,
            rates,
            xerr=(low, high),
            height=0.7,
            color=[FAINT] + [LOOKS[0].colour] * (len(costs) - 1),
            error_kw={"ecolor": THEORY, "elinewidth": 0.9, "capsize": 2},
        )
        for place, one in enumerate(costs):
            share = 1 / statistics.median(one.relative)
            axes.annotate(
                f"{share:.2f}",
                (0, place),
                xytext=(4, 0),
                textcoords="offset points",
                va="center",
                color="white",
            )
        axes.invert_yaxis()
        axes.tick_params(axis="y", length=0)
        axes.set_xlabel("million collisions per second")
        save(figure, [output])


def main() -> None:
    """Print the table, and draw."""
    costs = measure()
    print(table(costs))
    draw(costs, DOCS / "effects_cost.png")


if __name__ == "__main__":
    main()
