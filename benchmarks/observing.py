"""Cost of each observable of a gas, at every sample.

    python -m benchmarks.observing [--runs 5] [--gases vibrated sheared] [--observables profiles]

Runs points of the paper at its number of particles, with a shorter measurement, without observables
and with each that suits the gas. Prints the CPU time of run_point as a multiple of the time without
observables: medians over runs in turns, with compiled kernels.
"""

import argparse
import statistics
import time
from collections.abc import Callable, Iterable, Mapping
from typing import Any, NamedTuple

import numpy as np

from benchmarks.scenes import CONFIGURATION
from benchmarks.tables import table
from roughgas import config
from roughgas.base import InputError
from roughgas.observables import OBSERVABLES, Frame
from roughgas.scene import Scene, build
from roughgas.simulation.experiment import Experiment
from roughgas.simulation.experiment_reader import read_experiment
from roughgas.simulation.point import run_point

R, BETA = 0.9, 0.0
SHORTER_SCHEDULES: dict[str, dict[str, Any]] = {  # about 2000 frames
    "vibrated": {"equilibrate": 10, "measure": 100},
    "sheared": {"equilibrate": 200, "measure": 2000},
    "cooling": {"replicas": 10},
}
PLAIN, USER_FUNCTION = "(nothing)", "(a function)"
UNSUITABLE = "–"  # an observable that does not suit a gas


class Run(NamedTuple):
    """A point to be run repeatedly."""

    scene: Scene
    experiment: Experiment[Any]
    functions: Mapping[str, Callable[[Frame], Any]]

    def cpu_time(self, seed: int) -> float:
        """Run the point; return its CPU time (s).

        Raises InputError for observables that do not suit it.
        """
        begin = time.process_time()
        run_point(self.scene, self.experiment, seed, functions=self.functions)
        return time.process_time() - begin


def main() -> None:
    """Print the table, a row for each observable."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--runs", type=int, default=5)
    parser.add_argument(
        "--gases", nargs="+", choices=SHORTER_SCHEDULES, default=[*SHORTER_SCHEDULES]
    )
    parser.add_argument("--observables", nargs="+", choices=OBSERVABLES, default=[*OBSERVABLES])
    options = parser.parse_args()
    costs = {gas: costs_in(gas, options.observables, options.runs) for gas in options.gases}
    names = [
        name
        for name in (*options.observables, USER_FUNCTION)
        if any(name in c for c in costs.values())
    ]
    rows = [[name, *(ratio_text(costs[gas].get(name)) for gas in costs)] for name in names]
    print(table(["observable", *costs], rows))


def costs_in(gas: str, observables: Iterable[str], runs: int) -> dict[str, float]:
    """Return the CPU time with each suitable observable, relative to a run without observables."""
    runs_by_name = {PLAIN: run_of(gas), USER_FUNCTION: run_of(gas, functions={"energy": energy})}
    runs_by_name |= {name: run_of(gas, [name]) for name in observables}
    suitable = {name: run for name, run in runs_by_name.items() if is_suitable(run)}
    ratios: dict[str, list[float]] = {name: [] for name in suitable}
    for seed in range(1, runs + 1):
        times = {name: run.cpu_time(seed) for name, run in suitable.items()}
        for name, seconds in times.items():
            ratios[name].append(seconds / times[PLAIN])
    return {name: statistics.median(values) for name, values in ratios.items()}


def run_of(
    gas: str,
    observables: Iterable[str] = (),
    functions: Mapping[str, Callable[[Frame], Any]] | None = None,
) -> Run:
    """Return a point of an experiment of the paper, with observables in their default settings."""
    raw = config.load(CONFIGURATION).experiment(gas, "paper").raw
    changes = {
        "schedule": raw["schedule"] | SHORTER_SCHEDULES[gas],
        "observables": {name: {} for name in observables},
    }
    experiment = read_experiment(raw | changes)
    return Run(build(experiment, R, BETA), experiment, functions or {})


def is_suitable(run: Run) -> bool:
    """Return whether the observables suit the gas, after a first run, which compiles."""
    try:
        run.cpu_time(0)
    except InputError:
        return False
    return True


def energy(frame: Frame) -> np.floating[Any]:
    """Return E_trans, as a function of a user does."""
    return 0.5 * np.mean(frame.thermal_velocity**2)


def ratio_text(cost: float | None) -> str:
    """Return a ratio with two decimals; a dash for None."""
    return UNSUITABLE if cost is None else f"{cost:.2f}"


if __name__ == "__main__":
    main()
