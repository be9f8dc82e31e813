"""Cost of the generality of the kernel: its speed relative to a program for a single scene.

    python -m benchmarks.generality

Both compute the same collisions of the same gas, with the same bits. They run in turns, so that the
load of the machine is about the same for both.
"""

import functools
import statistics
import time
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from benchmarks import handwritten, tables
from benchmarks.scenes import Case, advance, settings
from roughgas.kernel.state import COLLISIONS
from roughgas.scene import build
from roughgas.scene.initial import initial_state

# Rough and elastic: spins change, but temperature and density stay homogeneous
CASES = (Case("packing 0.05", "cooling", 1.0, 1.0), Case("packing 0.2", "cooling", 1.0, 1.0, 0.5))
NUMBERS = (40, 160)
WARM_UP = 100  # collisions per particle
COLLISIONS_PER_RUN = 400_000
RUNS = 7

EXPLANATION = f"""
The kernel takes scenes of any composition. `benchmarks/handwritten.py` is its algorithm written by
hand for one scene alone, a gas of rough disks in a periodic box, and makes the same collisions to
the last bit. CPU time of the kernel over that of the program by hand, medians of {RUNS}
runs in turns of {COLLISIONS_PER_RUN:,} collisions, with the lowest and the highest: 1 is no cost at
all, below 1 the kernel is the faster one. The kernel always keeps an account of the energy that
collisions dissipate; by hand it can be left out. The gases are elastic and perfectly rough.
""".strip()


class Comparison(NamedTuple):
    """Seconds of CPU time of each program for the same collisions, run by run."""

    case: Case
    number: int
    kernel: list[float]
    by_hand: list[float]
    without_account: list[float]  # by hand, without the account of the energy of collisions


def rate(seconds: list[float]) -> float:
    """Return the collisions per second in the median run."""
    return COLLISIONS_PER_RUN / statistics.median(seconds)


def ratios(seconds: list[float], reference: list[float]) -> list[float]:
    """Return the ratios of the times of successive runs, in ascending order."""
    return sorted(a / b for a, b in zip(seconds, reference, strict=True))


def measure(case: Case, number: int, runs: int = RUNS) -> Comparison:
    """Run the three programs in turns, `runs` times, and return their times.

    Raises RuntimeError if their results are not bit-identical.
    """
    scene, state, gases = same_gas(settings(case, number), case.r, case.beta)
    programs = [functools.partial(run_kernel, scene, state)]
    programs += [functools.partial(handwritten.run, gas) for gas in gases]
    target = WARM_UP * number
    for program in programs:
        program(target)  # compiles
    seconds = [], [], []
    for run in range(runs):
        target += COLLISIONS_PER_RUN
        for position in range(len(programs)):
            turn = (run + position) % len(programs)  # each program is the first in some runs
            begin = time.process_time()
            programs[turn](target)
            seconds[turn].append(time.process_time() - begin)
    if not all(agree(state, gas) for gas in gases):
        raise RuntimeError(f"{case.title}, N = {number}: the programs disagree")
    return Comparison(case, number, *seconds)


def same_gas(experiment, r: float, beta: float):
    """Return scene and state of a gas for the kernel, and the gas for the program by hand, with and
    without an energy account."""
    scene = build(experiment, r, beta)
    state = initial_state(scene, experiment, np.random.default_rng(1))
    start = state.trajectory, state.spin, scene.box, r, beta, scene.effects.spin.inertia
    return scene, state, [handwritten.gas(*start, has_account) for has_account in (True, False)]


def run_kernel(scene, state, target: int) -> None:
    """Run the kernel until `target` collisions in total; a call of `advance` may stop earlier."""
    while state.counts[COLLISIONS] < target:
        advance(scene, state, collisions=int(target - state.counts[COLLISIONS]))


def agree(state, gas) -> bool:
    """Return whether both have made the same number of collisions, with bit-identical paths and
    spins."""
    return (
        state.counts[COLLISIONS] == gas.counts[handwritten.COLLISIONS_MADE]
        and np.array_equal(state.trajectory, gas.path)
        and np.array_equal(state.spin[:, 0], gas.spin)
        and np.array_equal(state.changes, gas.changes)
    )


def table(comparisons: Sequence[Comparison]) -> str:
    """Return a table with a row for each scene and number of particles."""
    head = ["gas", "N", "kernel, collisions/s", "by hand", "time, kernel / by hand"]
    head += ["lowest", "highest", "the same without account", "lowest", "highest"]
    rows = []
    for comparison in comparisons:
        row = [comparison.case.title, f"{comparison.number:,}"]
        row += [tables.short(rate(seconds)) for seconds in (comparison.kernel, comparison.by_hand)]
        for reference in (comparison.by_hand, comparison.without_account):
            sorted_ratios = ratios(comparison.kernel, reference)
            row += [
                f"{x:.3f}"
                for x in (statistics.median(sorted_ratios), sorted_ratios[0], sorted_ratios[-1])
            ]
        rows.append(row)
    return tables.table(head, rows)


def main() -> None:
    """Print the table."""
    print(table([measure(case, number) for case in CASES for number in NUMBERS]))


if __name__ == "__main__":
    main()
