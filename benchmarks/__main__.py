"""How fast the kernel is, and what there is besides it: one table, and a plot.

    make bench          or          python -m benchmarks [--quick]

Prints the table, and writes docs/benchmarks.md, docs/benchmarks.png and docs/effects_cost.png, in
less than ten minutes on two cores. With --quick up to 10,000 particles, without the pipeline and
the cost of effects, and nothing is written.
"""

import argparse
import sys
import time

from benchmarks import effects, generality, kernel, machine, pipeline, plot, yardstick
from benchmarks.report import report
from benchmarks.scenes import CASES, DOCS
from roughgas.base.files import write_text

QUICK = 10_000  # particles at most


def main() -> None:
    """Measure, print, write."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--quick", action="store_true", help="few particles; write nothing")
    quick = parser.parse_args().quick
    begin = time.perf_counter()

    def say(what):
        print(f"{time.perf_counter() - begin:6.0f} s  {what}", file=sys.stderr, flush=True)

    numbers = [n for n in kernel.NUMBERS if not quick or n <= QUICK]
    plain, comparisons, timings, costs, overhead = [], [], [], [], None
    if not quick:
        say("start-up of a job, and the pipeline")
        overhead = pipeline.measure()
        say("effects, one by one")
        costs = effects.measure()
    for number in yardstick.NUMBERS:
        say(f"yardstick, N = {number}")
        plain.append(yardstick.measure(number))
    for case in generality.CASES:
        for number in generality.NUMBERS:
            say(f"the kernel beside a program by hand, {case.title}, N = {number}")
            comparisons.append(generality.measure(case, number))
    for case in CASES:
        for number in numbers:
            say(f"{case.title}, N = {number}")
            timings.append(kernel.measure(case, number))
    page = report(timings, plain, comparisons, costs, overhead, machine.description())
    print(page)
    if not quick:
        write_text(DOCS / "benchmarks.md", page)
        plot.draw(timings, plain, DOCS / "benchmarks.png")
        effects.draw(costs, DOCS / "effects_cost.png")
    say("done")


if __name__ == "__main__":
    main()
