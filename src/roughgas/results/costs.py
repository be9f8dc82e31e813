"""What experiments took: run times, and for those with a target what was planned beside it."""

from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import NamedTuple

import numpy as np
import xarray as xr

from roughgas.base.errors import InputError, shown
from roughgas.base.files import write_text
from roughgas.base.layout import from_json, markdown
from roughgas.data.reduced import particles_of, read_reduced

RUN_TIMES = """\
# Run times

What the simulations of each experiment took, all points and seeds together: CPU seconds in the
kernel, without starting processes and compiling.

"""
TIMES = "experiment | particles | points | seeds | collisions | CPU seconds | collisions a second"
TEXT = """\
# What was planned, and what happened

A pilot run of each point foretells how many seeds its target needs and what they cost. A point that
is still above its target then gets more. Times are CPU seconds of the kernel; the ratios are spent
over planned, of times and of collisions.

{}
## Against a fixed length

Each point is run as long as it needs, instead of as long as the slowest. How many times as much CPU
time fixed runs take: *at equal error*, and *to bring every point to the target* with whole runs.

{}"""
COLUMNS = "experiment | points | target | met by | planned | made | s planned | spent | ratio"
AGAINST = ("experiment", "fixed run", "at equal error", "to the target")
SPENT = {"seeds": "n_seeds", "seconds": "kernel_seconds", "collisions": "collisions"}


def write_times(reduced: Iterable[str | Path], output: str | Path) -> None:
    """Write a Markdown table with a row for each reduced dataset, and one for their sum."""
    rows, spent = [], []
    for data in map(read_reduced, reduced):
        seeds, collisions, seconds = data.n_seeds, data.collisions.sum(), data.kernel_seconds.sum()
        spent.append((int((seeds > 0).sum()), int(seeds.sum()), int(collisions), float(seconds)))
        rows.append([data.attrs["experiment"], particles_of(data), *_sums(*spent[-1])])
    rows.append(["together", "", *_sums(*map(sum, zip(*spent, strict=True)))])
    write_text(output, RUN_TIMES + markdown(TIMES.split(" | "), rows))


def _sums(points: int, seeds: int, collisions: int, seconds: float) -> list[str]:
    counts = [f"{count:,}" for count in (points, seeds, collisions)]
    return [*counts, f"{seconds:,.1f}", f"{collisions / seconds:,.0f}" if seconds > 0 else ""]


class Cost(NamedTuple):
    """Sums over the points of an experiment; arrays have what was planned, and what was spent."""

    points: int
    met: int
    seeds: np.ndarray
    seconds: np.ndarray
    collisions: np.ndarray


def cost(data: xr.Dataset) -> Cost:
    """Return what a reduced dataset says of plan and outcome."""
    there, met = np.isfinite(data.R), data.R_stderr <= data.target_stderr
    names = ((f"planned_{what}", spent) for what, spent in SPENT.items())
    pairs = (np.array([float(data[name].sum()) for name in pair]) for pair in names)
    return Cost(int(there.sum()), int(met.sum()), *pairs)


def saved(data: xr.Dataset, schedule: Mapping[str, float]) -> tuple[float, float]:
    """Return how many times as much the fixed `schedule` (equilibrate, measure, in T) would cost.

    That is at equal error, and to bring every point to its target in whole runs.
    """
    wait, measure = schedule["equilibrate"], schedule["measure"]
    simulated = data.n_seeds * (data.measured_from + data.measured_for)
    per_length = data.kernel_seconds / simulated
    measured = data.n_seeds * data.measured_for
    equal = measured / measure * (wait + measure) * per_length
    needed = measured * (data.R_stderr / data.target_stderr) ** 2 / measure
    runs = np.maximum(np.ceil(needed), 1) * (wait + measure) * per_length
    spent = float(data.kernel_seconds.sum())
    return float(equal.sum()) / spent, float(runs.sum()) / spent


def write_costs(paths: Iterable[str | Path], fixed: str, output: str | Path) -> None:
    """Write the comparison as Markdown; `fixed` has schedules by experiment, as JSON."""
    schedules, costs, targets, rows, against = from_json(fixed, "--fixed"), [], [], [], []
    for data in map(read_reduced, paths):
        name = data.attrs["experiment"]
        if not isinstance(schedule := schedules.get(name), dict):
            raise InputError(f"--fixed: {name}", shown(schedule), "be a schedule")
        if "target_stderr" not in data:
            raise InputError(f"target_stderr of {name}", "(nothing)", "be what it was run for")
        costs.append(cost(data))
        targets.append(float(data.target_stderr.max()))
        rows.append(_row(name, targets[-1], costs[-1]))
        if "measure" in schedule:  # a length in T
            length = schedule["equilibrate"] + schedule["measure"]
            against.append([name, f"{length:g} T", *(f"{x:.1f}" for x in saved(data, schedule))])
    rows.append(
        _row(
            "in all", max(targets), Cost(*(np.sum(one, axis=0) for one in zip(*costs, strict=True)))
        )
    )
    head = [*COLUMNS.split(" | "), "collisions"]
    write_text(output, TEXT.format(markdown(head, rows), markdown(AGAINST, against)))


def _row(name: str, target: float, c: Cost) -> list[str]:
    seeds, seconds = (f"{n:.0f}" for n in c.seeds), (f"{s:.1f}" for s in c.seconds)
    ratios = (f"{spent / planned:.2f}" for planned, spent in (c.seconds, c.collisions))
    return [name, str(c.points), f"{target:g}", str(c.met), *seeds, *seconds, *ratios]
