"""Ratio of the speeds of the kernels of two checkouts: the same scene, in turns.

    git worktree add ../before COMMIT
    python -m benchmarks.beside ../before [--case "cooling, packing 0.2"] [--numbers 10000 100000]
    python -m benchmarks.beside ../before --gas 3 0.5 1 --numbers 10000

With --gas the scene is a smooth elastic gas: dimension, packing, and the ratio of two radii, whose
particles fill equal volumes.

Each kernel has a separate process, which makes a fixed number of collisions in each turn: the load
of the machine changes less within a second than between two runs. Prints the median and the
quartiles of the ratios of successive turns.
"""

import argparse
import inspect
import statistics
import subprocess
import sys
from pathlib import Path

from benchmarks.scenes import CASES

ROOT = Path(__file__).parent.parent
NUMBERS, CASE = (10_000, 100_000), CASES[1].title
COLLISIONS_PER_TURN, DEFAULT_TURNS = 100_000, 30


def main() -> None:
    """Print a row of the table for each number of particles."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("other", type=Path, help="a checkout of another commit")
    parser.add_argument("--case", default=CASE, choices=[case.title for case in CASES])
    parser.add_argument("--gas", nargs=3, type=float, metavar=("DIMENSION", "PACKING", "RATIO"))
    parser.add_argument("--numbers", type=int, nargs="+", default=NUMBERS)
    parser.add_argument("--turns", type=int, default=DEFAULT_TURNS)
    options = parser.parse_args()
    if not (options.other / "benchmarks").is_dir():
        parser.error(f"{options.other} is not a checkout")
    if options.turns < 2:
        parser.error(f"--turns = {options.turns}: must be 2 at least, for quartiles")
    print("| particles | ratio | quartiles | collisions/s | of the other |\n|" + " --- |" * 5)
    for number in options.numbers:
        arguments = options.gas or options.case, number, COLLISIONS_PER_TURN
        with runner(ROOT, *arguments) as ours, runner(options.other, *arguments) as theirs:
            turns = [(turn(ours), turn(theirs)) for _ in range(options.turns)]
        low, ratio, high = statistics.quantiles([a / b for a, b in turns], n=4)
        rate, other_rate = (statistics.median(column) for column in zip(*turns, strict=True))
        line = f"{number:,} | {ratio:.2f} | {low:.2f} to {high:.2f} | {rate:.3g} | {other_rate:.3g}"
        print(f"| {line} |", flush=True)


def runner(checkout: Path, *arguments: object) -> subprocess.Popen[str]:
    """Return a process that runs the kernel of a checkout, a turn for each line of input."""
    code = f"{inspect.getsource(run)}\nrun{arguments}"
    pipe = subprocess.PIPE
    return subprocess.Popen(
        [sys.executable, "-c", code], cwd=checkout, stdin=pipe, stdout=pipe, text=True
    )


def turn(process: subprocess.Popen[str]) -> float:
    """Run the next turn; return its collisions per second of CPU time."""
    print(file=process.stdin, flush=True)
    line = process.stdout.readline()
    if not line:
        raise SystemExit("a kernel has ended early: see above")
    return float(line)


def run(case: str | list[float], number: int, collisions: int) -> None:
    """Run the kernel of the checkout in the current folder: a turn for each line of input.

    `case` is the title of a Case, or dimension, packing and ratio of radii of a gas.
    """
    import math
    import sys
    import time

    import numpy as np

    sys.path[:0] = ["src", "."]
    from benchmarks.kernel import warm_up
    from benchmarks.scenes import CASES, advance, steady
    from roughgas.scene import build
    from roughgas.scene.initial import initial_state
    from roughgas.scene.settings import scene_settings

    if isinstance(case, str):
        (selected,) = [candidate for candidate in CASES if candidate.title == case]
        scene, state = steady(selected, number)
    else:
        dimension, packing, ratio = int(case[0]), case[1], case[2]
        large = max(1, round(number / (1.0 + ratio**dimension)))
        unit_sphere = math.pi if dimension == 2 else 4.0 * math.pi / 3.0
        volume = unit_sphere * (large * ratio**dimension + number - large)
        raw = {
            "particles": number,
            "box": [(volume / packing) ** (1.0 / dimension)] * dimension,
            "effects": {"spin": {"inertia": 0.4}},
        }
        if ratio != 1.0:
            raw["species"] = [{"number": large, "radius": ratio}, {"number": number - large}]
        settings = scene_settings(raw)
        scene = build(settings, 1.0, -1.0)
        state = initial_state(scene, settings, np.random.default_rng(1))
    warm_up(scene, state)
    for _ in sys.stdin:
        begin = time.process_time()
        advance(scene, state, collisions=collisions)
        print(collisions / (time.process_time() - begin), flush=True)


if __name__ == "__main__":
    main()
