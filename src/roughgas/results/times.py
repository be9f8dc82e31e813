"""How long a run took, experiment by experiment, as a table."""

from collections.abc import Iterable
from pathlib import Path

from roughgas.base.files import write_text
from roughgas.base.layout import markdown
from roughgas.data.reduced import read_reduced

HEAD = """\
# Run times

What the simulations of each experiment took, all points and seeds together: CPU seconds in the
kernel, without starting processes and compiling.

"""
COLUMNS = "experiment | particles | points | seeds | collisions | CPU seconds | collisions a second"


def write_times(reduced: Iterable[str | Path], output: str | Path) -> None:
    """Write a Markdown table with a row for each reduced dataset, and one for their sum."""
    rows, spent = [], []
    for data in map(read_reduced, reduced):
        seeds, collisions, seconds = data.n_seeds, data.collisions.sum(), data.kernel_seconds.sum()
        spent.append((int((seeds > 0).sum()), int(seeds.sum()), int(collisions), float(seconds)))
        rows.append([data.attrs["experiment"], data.attrs["particles"], *_cells(*spent[-1])])
    rows.append(["together", "", *_cells(*map(sum, zip(*spent, strict=True)))])
    write_text(output, HEAD + markdown(COLUMNS.split(" | "), rows))


def _cells(points: int, seeds: int, collisions: int, seconds: float) -> list[str]:
    counts = [f"{count:,}" for count in (points, seeds, collisions)]
    return [*counts, f"{seconds:,.1f}", f"{collisions / seconds:,.0f}" if seconds > 0 else ""]
