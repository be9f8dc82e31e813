"""How long a run took, experiment by experiment, as a table."""

from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from roughgas.base.files import write_text
from roughgas.data.reduced import read_reduced

if TYPE_CHECKING:
    import xarray

HEAD = """\
# Run times

What the simulations of each experiment took, all points and seeds together: CPU seconds in the
kernel, without starting processes and compiling.

| experiment | particles | points | seeds | collisions | CPU seconds | collisions a second |
| --- | --- | --- | --- | --- | --- | --- |
"""


class Spent(NamedTuple):
    """What an experiment took."""

    points: int
    seeds: int
    collisions: int
    seconds: float


def write_times(reduced: Iterable[str | Path], output: str | Path) -> None:
    """Write a Markdown table with a row for each reduced dataset, and one for their sum."""
    datasets = [read_reduced(path) for path in reduced]
    spent = [_spent(data) for data in datasets]
    lines = [
        _line(data.attrs["experiment"], str(data.attrs["particles"]), one)
        for data, one in zip(datasets, spent, strict=True)
    ]
    total = Spent(*map(sum, zip(*spent, strict=True)))
    write_text(output, HEAD + "".join(lines) + _line("together", "", total))


def _spent(data: "xarray.Dataset") -> Spent:
    seeds = data.n_seeds.values
    collisions, seconds = int(data.collisions.sum()), float(data.kernel_seconds.sum())
    return Spent(int((seeds > 0).sum()), int(seeds.sum()), collisions, seconds)


def _line(name: str, particles: str, spent: Spent) -> str:
    speed = f"{spent.collisions / spent.seconds:,.0f}" if spent.seconds > 0 else ""
    cells = (name, particles, f"{spent.points:,}", f"{spent.seeds:,}", f"{spent.collisions:,}")
    return f"| {' | '.join((*cells, f'{spent.seconds:,.1f}', speed))} |\n"
