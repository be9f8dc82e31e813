"""What a run of experiments will cost, before it is run: the table of `roughgas plan`."""

from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Any, NamedTuple

from roughgas.base.layout import markdown
from roughgas.planning.pilot import Pilot
from roughgas.planning.plan import Plan, plan_point
from roughgas.scene import build


class Row(NamedTuple):
    """One experiment: its plans, what its pilots cost, and how many jobs it consists of."""

    name: str
    target: float | None
    plans: Sequence[Plan]
    jobs: int


def row(
    name: str, experiment: Mapping[str, Any], pilots: Mapping[tuple[str, str], Pilot], block: int
) -> Row:
    """Return the row of an experiment, from its pilots by (r, beta); a job runs `block` seeds."""
    plans = [
        plan_point(build(experiment, float(r), float(beta)), experiment, pilot)
        for (r, beta), pilot in pilots.items()
    ]
    target = experiment.get("target_stderr")
    return Row(name, target, plans, sum(1 if target else -(-p.seeds // block) for p in plans))


def as_markdown(rows: Iterable[Row], cores: int, start_up: float) -> str:
    """Return the table; its last row is the sum.

    A job spends `start_up` CPU seconds besides its kernel.
    """
    numbers = as_numbers(rows, cores, start_up)
    cells = [[form(one[name]) for name, (_, form) in COLUMNS.items()] for one in numbers]
    return markdown([title for title, _ in COLUMNS.values()], cells, padded=True) + (
        f"\nErrors are standard errors of R. CPU: with {start_up:.2g} s for the start of each job. "
        f"Wall:\non {cores} cores, without compiling (10 to 15 s for each kind of scene, once).\n"
    )


def as_numbers(rows: Iterable[Row], cores: int, start_up: float) -> list[dict[str, Any]]:
    """Return the same by the names in COLUMNS; times are in seconds, no target is None."""
    rows = list(rows)
    every = [plan for one in rows for plan in one.plans]
    total = Row("in all", None, every, sum(one.jobs for one in rows))
    return [_numbers(one, cores, start_up) for one in [*rows, total]]


def _numbers(one: Row, cores: int, start_up: float) -> dict[str, Any]:
    errors = sorted(plan.stderr for plan in one.plans)
    kernel = sum(plan.seconds for plan in one.plans)
    cpu = kernel + start_up * one.jobs
    longest = start_up + max(plan.seconds for plan in one.plans)
    return {
        "experiment": one.name,
        "target": one.target,
        "points": len(one.plans),
        "seeds": sum(plan.seeds for plan in one.plans),
        "typical_error": errors[len(errors) // 2],
        "largest_error": errors[-1],
        "collisions": sum(plan.collisions for plan in one.plans),
        "kernel_seconds": kernel,
        "cpu_seconds": cpu,
        "wall_seconds": max(cpu / cores, longest),
    }


def _time(seconds: float) -> str:
    if seconds < 100:
        return f"{seconds:.1f} s"
    minutes = round(seconds / 60)
    return f"{minutes} min" if minutes < 120 else f"{minutes / 60:.1f} h"


COLUMNS: dict[str, tuple[str, Callable[[Any], str]]] = {
    "experiment": ("experiment", str),
    "target": ("target", lambda target: "" if target is None else f"{target:g}"),
    "points": ("points", str),
    "seeds": ("seeds", str),
    "typical_error": ("typical error", "{:.2g}".format),
    "largest_error": ("largest error", "{:.2g}".format),
    "collisions": ("collisions", "{:.2e}".format),
    "kernel_seconds": ("kernel CPU", _time),
    "cpu_seconds": ("CPU", _time),
    "wall_seconds": ("wall", _time),
}
"""By the name of a number, the title of its column and its form."""
