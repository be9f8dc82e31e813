"""Limits of the kernel: latency of the machine's memory, and a run for a profiler.

    python -m benchmarks.limits
        time of a read from memory, by the size of the array: of reads whose address is the result
        of the previous read, and of independent reads
    valgrind --tool=cachegrind --cache-sim=yes --branch-sim=yes --LL=33554432,16,64 \\
            python -m benchmarks.limits N COLLISIONS
        a cooling gas at packing 0.2 that makes COLLISIONS; the difference of two runs gives
        instructions, cache misses and mispredicted branches per collision, without the start-up

Valgrind lacks AVX-512: first run the same command without valgrind, in the same environment with
NUMBA_CPU_NAME=haswell NUMBA_CPU_FEATURES=+avx,+avx2,+fma,+bmi,+bmi2,+popcnt,+lzcnt,+sse4.2,+f16c
so that a kernel without AVX-512 is compiled and cached.
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
CACHE_LINE = 64  # bytes
SIZES = (2**14, 2**18, 2**21, 2**24, 2**26, 2**28)  # bytes
READS = 3_000_000


def main() -> None:
    """Print the times of reads; with two arguments, run a gas."""
    if len(sys.argv) == 3:
        run(*map(int, sys.argv[1:]))
        return
    print(f"{'kB':>10}{'waiting':>10}{'not':>8}  ns per read")
    for size in SIZES:
        dependent, independent = read_times(size)
        print(f"{size / 2**10:10.0f}{dependent:10.1f}{independent:8.1f}")


def run(number: int, collisions: int) -> None:
    """Run a gas of `number` particles from its lattice for a number of collisions."""
    experiment = settings(CASE, number)
    scene = build(experiment, CASE.r, CASE.beta)
    state = initial_state(scene, experiment, np.random.default_rng(1))
    advance(scene, state, collisions=collisions)
    print(state.counts[COLLISIONS], "collisions")


def read_times(size: int) -> tuple[float, float]:
    """Return the nanoseconds per dependent read, and per independent read, from `size` bytes.

    Reads are from different lines of the cache, in random order.
    """
    lines, rng = size // CACHE_LINE, np.random.default_rng(1)
    memory = np.zeros((lines, CACHE_LINE // 8), np.int64)
    order = rng.permutation(lines)
    memory[order, 0] = np.roll(order, -1)  # a ring through all lines
    indices = rng.integers(0, lines, READS)
    return _ns_per_read(_read_dependent, memory, READS), _ns_per_read(
        _read_independent, memory, indices
    )


def _ns_per_read(function, *arguments):
    """Return the nanoseconds per read of a function that makes READS of them."""
    function(*arguments)  # compiles, and fills the cache
    begin = time.process_time()
    function(*arguments)
    return (time.process_time() - begin) / READS * 1e9


@numba.njit
def _read_dependent(memory, reads):
    line = 0
    for _ in range(reads):
        line = memory[line, 0]
    return line


@numba.njit
def _read_independent(memory, indices):
    total = 0
    for line in indices:
        total += memory[line, 0]
    return total


if __name__ == "__main__":
    main()
