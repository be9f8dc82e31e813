"""How fast the kernel is: each scene at each number of particles, on one core, in CPU time."""

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
    STALE,
    State,
)

NUMBERS = (40, 160, 1_000, 10_000, 100_000, 1_000_000)
WARM_UP = 5.0  # collisions per particle after a large box was made of small ones
SPANS = 1000  # that a run takes at most
LONGEST = 20.0  # seconds, of the warm-up and, about, of what is timed
LEAST = 1_500_000  # collisions that are timed
RUNS = 5


class Counts(NamedTuple):
    """Events of each kind."""

    collisions: int  # of two particles
    hits: int  # of a particle and a boundary
    renewals: int  # a particle's future is foreseen anew: it leaves its cell, a horizon, a stroke
    stale: int  # a foreseen collision whose partner has gone another way


class Memory(NamedTuple):
    """Bytes per particle."""

    particles: float  # state and queue
    cells: float  # the cells' own lists
    workspace: float  # of fixed size, or about the sweep


class Timing(NamedTuple):
    """What was measured of one scene at one size."""

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


def measure(case: Case, number: int, runs: int = RUNS, least: int = LEAST) -> Timing:
    """Time a scene over a whole number of spans, after each of which particles are sorted anew, or
    over less if that would take too long."""
    scene, state = steady(case, number)
    warm_up(scene, state)
    before = counts_of(state)
    rate = before.collisions / (state.clock[BASE] + state.clock[NOW])
    spans = min(math.ceil(least / (rate * state.clock[SPAN])), runs * SPANS)
    seconds, collisions = [], []
    for _ in range(runs):
        begin, made = time.process_time(), state.counts[COLLISIONS]
        advance(scene, state, time=spans * state.clock[SPAN] / runs)
        seconds.append(time.process_time() - begin)
        collisions.append(int(state.counts[COLLISIONS] - made))
        if len(seconds) > 1 and sum(seconds) > LONGEST:
            break
    counts = Counts(*np.subtract(counts_of(state), before).tolist())
    return Timing(case, number, seconds, collisions, counts, memory_of(state))


def warm_up(scene, state) -> None:
    """WARM_UP collisions a particle, or fewer if these would take too long."""
    number = len(state.label)
    advance(scene, state, collisions=1)  # compiles
    begin = time.process_time()
    while state.counts[COLLISIONS] < WARM_UP * number / 2:
        advance(scene, state, collisions=max(1, number // 8))
        if time.process_time() - begin > LONGEST:
            break


def counts_of(state: State) -> Counts:
    """What has happened so far. Two predictions belong to a collision, one to all else but stale
    entries, which need none."""
    made, hits, predictions, stale = state.counts[[COLLISIONS, BOUNDARY_HITS, PREDICTIONS, STALE]]
    return Counts(int(made), int(hits), int(predictions - 2 * made - hits), int(stale))


def memory_of(state: State) -> Memory:
    """What the arrays of a state take."""
    number = len(state.label)
    cells = 0 if state.cells is None else state.cells.first.nbytes
    workspace = owned((state.shortlist, state.sweep))
    particles = owned(state) - cells - workspace
    return Memory(particles / number, cells / number, workspace / number)


def owned(part) -> int:
    """Bytes in the arrays of nested tuples, counting memory that two of them share once."""
    arrays = {}
    _gather(part, arrays)
    return sum(arrays.values())


def _gather(part, arrays):
    if isinstance(part, np.ndarray):
        arrays[part.ctypes.data] = part.nbytes
    elif isinstance(part, tuple):
        for one in part:
            _gather(one, arrays)
