"""Cost of each effect, added alone to the barest gas, smooth disks in a periodic box.

    python -m benchmarks.effects

Prints the table and draws docs/effects_cost.png, from the same measurement as `make bench`. All
scenes have the same number of particles, and in closed boxes the same packing. They are timed in
turns, so that the load of the machine is about the same for all.
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
from roughgas.scene.settings import scene_settings
from roughgas.show.style import FAINT, LINE_STYLES, PARAMETERS, THEORY, WIDTH, save

PARTICLES = 160
SQUARE_BOX = [50, 50]  # packing 0.2
CUBIC_BOX = [14.96] * 3  # packing 0.2
WIDER_BOX = [79.06] * 2  # packing 0.2 of disks of radius 1 and 2 in equal numbers
TWO_SPECIES = ({"fraction": 0.5}, {"fraction": 0.5, "radius": 2})
COLLISIONS_PER_RUN = 200_000
RUNS = 15

EXPLANATION = f"""
Each effect is added alone to the barest gas, smooth disks in a periodic box; what a scene does
without is compiled away. N = {PARTICLES}, packing 0.2 (the bed finds its own), collisions
per second of CPU, medians of {RUNS} runs in turns of {COLLISIONS_PER_RUN:,} collisions, with
the slowest and the fastest. `relative` is the time per collision over that of the barest gas;
`hits` of walls or floor, renewals and stale entries per collision are as above.
""".strip()


class Row(NamedTuple):
    """A scene: the barest gas with an effect added, and with the effects that it requires."""

    label: str
    effects: dict  # as in config.yaml
    box: list = SQUARE_BOX
    r: float = 1.0  # elastic, if there is neither drive nor dissipation
    beta: float = 1.0  # without the effect spin: -1, smooth
    species: Sequence[dict] = ()


SMOOTH_WALL = {"restitution": 1, "roughness": -1}
OPEN_BOX = [50, "open"]
SPIN = {"spin": {"inertia": 0.5}}
THERMOSTAT = {"power": 0.1, "interval": 1, "spin_share": 0}
GRAVITY_AND_FLOOR = {
    "gravity": {"acceleration": 1},
    "floor": {"amplitude": 5, "period": 1, **SMOOTH_WALL},
}
ROWS = (  # the barest gas comes first
    Row("barest gas: smooth disks", {}),
    Row("+ spin", SPIN),
    Row("+ spin, contact averages", SPIN | {"contact_averages": {}}),
    Row("+ contact time", {"contact_time": {"duration": 1e-4}}),
    Row("+ side walls", {"walls": SMOOTH_WALL}),
    Row("+ shear", {"shear": {"velocity": 2}}, r=0.9),
    Row("+ gravity and floor", GRAVITY_AND_FLOOR, OPEN_BOX, 0.9),
    Row(
        "+ gravity and floor, sine",
        GRAVITY_AND_FLOOR | {"floor": GRAVITY_AND_FLOOR["floor"] | {"wave": "sine"}},
        OPEN_BOX,
        0.9,
    ),
    Row("+ thermostat", {"thermostat": THERMOSTAT}, r=0.9),
    Row("+ spin, thermostat", SPIN | {"thermostat": THERMOSTAT}, r=0.9),
    Row(
        "+ spin, thermostat, friction",
        SPIN | {"thermostat": THERMOSTAT, "friction": {"mu": 1}},
        r=0.9,
    ),
    Row("+ third dimension", {}, box=CUBIC_BOX),
    Row("+ disks twice as large, one in two", {}, box=WIDER_BOX, species=TWO_SPECIES),
)


class Cost(NamedTuple):
    """Measurements of a scene, run by run."""

    label: str
    rates: list[float]  # collisions per second of CPU
    relative: list[float]  # time per collision, relative to the barest gas in the same round
    counts: Counts  # of all runs

    @property
    def rate(self) -> float:
        """Collisions per second in the median run."""
        return statistics.median(self.rates)


def measure(rows=ROWS, runs: int = RUNS) -> list[Cost]:
    """Time all scenes in turns, after SETTLING; return the cost of each row."""
    prepared = [prepare(row) for row in rows]
    counts_before = [counts_of(state) for _, state in prepared]
    seconds = np.empty((runs, len(rows)))
    for run in range(runs):
        for k, (scene, state) in enumerate(prepared):
            target = int(state.counts[COLLISIONS]) + COLLISIONS_PER_RUN
            begin = time.process_time()
            run_kernel(scene, state, target)
            seconds[run, k] = time.process_time() - begin
    relative = seconds / seconds[:, :1]
    costs = []
    for k, (row, (_, state)) in enumerate(zip(rows, prepared, strict=True)):
        counts = Counts(*np.subtract(counts_of(state), counts_before[k]).tolist())
        rates = (COLLISIONS_PER_RUN / seconds[:, k]).tolist()
        costs.append(Cost(row.label, rates, relative[:, k].tolist(), counts))
    return costs


def prepare(row: Row):
    """Return the scene of a row, and its state in the steady state."""
    experiment = {"particles": PARTICLES, "box": row.box, "effects": row.effects}
    experiment |= {"species": list(row.species)} if row.species else {}
    settings = scene_settings(experiment)
    scene = build(settings, row.r, row.beta if "spin" in row.effects else -1.0)
    state = initial_state(scene, settings, np.random.default_rng(1))
    advance(scene, state, time=SETTLING)
    return scene, state


def table(costs: Sequence[Cost]) -> str:
    """Return a table of the costs of all scenes."""
    head = ["scene", "collisions/s", "slowest", "fastest", "relative"]
    head += ["hits", "renewals", "stale"]
    rows = []
    for cost in costs:
        rates = map(tables.short, (cost.rate, min(cost.rates), max(cost.rates)))
        shares = [f"{count / cost.counts.collisions:.2f}" for count in cost.counts[1:]]
        rows.append([cost.label, *rates, f"{statistics.median(cost.relative):.2f}", *shares])
    return tables.table(head, rows)


def draw(costs: list[Cost], output: Path) -> None:
    """Draw the rate of each scene as a bar, with the range of its runs, and write its ratio to the
    rate of the first scene on it."""
    with rc_context(PARAMETERS | {"ytick.minor.visible": False, "ytick.right": False}):
        figure = Figure(figsize=(WIDTH, 0.6 + 0.3 * len(costs)), layout="constrained")
        axes = figure.subplots()
        labels, rates = [cost.label for cost in costs], [cost.rate / 1e6 for cost in costs]
        low = [(cost.rate - min(cost.rates)) / 1e6 for cost in costs]
        high = [(max(cost.rates) - cost.rate) / 1e6 for cost in costs]
        axes.barh(
            labels,
            rates,
            xerr=(low, high),
            height=0.7,
            color=[FAINT] + [LINE_STYLES[0].colour] * (len(costs) - 1),
            error_kw={"ecolor": THEORY, "elinewidth": 0.9, "capsize": 2},
        )
        for index, cost in enumerate(costs):
            share = 1 / statistics.median(cost.relative)
            axes.annotate(
                f"{share:.2f}",
                (0, index),
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
    """Print the table, and draw the figure."""
    costs = measure()
    print(table(costs))
    draw(costs, DOCS / "effects_cost.png")


if __name__ == "__main__":
    main()
