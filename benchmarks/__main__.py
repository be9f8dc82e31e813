"""Speed of the kernel and cost of the rest of the program: tables and plots.

    make bench          or          python -m benchmarks [--quick]

Prints the tables, writes the page of this processor with its pictures into docs/benchmarks, and
updates the table of all processors, docs/benchmarks.md. Takes some seven minutes on two cores.
With --quick there are at most 10,000 particles, no pipeline and no effects, and nothing is written.
"""

import argparse
import sys
import time

from benchmarks import effects, generality, kernel, machine, machines, pipeline, plot, yardstick
from benchmarks.report import report
from benchmarks.scenes import CASES, DOCS

MAX_QUICK_PARTICLES = 10_000


def main() -> None:
    """Run all benchmarks, print the page, and write it unless --quick."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--quick", action="store_true", help="few particles; write nothing")
    quick = parser.parse_args().quick
    begin = time.perf_counter()

    def log(message):
        print(f"{time.perf_counter() - begin:6.0f} s  {message}", file=sys.stderr, flush=True)

    numbers = [n for n in kernel.NUMBERS if not quick or n <= MAX_QUICK_PARTICLES]
    plain, comparisons, timings, costs, overhead = [], [], [], [], None
    if not quick:
        log("start-up of a job, and the pipeline")
        overhead = pipeline.measure()
        log("effects, one by one")
        costs = effects.measure()
    for number in yardstick.NUMBERS:
        log(f"yardstick, N = {number}")
        plain.append(yardstick.measure(number))
    for case in generality.CASES:
        for number in generality.NUMBERS:
            log(f"the kernel beside a program by hand, {case.title}, N = {number}")
            comparisons.append(generality.measure(case, number))
    for case in CASES:
        for number in numbers:
            log(f"{case.title}, N = {number}")
            timings.append(kernel.measure(case, number))
    machine_description = machine.description()
    page, name = (
        report(timings, plain, comparisons, costs, overhead, machine_description),
        machines.name_of(machine_description),
    )
    print(page)
    if not quick:
        plot.draw(timings, plain, DOCS / "benchmarks" / f"{name}.png")
        effects.draw(costs, DOCS / "benchmarks" / f"{name}-effects.png")
        machines.write(DOCS, name, page, machines.summary(machine_description, timings, plain))
    log("done")


if __name__ == "__main__":
    main()
