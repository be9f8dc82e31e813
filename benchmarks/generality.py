"""What it costs that the kernel can do more than one scene: it beside a program that cannot.

    python -m benchmarks.generality

Both make the same collisions of the same gas, bit by bit and in turns, so that what else the
machine does is about the same for either.
"""

import functools
import statistics
import time
from typing import NamedTuple

import numpy as np

from benchmarks import handwritten
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


def main() -> None:
    """Print the table."""
    from benchmarks.report import generality_table  # which imports this file

    print(generality_table([measure(case, number) for case in CASES for number in NUMBERS]))


if __name__ == "__main__":
    main()
