"""What it costs that the kernel can do more than one scene: it beside a program that cannot.

    python -m benchmarks.generality

Both make the same collisions of the same gas, bit by bit and in turns, so that what else the
machine does is about the same for either.
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

# Rough and elastic: spins turn, and the gas stays as hot and as dense everywhere
CASES = (Case("packing 0.05", "cooling", 1.0, 1.0), Case("packing 0.2", "cooling", 1.0, 1.0, 0.5))
NUMBERS = (40, 160)
WARM_UP = 100  # collisions per particle
LENGTH = 400_000  # collisions that are timed in a run
RUNS = 7

EXPLANATION = f"""
The kernel takes scenes of any composition. `benchmarks/handwritten.py` is its algorithm written by
hand for one scene alone, a gas of rough disks in a periodic box, and makes the same collisions to
the last bit. CPU time of the kernel over that of the program by hand, medians of {RUNS}
runs in turns of {LENGTH:,} collisions, with the lowest and the highest: 1 is no cost at
all, below 1 the kernel is the faster one. The kernel always keeps an account of the energy that
collisions dissipate; by hand it can be left out. The gases are elastic and perfectly rough.
""".strip()


class Comparison(NamedTuple):
    """Seconds of CPU that each program takes for the same collisions, run by run."""

    case: Case
    number: int
    kernel: list[float]
    by_hand: list[float]
    without_books: list[float]  # by hand, and without the energy account of the collisions


def rate(seconds: list[float]) -> float:
    """Collisions per second in the median run."""
    return LENGTH / statistics.median(seconds)


def ratios(seconds: list[float], beside: list[float]) -> list[float]:
    """Of runs that followed each other, in ascending order."""
    return sorted(a / b for a, b in zip(seconds, beside, strict=True))


def measure(case: Case, number: int, runs: int = RUNS) -> Comparison:
    """Run the three in turns, so many times; RuntimeError where their results differ by a bit."""
    scene, state, gases = same_gas(settings(case, number), case.r, case.beta)
    programs = [functools.partial(run_kernel, scene, state)]
    programs += [functools.partial(handwritten.run, gas) for gas in gases]
    target = WARM_UP * number
    for program in programs:
        program(target)  # compiles
    seconds = [], [], []
    for run in range(runs):
        target += LENGTH
        for k in range(len(programs)):
            which = (run + k) % len(programs)  # none is always the first
            begin = time.process_time()
            programs[which](target)
            seconds[which].append(time.process_time() - begin)
    if not all(agree(state, gas) for gas in gases):
        raise RuntimeError(f"{case.title}, N = {number}: the programs disagree")
    return Comparison(case, number, *seconds)


def same_gas(experiment, r: float, beta: float):
    """(scene, state) of the kernel, and the same by hand, with and without energy account."""
    scene = build(experiment, r, beta)
    state = initial_state(scene, experiment, np.random.default_rng(1))
    start = state.trajectory, state.spin, scene.box, r, beta, scene.effects.spin.inertia
    return scene, state, [handwritten.gas(*start, books) for books in (True, False)]


def run_kernel(scene, state, target: int) -> None:
    """Until so many collisions have been made in all; `advance` waits only so long for them."""
    while state.counts[COLLISIONS] < target:
        advance(scene, state, collisions=int(target - state.counts[COLLISIONS]))


def agree(state, gas) -> bool:
    """Whether after as many collisions all paths and spins are the same, to the last bit."""
    return (
        state.counts[COLLISIONS] == gas.counts[handwritten.MADE]
        and np.array_equal(state.trajectory, gas.path)
        and np.array_equal(state.spin[:, 0], gas.spin)
        and np.array_equal(state.changes, gas.changes)
    )


def table(comparisons: Sequence[Comparison]) -> str:
    """One row a scene and size."""
    heads = ["gas", "N", "kernel, collisions/s", "by hand", "time, kernel / by hand"]
    heads += ["lowest", "highest", "the same without account", "lowest", "highest"]
    rows = []
    for one in comparisons:
        row = [one.case.title, f"{one.number:,}"]
        row += [tables.short(rate(seconds)) for seconds in (one.kernel, one.by_hand)]
        for beside in (one.by_hand, one.without_books):
            found = ratios(one.kernel, beside)
            row += [f"{x:.3f}" for x in (statistics.median(found), found[0], found[-1])]
        rows.append(row)
    return tables.table(heads, rows)


def main() -> None:
    """Print the table."""
    print(table([measure(case, number) for case in CASES for number in NUMBERS]))


if __name__ == "__main__":
    main()
