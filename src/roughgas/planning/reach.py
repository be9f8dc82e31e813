"""Run a point until its standard error is what was asked for, and no longer."""

import math
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from roughgas.data.point import Point
from roughgas.planning.pilot import Pilot
from roughgas.planning.plan import Plan, explore, plan_point
from roughgas.scene import Scene
from roughgas.simulation.point import run_point
from roughgas.statistics.intervals import Error, pooled

MOST = 4  # times the planned number of seeds: a pilot cannot be further off

Keep = Callable[[int, Point, dict[str, Any]], None]


def reach(
    scene: Scene, experiment: Mapping[str, Any], pilot: Pilot, keep: Keep, tell: Any
) -> tuple[Plan, Error, int]:
    """Run seeds 1, 2, ... of a point until its `target_stderr` is met.

    Returns the plan, the error reached and the number of seeds. `keep(seed, point, settings)` is
    called with each seed's point, and the settings that make this seed again. The planned number
    comes first; while the error is larger than the target, as many more as its size calls for,
    up to MOST times as many as planned.
    """
    plan = plan_point(scene, experiment, pilot)
    settings = completed(experiment, plan)
    expected = {
        "target_stderr": experiment["target_stderr"],
        "planned_seeds": plan.seeds,
        "planned_stderr": plan.stderr,
        "planned_collisions": plan.collisions,
        "planned_seconds": plan.seconds,
    }
    runs: list[list[Any]] = []
    wanted = plan.seeds
    while True:
        while len(runs) < wanted:
            point = run_point(scene, settings, len(runs) + 1, tell)
            runs.append([point.variables[name] for name in ("R", "R_stderr", "R_dof")])
            keep(len(runs), point._replace(variables=point.variables | expected), settings)
        error = pooled(*np.array(runs, float).T)
        wanted = _wanted(len(runs), error, experiment["target_stderr"], plan.seeds)
        if wanted == len(runs):
            return plan, error, wanted


def completed(experiment: Mapping[str, Any], plan: Plan) -> dict[str, Any]:
    """Return an experiment's settings with the lengths of its runs in place of a target."""
    settings = {key: value for key, value in experiment.items() if key != "target_stderr"}
    return settings | {"schedule": plan.schedule}


def complete(scene: Scene, experiment: Mapping[str, Any]) -> dict[str, Any]:
    """Return the same of a point without a plan; settings without a target as they are."""
    if "target_stderr" not in experiment:
        return dict(experiment)
    return completed(experiment, plan_point(scene, experiment, explore(scene, experiment)))


def _wanted(made: int, error: Error, target: float, planned: int) -> int:
    """Return how many seeds there should be, by the error of those made so far."""
    if not error.stderr > target:
        return made
    enough = math.ceil(made * (error.stderr / target) ** 2)
    return max(made, min(max(enough, made + 1), MOST * planned))
