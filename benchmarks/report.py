"""What was measured, as Markdown: for the terminal and for docs/benchmarks.md."""

import statistics
from collections.abc import Iterable, Sequence

from benchmarks import effects, generality
from benchmarks.effects import Cost
from benchmarks.generality import Comparison
from benchmarks.kernel import LONGEST, RUNS, WARM_UP, Timing
from benchmarks.yardstick import Rate

REFERENCE = 160  # particles: what costs are relative to
OVERHEAD = (  # of benchmarks.pipeline: key, words, format
    ("job_cpu", "start-up of a job: CPU besides its kernel (s)", ".2f"),
    ("job_wall", "start-up of a job: wall time besides its kernel (s)", ".2f"),
    ("pipeline_points", "pipeline: points of the sweep", ".0f"),
    ("pipeline_kernel", "pipeline: kernel time (s)", ".1f"),
    ("pipeline_wall", "pipeline: wall time on two cores (s)", ".1f"),
    ("pipeline_efficiency", "pipeline: kernel time / (2 x wall time)", ".2f"),
)
EXPLANATION = f"""
Collisions per second of CPU on one core, over {RUNS} runs, with the slowest and the fastest of
them. Runs begin in the steady state; a box of more than a thousand particles is made of copies of
a smaller one, each kicked at random, and then makes {WARM_UP:g} collisions per particle. The runs
together last for a whole number of the intervals after which particles are sorted anew. Among a
million particles the way to the first run, and the runs, are cut short after some {LONGEST:g} s.

An event is a collision, a hit of a boundary, a renewal (a particle's future is foreseen anew, since
it leaves its cell or comes to the end of what it has foreseen) or a stale entry (a contact whose
partner has gone another way by then); the columns count them per collision. `relative` is the cost
of a collision over that at N = {REFERENCE} in the same scene; `x plain` is the rate over that of
the yardstick at N = {REFERENCE}. The last columns are bytes per particle: state and queue; the
cells' own lists; workspace, which is of fixed size but for the few that are swept.

Density, shear rate and depth of the bed are those of config.yaml at any N; the second cooling gas
is four times as dense. The cooling gases are smooth and elastic, so that they stay homogeneous; the
driven ones have r = 0.9, beta = 0.
""".strip()
YARDSTICK = """
Rough disks by the plainest compiled loop (`benchmarks/yardstick.py`), medians: ratios to it survive
a change of machine.
""".strip()

GENERALITY = f"""
The kernel takes scenes of any composition. `benchmarks/handwritten.py` is its algorithm written by
hand for one scene alone, a gas of rough disks in a periodic box, and makes the same collisions to
the last bit. CPU time of the kernel over that of the program by hand, medians of {generality.RUNS}
runs in turns of {generality.LENGTH:,} collisions, with the lowest and the highest: 1 is no cost at
all, below 1 the kernel is the faster one. The kernel always keeps an account of the energy that
collisions dissipate; by hand it can be left out. The gases are elastic and perfectly rough.
""".strip()

EFFECTS = f"""
Each effect is added alone to the barest gas, smooth disks in a periodic box; what a scene does
without is compiled away. N = {effects.PARTICLES}, packing 0.2 (the bed finds its own), collisions
per second of CPU, medians of {effects.RUNS} runs in turns of {effects.LENGTH:,} collisions, with
the slowest and the fastest. `relative` is the time per collision over that of the barest gas;
`hits` of walls or floor, renewals and stale entries per collision are as above.
""".strip()


def report(timings, yardstick, comparisons, costs, overhead, machine) -> str:
    """The whole page."""
    parts = [
        "# Benchmarks",
        "Written by `make bench`.",
        table(["", "machine"], machine.items()),
        "## The kernel",
        "![Cost per collision against the number of particles](benchmarks.png)",
        kernel_table(timings, yardstick),
        EXPLANATION,
        "## The yardstick",
        YARDSTICK,
        yardstick_table(yardstick),
        "## What generality costs",
        GENERALITY,
        generality_table(comparisons),
    ]
    if costs:
        parts += ["## What each effect costs", "![Collisions per second with each effect]"]
        parts[-1] += "(effects_cost.png)"
        parts += [effects_table(costs), EFFECTS]
    if overhead:
        rows = [(words, format(overhead[key], form)) for key, words, form in OVERHEAD]
        parts += ["## The pipeline", table(["", "measured"], rows)]
    return "\n\n".join(parts) + "\n"


def kernel_table(timings: Sequence[Timing], yardstick: Sequence[Rate]) -> str:
    """One row a scene and size."""
    heads = ["scene", "N", "collisions/s", "slowest", "fastest", "events/s", "µs/collision"]
    heads += ["relative", "x plain", "hits", "renewals", "stale", "B state", "B cells", "B work"]
    reference = {one.case: one.cost for one in timings if one.number == REFERENCE}
    plain = next((one.median for one in yardstick if one.number == REFERENCE), float("nan"))
    rows = []
    for one in timings:
        low, high = one.extremes
        rows.append(
            [one.case.title, f"{one.number:,}", *map(_short, (one.rate, low, high, one.events))]
            + [f"{one.cost:.2f}", f"{one.cost / reference.get(one.case, float('nan')):.2f}"]
            + [f"{one.rate / plain:.1f}"]
            + [f"{count / one.counts.collisions:.2f}" for count in one.counts[1:]]
            + [f"{size:.0f}" for size in one.memory]
        )
    return table(heads, rows)


def yardstick_table(yardstick: Sequence[Rate]) -> str:
    """One row a size."""
    rows = [
        (f"{one.number:,}", *map(_short, (one.median, min(one.rates), max(one.rates))))
        for one in yardstick
    ]
    return table(["N", "collisions/s", "slowest", "fastest"], rows)


def generality_table(comparisons: Sequence[Comparison]) -> str:
    """One row a scene and size."""
    heads = ["gas", "N", "kernel, collisions/s", "by hand", "time, kernel / by hand"]
    heads += ["lowest", "highest", "the same without account", "lowest", "highest"]
    rows = []
    for one in comparisons:
        row = [one.case.title, f"{one.number:,}"]
        row += [_short(generality.rate(seconds)) for seconds in (one.kernel, one.by_hand)]
        for beside in (one.by_hand, one.without_books):
            found = generality.ratios(one.kernel, beside)
            row += [f"{x:.3f}" for x in (statistics.median(found), found[0], found[-1])]
        rows.append(row)
    return table(heads, rows)


def effects_table(costs: Sequence[Cost]) -> str:
    """One row a scene."""
    heads = ["scene", "collisions/s", "slowest", "fastest", "relative"]
    heads += ["hits", "renewals", "stale"]
    rows = []
    for one in costs:
        rates = map(_short, (one.rate, min(one.rates), max(one.rates)))
        shares = [f"{count / one.counts.collisions:.2f}" for count in one.counts[1:]]
        rows.append([one.label, *rates, f"{statistics.median(one.relative):.2f}", *shares])
    return table(heads, rows)


def table(heads: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """A Markdown table that can be read as it stands: numbers to the right, words to the left."""
    rows = [list(row) for row in rows]
    widths = [max(len(row[k]) for row in [heads, *rows]) for k in range(len(heads))]
    left = [
        not all(row[k][:1].isdigit() or row[k] == "nan" for row in rows) for k in range(len(heads))
    ]
    rule = [
        "-" * (width - 1) + ("-" if words else ":")
        for width, words in zip(widths, left, strict=True)
    ]
    lines = []
    for row in [heads, rule, *rows]:
        columns = zip(row, widths, left, strict=True)
        cells = [
            cell.ljust(width) if words else cell.rjust(width) for cell, width, words in columns
        ]
        lines.append(f"| {' | '.join(cells)} |")
    return "\n".join(lines)


def _short(rate):
    return f"{rate:.2e}".replace("e+0", "e")
