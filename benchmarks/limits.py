"""What limits the kernel: the machine's memory, and a run to hand to a profiler.

    python -m benchmarks.limits
        time of a read from memory, by the size of what is read from: of reads that each wait for
        the one before, and of reads that need not
    valgrind --tool=cachegrind --cache-sim=yes --branch-sim=yes --LL=33554432,16,64 \\
            python -m benchmarks.limits N COLLISIONS
        a cooling gas at packing 0.2 that makes so many collisions; the difference of two runs tells
        instructions, cache misses and mispredicted branches per collision, free of the start-up

Valgrind knows no AVX-512: first run the same command without it, in the same environment with
NUMBA_CPU_NAME=haswell NUMBA_CPU_FEATURES=+avx,+avx2,+fma,+bmi,+bmi2,+popcnt,+lzcnt,+sse4.2,+f16c
so that the kernel is compiled, and kept, for a machine that it does know.
"""

import sys
import time

import numba
import numpy as np

from benchmarks.scenes import CASES, advance, settings
from roughgas.kernel.state import COLLISIONS
from roughgas.scene import build
from roughgas.scene.initial import initial_state

CASE = CASES[1]
LINE = 64  # bytes
SIZES = (2**14, 2**18, 2**21, 2**24, 2**26, 2**28)  # bytes
READS = 3_000_000


def main() -> None:
    """Print the times, or run what is asked for."""
    if len(sys.argv) == 3:
        run(*map(int, sys.argv[1:]))
        return
    print(f"{'kB':>10}{'waiting':>10}{'not':>8}  ns per read")
    for size in SIZES:
        waiting, free = read_times(size)
        print(f"{size / 2**10:10.0f}{waiting:10.1f}{free:8.1f}")


def run(number: int, collisions: int) -> None:
    """A gas of so many particles, from its lattice through so many collisions."""
    experiment = settings(CASE, number)
    scene = build(experiment, CASE.r, CASE.beta)
    state = initial_state(scene, experiment, np.random.default_rng(1))
    advance(scene, state, collisions=collisions)
    print(state.counts[COLLISIONS], "collisions")


def read_times(size: int) -> tuple[float, float]:
    """Nanoseconds of reads that wait for each other, and of reads that do not, from `size` bytes.

    Each is from a line of the cache of its own, in random order.
    """
    lines, rng = size // LINE, np.random.default_rng(1)
    memory = np.zeros((lines, LINE // 8), np.int64)
    order = rng.permutation(lines)
    memory[order, 0] = np.roll(order, -1)  # a ring through all lines
    places = rng.integers(0, lines, READS)
    return _timed(_follow, memory, READS), _timed(_gather, memory, places)


def _timed(function, *arguments):
    function(*arguments)  # compiles, and brings into the cache what fits
    begin = time.process_time()
    function(*arguments)
    return (time.process_time() - begin) / READS * 1e9


@numba.njit
def _follow(memory, reads):
    line = 0
    for _ in range(reads):
        line = memory[line, 0]
    return line


@numba.njit
def _gather(memory, places):
    total = 0
    for line in places:
        total += memory[line, 0]
    return total


if __name__ == "__main__":
    main()
