"""How fast the kernel is: collisions per second of CPU, on one core, for each of the scenes.

    make bench          or          python -m benchmarks [--config FILE] [--runs N]

Each scene of the configuration at r = 0.9, beta = 0 is brought to its steady state (a cooling gas
is measured while elastic), then timed several times; the table gives the median and the extremes.
"""

import argparse
import statistics
import time

import numpy as np

from roughgas import config
from roughgas.initial import initial_state
from roughgas.kernel.record import Plan, record
from roughgas.kernel.state import BOUNDARY_HITS, COLLISIONS, PREDICTIONS, STALE
from roughgas.scene import build

WARM_UP = 100  # collisions per particle
TIMED = 1000


def main():
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--config", default="config.yaml")
    parser.add_argument("--scale", default="paper")
    parser.add_argument("--runs", type=int, default=7)
    options = parser.parse_args()
    configuration = config.load(options.config)
    print(f"{'scene':26}{'N':>6}{'collisions/s':>14}{'min':>10}{'max':>10}", end="")
    print(f"{'predictions':>13}{'stale':>8}{'boundary':>10}   per collision")
    for name in configuration["experiments"]:
        experiment = config.experiment(configuration, name, options.scale)
        rates, counts = measure(experiment, options.runs)
        print(
            f"{name:26}{experiment['particles']:6d}{statistics.median(rates):14.3g}"
            f"{min(rates):10.3g}{max(rates):10.3g}{counts[PREDICTIONS] / counts[COLLISIONS]:13.2f}"
            f"{counts[STALE] / counts[COLLISIONS]:8.2f}"
            f"{counts[BOUNDARY_HITS] / counts[COLLISIONS]:10.2f}"
        )


def measure(experiment, runs):
    """Collisions per CPU second of each run, and what was counted in them."""
    cooling = experiment["schedule"]["kind"] == "cooling"
    scene = build(experiment, *((1.0, -1.0) if cooling else (0.9, 0.0)))
    state = initial_state(scene, experiment, np.random.default_rng(1))
    row = np.empty((1, 16))
    per_unit = experiment["particles"] // 2
    record(state, scene, Plan(np.inf, WARM_UP * per_unit, 0), row)
    before, rates = state.counts.copy(), []
    for _ in range(runs):
        collisions, begin = state.counts[COLLISIONS], time.process_time()
        record(state, scene, Plan(np.inf, TIMED * per_unit, 0), row)
        rates.append((state.counts[COLLISIONS] - collisions) / (time.process_time() - begin))
    return rates, state.counts - before


if __name__ == "__main__":
    main()
