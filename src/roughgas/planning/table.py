"""What a run of experiments will cost, before it is run: the table of `roughgas plan`."""

from collections.abc import Iterable, Mapping, Sequence
from typing import Any, NamedTuple

from roughgas.planning.pilot import Pilot
from roughgas.planning.plan import Plan, plan_point
from roughgas.scene import build

HEAD = {
    "experiment": "experiment",
    "target": "target",
    "points": "points",
    "seeds": "seeds",
    "typical_error": "typical error",
    "largest_error": "largest error",
    "collisions": "collisions",
    "kernel_seconds": "kernel CPU",
    "cpu_seconds": "CPU",
    "wall_seconds": "wall",
}


class Row(NamedTuple):
    """One experiment: its plans, what its pilots cost, and how many jobs it consists of."""

    name: str
    target: float | None
    plans: Sequence[Plan]
    jobs: int

    @property
    def kernel(self) -> float:
        """CPU seconds in the kernel."""
        return sum(plan.seconds for plan in self.plans)


def row(name: str, experiment: Mapping[str, Any], pilots: Mapping[tuple[str, str], Pilot], block):
    """The row of an experiment, from the pilots of its points; `block` seeds are made by a job."""
    plans = [
        plan_point(build(experiment, float(r), float(beta)), experiment, pilot)
        for (r, beta), pilot in pilots.items()
    ]
    target = experiment.get("target_stderr")
    jobs = sum(1 if target else -(-plan.seeds // block) for plan in plans)
    return Row(name, target, plans, jobs)


def as_markdown(rows: Iterable[Row], cores: int, start_up: float) -> str:
    """The table, its last row the sum; a job spends `start_up` CPU seconds besides its kernel."""
    lines = [_cells(numbers) for numbers in as_numbers(rows, cores, start_up)]
    widths = [max(map(len, column)) for column in zip(HEAD.values(), *lines, strict=True)]
    rule = ["-" * width for width in widths]
    text = [
        " | ".join(x.ljust(w) for x, w in zip(line, widths, strict=True))
        for line in [HEAD.values(), rule, *lines]
    ]
    notes = (
        f"Errors are standard errors of R. CPU: with {start_up:.2g} s for the start of each job. "
        f"Wall:\non {cores} cores, without compiling (10 to 15 s for each kind of scene, once)."
    )
    return "\n".join(f"| {line} |" for line in text) + f"\n\n{notes}\n"


def as_numbers(rows: Iterable[Row], cores: int, start_up: float) -> list[dict[str, Any]]:
    """The same by the names in HEAD: errors of R, times in seconds, None for no target."""
    rows = list(rows)
    plans, jobs = [plan for one in rows for plan in one.plans], sum(one.jobs for one in rows)
    return [_numbers(one, cores, start_up) for one in [*rows, Row("in all", None, plans, jobs)]]


def _numbers(one: Row, cores: int, start_up: float) -> dict[str, Any]:
    errors = sorted(plan.stderr for plan in one.plans)
    cpu = one.kernel + start_up * one.jobs
    longest = start_up + max(plan.seconds for plan in one.plans)
    return {
        "experiment": one.name,
        "target": one.target,
        "points": len(one.plans),
        "seeds": sum(plan.seeds for plan in one.plans),
        "typical_error": errors[len(errors) // 2],
        "largest_error": errors[-1],
        "collisions": sum(plan.collisions for plan in one.plans),
        "kernel_seconds": one.kernel,
        "cpu_seconds": cpu,
        "wall_seconds": max(cpu / cores, longest),
    }


def _cells(numbers: Mapping[str, Any]) -> list[str]:
    return [_FORMATS.get(name, str)(numbers[name]) for name in HEAD]


def _time(seconds: float) -> str:
    if seconds < 100:
        return f"{seconds:.1f} s"
    minutes = round(seconds / 60)
    return f"{minutes} min" if minutes < 120 else f"{minutes / 60:.1f} h"


_FORMATS = {
    "target": lambda target: "" if target is None else f"{target:g}",
    "typical_error": "{:.2g}".format,
    "largest_error": "{:.2g}".format,
    "collisions": "{:.2e}".format,
    "kernel_seconds": _time,
    "cpu_seconds": _time,
    "wall_seconds": _time,
}
