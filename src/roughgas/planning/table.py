"""What a run of experiments will cost, before it is run: the table of `roughgas plan`."""

from collections.abc import Iterable, Mapping, Sequence
from typing import Any, NamedTuple

from roughgas.planning.pilot import Pilot
from roughgas.planning.plan import Plan, plan_point

HEAD = (
    "experiment",
    "target",
    "points",
    "seeds",
    "typical error",
    "largest error",
    "collisions",
    "kernel CPU",
    "CPU",
    "wall",
)


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
        plan_point(experiment, float(r), float(beta), pilot) for (r, beta), pilot in pilots.items()
    ]
    target = experiment.get("target_stderr")
    jobs = sum(1 if target else -(-plan.seeds // block) for plan in plans)
    return Row(name, target, plans, jobs)


def as_markdown(rows: Iterable[Row], cores: int, start_up: float) -> str:
    """The table, its last row the sum; a job spends `start_up` CPU seconds besides its kernel."""
    rows = list(rows)
    total = Row("in all", None, [plan for one in rows for plan in one.plans], _jobs(rows))
    lines = [_cells(one, cores, start_up) for one in [*rows, total]]
    widths = [max(map(len, column)) for column in zip(HEAD, *lines, strict=True)]
    rule = ["-" * width for width in widths]
    text = [
        " | ".join(x.ljust(w) for x, w in zip(line, widths, strict=True))
        for line in [HEAD, rule, *lines]
    ]
    notes = (
        f"Errors are standard errors of R. CPU: with {start_up:.2g} s for the start of each job. "
        f"Wall:\non {cores} cores, without compiling (10 to 15 s for each kind of scene, once)."
    )
    return "\n".join(f"| {line} |" for line in text) + f"\n\n{notes}\n"


def _jobs(rows: Sequence[Row]) -> int:
    return sum(one.jobs for one in rows)


def _cells(one: Row, cores: int, start_up: float) -> list[str]:
    errors = sorted(plan.stderr for plan in one.plans)
    cpu = one.kernel + start_up * one.jobs
    longest = start_up + max(plan.seconds for plan in one.plans)
    return [
        one.name,
        "" if one.target is None else f"{one.target:g}",
        str(len(one.plans)),
        str(sum(plan.seeds for plan in one.plans)),
        f"{errors[len(errors) // 2]:.2g}",
        f"{errors[-1]:.2g}",
        f"{sum(plan.collisions for plan in one.plans):.2e}",
        _time(one.kernel),
        _time(cpu),
        _time(max(cpu / cores, longest)),
    ]


def _time(seconds: float) -> str:
    if seconds < 100:
        return f"{seconds:.1f} s"
    minutes = round(seconds / 60)
    return f"{minutes} min" if minutes < 120 else f"{minutes / 60:.1f} h"
