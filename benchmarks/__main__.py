"""How fast the kernel is, and what there is besides it: one table, and a plot.

    make bench          or          python -m benchmarks [--quick]

Prints the table, and writes the page of this processor and its pictures into docs/benchmarks, and
the table of all processors, docs/benchmarks.md, in some seven minutes on two cores. With --quick
up to 10,000 particles, without the pipeline and the cost of effects, and nothing is written.
"""

import argparse
import sys
import time

from benchmarks import effects, generality, kernel, machine, machines, pipeline, plot, yardstick
from benchmarks.report import report
from benchmarks.scenes import CASES, DOCS

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
    here = machine.description()
    page, name = report(timings, plain, comparisons, costs, overhead, here), machines.name_of(here)
    print(page)
    if not quick:
        plot.draw(timings, plain, DOCS / "benchmarks" / f"{name}.png")
        effects.draw(costs, DOCS / "benchmarks" / f"{name}-effects.png")
        machines.write(DOCS, name, page, machines.summary(here, timings, plain))
    say("done")


if __name__ == "__main__":
    main()
