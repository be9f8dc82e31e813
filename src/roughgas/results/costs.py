"""What was planned beside what happened, from reduced datasets of experiments with a target."""

import json
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import NamedTuple

import numpy as np
import xarray as xr

from roughgas.base.files import write_text
from roughgas.data.reduced import read_reduced

HEAD = """\
# What was planned, and what happened

A pilot run of each point foretells how many seeds its target needs and what they cost. A point that
is still above its target then gets more. Times are CPU seconds of the kernel; the ratios are spent
over planned, of times and of collisions.

| experiment | points | target | met by | planned | made | s planned | spent | ratio | collisions |
| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |
"""
SAVED = """
## Against a fixed length

Each point is run as long as it needs, instead of as long as the slowest. How many times as much CPU
time fixed runs take: *at equal error*, and *to bring every point to the target* with whole runs.

| experiment | fixed run | at equal error | to the target |
| --- | --- | --- | --- |
"""


class Cost(NamedTuple):
    """Sums over the points of an experiment."""

    name: str
    points: int
    target: float
    met: int
    seeds: tuple[int, int]  # planned, made
    seconds: tuple[float, float]
    collisions: tuple[float, float]


def cost(data: xr.Dataset) -> Cost:
    """What a reduced dataset says of plan and outcome."""
    there = np.isfinite(data.R)
    return Cost(
        name=data.attrs["experiment"],
        points=int(there.sum()),
        target=float(data.target_stderr.max()),
        met=int((data.R_stderr <= data.target_stderr).sum()),
        seeds=(int(data.planned_seeds.sum()), int(data.n_seeds.sum())),
        seconds=(float(data.planned_seconds.sum()), float(data.kernel_seconds.sum())),
        collisions=(float(data.planned_collisions.sum()), float(data.collisions.sum())),
    )


def saved(data: xr.Dataset, schedule: Mapping[str, float]) -> tuple[float, float]:
    """How many times as much the fixed `schedule` (equilibrate, measure, in T) would cost: at equal
    error, and to bring every point to its target in whole runs."""
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
    datasets, schedules = [read_reduced(path) for path in paths], json.loads(fixed)
    costs = [cost(data) for data in datasets]
    text = HEAD + "".join(map(_line, [*costs, _total(costs)])) + SAVED
    for data in datasets:
        schedule = schedules[data.attrs["experiment"]]
        if schedule["kind"] == "steady":
            equal, whole = saved(data, schedule)
            length = schedule["equilibrate"] + schedule["measure"]
            text += f"| {data.attrs['experiment']} | {length:g} T | {equal:.1f} | {whole:.1f} |\n"
    write_text(output, text)


def _total(costs: list[Cost]) -> Cost:
    def sums(name):
        return tuple(sum(pair) for pair in zip(*(getattr(c, name) for c in costs), strict=True))

    points, met = sum(c.points for c in costs), sum(c.met for c in costs)
    target = max(c.target for c in costs)
    return Cost("in all", points, target, met, *map(sums, ("seeds", "seconds", "collisions")))


def _line(c: Cost) -> str:
    return (
        f"| {c.name} | {c.points} | {c.target:g} | {c.met} | {c.seeds[0]} | {c.seeds[1]} "
        f"| {c.seconds[0]:.1f} | {c.seconds[1]:.1f} | {c.seconds[1] / c.seconds[0]:.2f} "
        f"| {c.collisions[1] / c.collisions[0]:.2f} |\n"
    )
