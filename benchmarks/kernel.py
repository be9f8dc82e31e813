"""Speed of the kernel: each scene at each number of particles, on one core, in CPU time."""

import math
import time
from typing import NamedTuple

import numpy as np

from benchmarks.scenes import Case, advance, steady
from roughgas.kernel.state import (
    BASE,
    BOUNDARY_HITS,
    COLLISIONS,
    NOW,
    PREDICTIONS,
    SPAN,
    STALE_PREDICTIONS,
    State,
)

NUMBERS = (40, 160, 1_000, 10_000, 100_000, 1_000_000)
WARM_UP = 5.0  # collisions per particle in a large box made of copies of a small one
MAX_SPANS = 1000  # of a run
MAX_TIME = 20.0  # s, of the warm-up, and approximately of all runs
MIN_COLLISIONS = 1_500_000  # in all runs
RUNS = 5


class Counts(NamedTuple):
    """Numbers of events of each kind."""

    collisions: int  # of two particles
    hits: int  # of a particle and a boundary
    renewals: int  # new predictions for a particle: it leaves its cell, a horizon, a stroke
    stale: int  # predicted collisions whose partner has changed its path


class Memory(NamedTuple):
    """Bytes per particle."""

    particles: float  # state and queue
    cells: float  # the cells' own lists
    workspace: float  # of fixed size, and of the sweep


class Timing(NamedTuple):
    """Measurements of a scene at a number of particles."""

    case: Case
    number: int
    seconds: list[float]  # of CPU, of each run
    collisions: list[int]  # of each run
    counts: Counts  # of all runs
    memory: Memory

    @property
    def rate(self) -> float:
        """Collisions per second, over all runs."""
        return sum(self.collisions) / sum(self.seconds)

    @property
    def extremes(self) -> tuple[float, float]:
        """Collisions per second of the slowest and the fastest run."""
        rates = [n / s for n, s in zip(self.collisions, self.seconds, strict=True)]
        return min(rates), max(rates)

    @property
    def cost(self) -> float:
        """Microseconds per collision."""
        return 1e6 / self.rate

    @property
    def events(self) -> float:
        """Events per second."""
        return sum(self.counts) / sum(self.seconds)


def measure(
    case: Case, number: int, runs: int = RUNS, min_collisions: int = MIN_COLLISIONS
) -> Timing:
    """Time a scene over a whole number of spans, the intervals between sortings of particles, or
    over less if that would take too long."""
    scene, state = steady(case, number)
    warm_up(scene, state)
    counts_before = counts_of(state)
    rate = counts_before.collisions / (state.clock[BASE] + state.clock[NOW])
    spans = min(math.ceil(min_collisions / (rate * state.clock[SPAN])), runs * MAX_SPANS)
    seconds, collisions = [], []
    for _ in range(runs):
        begin, collisions_before = time.process_time(), state.counts[COLLISIONS]
        advance(scene, state, time=spans * state.clock[SPAN] / runs)
        seconds.append(time.process_time() - begin)
        collisions.append(int(state.counts[COLLISIONS] - collisions_before))
        if len(seconds) > 1 and sum(seconds) > MAX_TIME:
            break
    counts = Counts(*np.subtract(counts_of(state), counts_before).tolist())
    return Timing(case, number, seconds, collisions, counts, memory_of(state))


def warm_up(scene, state) -> None:
    """Make WARM_UP collisions per particle, or fewer if these would take too long."""
    number = len(state.label)
    advance(scene, state, collisions=1)  # compiles
    begin = time.process_time()
    while state.counts[COLLISIONS] < WARM_UP * number / 2:
        advance(scene, state, collisions=max(1, number // 8))
        if time.process_time() - begin > MAX_TIME:
            break


def counts_of(state: State) -> Counts:
    """Return the numbers of events since the start.

    A collision needs two predictions, a hit or a renewal one, a stale entry none.
    """
    collisions, hits, predictions, stale = state.counts[
        [COLLISIONS, BOUNDARY_HITS, PREDICTIONS, STALE_PREDICTIONS]
    ]
    return Counts(int(collisions), int(hits), int(predictions - 2 * collisions - hits), int(stale))


def memory_of(state: State) -> Memory:
    """Return the memory of the arrays of a state."""
    number = len(state.label)
    cells = 0 if state.cells is None else state.cells.first.nbytes
    workspace = nbytes_of((state.shortlist, state.sweep))
    particles = nbytes_of(state) - cells - workspace
    return Memory(particles / number, cells / number, workspace / number)


def nbytes_of(nested) -> int:
    """Return the bytes of the arrays in nested tuples, counting shared memory once."""
    arrays = {}
    _gather(nested, arrays)
    return sum(arrays.values())


def _gather(nested, arrays):
    """Add the bytes of each array in nested tuples to `arrays`, by address."""
    if isinstance(nested, np.ndarray):
        arrays[nested.ctypes.data] = nested.nbytes
    elif isinstance(nested, tuple):
        for member in nested:
            _gather(member, arrays)
