"""From a pilot and a wanted standard error: how long to run, how often, and what it will cost."""

import math
from collections.abc import Iterable, Mapping
from itertools import product
from statistics import NormalDist
from typing import Any, NamedTuple

from roughgas.planning import cooling, steady
from roughgas.planning.lengths import FEWEST_SEEDS, RESERVE
from roughgas.planning.pilot import Pilot
from roughgas.scene import Scene, build
from roughgas.simulation import cooling as of_cooling
from roughgas.simulation import schedule
from roughgas.simulation import steady as of_steady

PLANNERS: dict[schedule.Kind, Any] = {of_steady: steady, of_cooling: cooling}
"""By kind of schedule, its pilots and plans."""
ALONE = 0.5  # of a seed: if less would do, run one; its own error bar is enough
BLOCKS = 6.0  # degrees of freedom of the error within one run


class Plan(NamedTuple):
    """How a point is run, and what is expected of it; lengths as in Pilot."""

    schedule: dict[str, Any]  # of each run, complete
    seeds: int
    stderr: float  # expected, of the mean over these seeds
    collisions: float  # expected, with the seeds that may have to be added
    seconds: float  # the same of CPU time of the kernel


def explore(scene: Scene, experiment: Mapping[str, Any]) -> Pilot:
    """Run the pilot of a point. Apart from the times, the same settings give the same numbers.

    Raises InputError if the particles do not fit, CollapseError if contacts accumulate without end.
    """
    return PLANNERS[schedule.of(experiment)].explore(scene, experiment)


def plan_point(scene: Scene, experiment: Mapping[str, Any], pilot: Pilot) -> Plan:
    """Return the plan of a point, for its `target_stderr` or for the lengths and seeds as set.

    Half of a run, or more if R remembers long, is measured; the number of seeds follows. So if a
    point needs more than the fewest seeds, its cost is proportional to the inverse square of its
    error, but for the logarithm of what may be left of the transient.
    """
    kind, chosen = schedule.of(experiment), dict(experiment["schedule"])
    if "target_stderr" in experiment:
        target = float(experiment["target_stderr"])
        chosen = PLANNERS[kind].choose(scene, experiment, pilot, target)
        enough = pilot.variance / (schedule.measured(chosen) * target**2)
        wanted = enough / RESERVE**2
        seeds = 1 if wanted <= ALONE else max(FEWEST_SEEDS, math.ceil(wanted))
        freedom = float(chosen.get("replicas", 1.0 + BLOCKS))  # of the error of one seed
        made = seeds * (1.0 + added(enough / seeds, seeds * freedom))
    else:
        made = seeds = experiment["sweep"]["seeds"]
    simulated = made * kind.length(scene, {**experiment, "schedule": chosen})
    return Plan(
        schedule=chosen,
        seeds=seeds,
        stderr=math.sqrt(pilot.variance / (seeds * schedule.measured(chosen))),
        collisions=simulated * pilot.pace * experiment["particles"] / 2,
        seconds=simulated * pilot.seconds_per_length,
    )


def share_of_pilots(experiments: Iterable[Mapping[str, Any]]) -> float:
    """Return about how much work the pilots of sweeps are, as a share of the sweeps themselves.

    0 where a target decides how long points are run: then only the pilots can tell.
    """
    pilots = runs = 0.0
    for experiment in experiments:
        axes, kind = experiment["sweep"], schedule.of(experiment)
        if "target_stderr" in experiment:
            return 0.0
        for r, beta in product(axes["r"], axes["beta"]):
            scene = build(experiment, float(r), float(beta))
            length = axes["seeds"] * kind.length(scene, experiment)
            runs += experiment["particles"] * length
            pilots += experiment["particles"] * PLANNERS[kind].effort(scene, experiment)
    return pilots / runs


def added(needed: float, dof: float) -> float:
    """Return the share of seeds that are expected to be added to the planned ones.

    `needed` is the share of them (at most 1) that the target needs; their variance is known with
    `dof` degrees of freedom, and its noise is taken for Gaussian.
    """
    scatter = math.sqrt(2.0 / dof) * needed
    if scatter == 0.0:
        return 0.0
    reserve = (1.0 - needed) / scatter
    gauss = NormalDist()
    return scatter * gauss.pdf(reserve) - (1.0 - needed) * gauss.cdf(-reserve)
