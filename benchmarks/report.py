"""Page of the measurements on a machine, in Markdown, for the terminal and for docs."""

from collections.abc import Sequence

from benchmarks import effects, generality
from benchmarks.kernel import MAX_TIME, RUNS, WARM_UP, Timing
from benchmarks.machines import name_of, plain_rate
from benchmarks.tables import short, table
from benchmarks.yardstick import REFERENCE, Rate

OVERHEAD_ROWS = (  # of benchmarks.pipeline: key, label, format
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
million particles the way to the first run, and the runs, are cut short after some {MAX_TIME:g} s.

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
YARDSTICK_EXPLANATION = """
Rough disks by the plainest compiled loop (`benchmarks/yardstick.py`), medians: ratios to it survive
a change of machine.
""".strip()


def report(timings, yardstick, comparisons, costs, overhead, machine) -> str:
    """Return the page, with sections for all measurements that were made."""
    name = name_of(machine)
    sections = [
        f"# Benchmarks: {machine.get('processor', 'unknown')} ({machine['instruction set']})",
        "Written by `make bench`.",
        table(["", "machine"], machine.items()),
        "## The kernel",
        f"![Cost per collision against the number of particles]({name}.png)",
        kernel_table(timings, yardstick),
        EXPLANATION,
        "## The yardstick",
        YARDSTICK_EXPLANATION,
        yardstick_table(yardstick),
        "## What generality costs",
        generality.EXPLANATION,
        generality.table(comparisons),
    ]
    if costs:
        picture = f"![Collisions per second with each effect]({name}-effects.png)"
        sections += ["## What each effect costs", picture]
        sections += [effects.table(costs), effects.EXPLANATION]
    if overhead:
        rows = [
            (label, format(overhead[key], number_format))
            for key, label, number_format in OVERHEAD_ROWS
        ]
        sections += ["## The pipeline", table(["", "measured"], rows)]
    return "\n\n".join(sections) + "\n"


def kernel_table(timings: Sequence[Timing], yardstick: Sequence[Rate]) -> str:
    """Return the table of timings, a row for each scene and number of particles."""
    head = ["scene", "N", "x plain", "collisions/s", "slowest", "fastest", "events/s"]
    head += ["µs/collision", "relative", "hits", "renewals", "stale"]
    head += ["B state", "B cells", "B work"]
    reference = {timing.case: timing.cost for timing in timings if timing.number == REFERENCE}
    plain = plain_rate(yardstick)
    rows = []
    for timing in timings:
        low, high = timing.extremes
        rows.append(
            [timing.case.title, f"{timing.number:,}", f"{timing.rate / plain:.1f}"]
            + [*map(short, (timing.rate, low, high, timing.events))]
            + [
                f"{timing.cost:.2f}",
                f"{timing.cost / reference.get(timing.case, float('nan')):.2f}",
            ]
            + [f"{count / timing.counts.collisions:.2f}" for count in timing.counts[1:]]
            + [f"{size:.0f}" for size in timing.memory]
        )
    return table(head, rows)


def yardstick_table(yardstick: Sequence[Rate]) -> str:
    """Return the table of rates of the yardstick, a row for each number of particles."""
    rows = [
        (f"{rate.number:,}", *map(short, (rate.median, min(rate.rates), max(rate.rates))))
        for rate in yardstick
    ]
    return table(["N", "collisions/s", "slowest", "fastest"], rows)
