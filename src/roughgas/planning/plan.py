"""From a pilot and a wanted standard error: how long to run, how often, and what it will cost."""

import math
from collections.abc import Mapping
from typing import Any, NamedTuple

from roughgas.planning.pilot import Pilot
from roughgas.protocols.cooling import TRANSIENT, transient_length
from roughgas.scene import Scene, build
from roughgas.theory import collisions_to_relax, cooling_ratio, lun_ratio, relaxation_rate

BIAS = 0.1  # of the target: what may be left of the transient
CARE = 1.3  # theory's relaxation is followed within a few per cent
FEWEST_SEEDS = 2
REPLICAS = 10  # of a cooling gas to a seed: as many as it takes to find a plateau
MEMORIES = {"steady": 20.0, "cooling": 10.0}  # autocorrelation times in a run, at least: to see a
# driven gas steady, and an error within one run of it, needs the more of them


class Plan(NamedTuple):
    """How a point is run, and what is expected of it; lengths as in Pilot."""

    schedule: dict[str, Any]  # of each run, complete
    seeds: int
    stderr: float  # expected, of the mean over all seeds
    collisions: float  # expected, in all runs
    seconds: float  # expected CPU time of the kernel in all runs


class Lengths(NamedTuple):
    """Of one run of a point."""

    transient: float
    measured: float
    runs: int = 1  # replicas side by side in one file
    before: float = 0.0  # spent before the transient begins

    @property
    def simulated(self) -> float:
        """In all."""
        return self.runs * (self.before + self.transient + self.measured)


def plan_point(experiment: Mapping[str, Any], r: float, beta: float, pilot: Pilot) -> Plan:
    """The plan of a point: for its `target_stderr`, or for the lengths and seeds that are set.

    The length of a run does not depend on the target, but for the logarithm of what may be left of
    the transient: so the cost of an error is proportional to its inverse square. Half of a run, or
    more where R remembers long, is measured; the number of seeds follows. Raises InputError.
    """
    scene = build(experiment, r, beta)
    if "target_stderr" in experiment:
        schedule, lengths = _chosen(scene, experiment, pilot)
        enough = pilot.variance / (lengths.runs * lengths.measured * _target(experiment) ** 2)
        seeds = max(FEWEST_SEEDS, math.ceil(enough))
    else:
        schedule, lengths = dict(experiment["schedule"]), _given(scene, experiment)
        seeds = experiment["sweep"]["seeds"]
    simulated = seeds * lengths.simulated
    return Plan(
        schedule=schedule,
        seeds=seeds,
        stderr=math.sqrt(pilot.variance / (seeds * lengths.runs * lengths.measured)),
        collisions=simulated * pilot.pace * experiment["particles"] / 2,
        seconds=simulated * pilot.seconds_per_length,
    )


def relaxation(scene: Scene, tolerated: float, cooling: bool) -> float:
    """Collisions per particle after which R, from a gas without spin, is within `tolerated` of its
    stationary value by the rate equations; 0 where it stays as it is."""
    r, beta, inertia = scene.restitution, scene.roughness, scene.effects.spin.inertia
    dimension = len(scene.box)
    final = cooling_ratio(r, beta, dimension, inertia) if cooling else lun_ratio(beta, inertia)
    if final <= tolerated:
        return 0.0
    share = None if cooling else 0.0
    needed = collisions_to_relax(r, beta, tolerated / float(final), dimension, inertia, share)
    return min(CARE * float(needed), TRANSIENT[1])


def _chosen(scene: Scene, experiment: Mapping[str, Any], pilot: Pilot):
    """The complete schedule of a run that belongs to a target, and its lengths."""
    given, tolerated = experiment["schedule"], BIAS * _target(experiment)
    choose = {"steady": _chosen_driven, "cooling": _chosen_cooling}[given["kind"]]
    return choose(scene, given, pilot, tolerated)


def _chosen_driven(scene, given, pilot, tolerated):
    unit = given.get("period", given["sample_every"])
    relaxed = relaxation(scene, tolerated, cooling=False) / pilot.pace
    transient = _whole(max(relaxed, pilot.transient), unit)
    measured = _whole(_measured("steady", transient, pilot), unit)
    schedule = given | {"equilibrate": transient, "measure": measured}
    return schedule, Lengths(transient, measured)


def _chosen_cooling(scene, given, pilot, tolerated):
    rate = _relaxation_rate(scene)
    e_folds = _rounded(relaxation(scene, tolerated, cooling=True) * rate)
    transient = transient_length(scene, e_folds)
    spent = given["thermalise"] + transient
    plateau = _whole(_measured("cooling", spent, pilot), given["sample_every"])
    schedule = given | {"replicas": REPLICAS, "relaxation_times": e_folds, "plateau": plateau}
    return schedule, Lengths(transient, plateau, REPLICAS, given["thermalise"])


def _given(scene: Scene, experiment: Mapping[str, Any]) -> Lengths:
    """The lengths of a run whose schedule is complete."""
    schedule = experiment["schedule"]
    if schedule["kind"] == "steady":
        return Lengths(schedule["equilibrate"], schedule["measure"])
    transient = transient_length(scene, schedule["relaxation_times"])
    return Lengths(transient, schedule["plateau"], schedule["replicas"], schedule["thermalise"])


def _measured(kind, spent, pilot):
    """How long a run is measured: as long as was spent before, and many times what the gas
    remembers (NaN where R is constant)."""
    return max(spent, 0.0 if math.isnan(pilot.memory) else MEMORIES[kind] * pilot.memory)


def _relaxation_rate(scene):
    inertia, dimension = scene.effects.spin.inertia, len(scene.box)
    return float(relaxation_rate(scene.restitution, scene.roughness, dimension, inertia))


def _target(experiment: Mapping[str, Any]) -> float:
    return float(experiment["target_stderr"])


def _whole(length: float, unit: float) -> float:
    """The length in whole units, at least ten, and short in writing."""
    return round(unit * max(10, math.ceil(length / unit)), 9)


def _rounded(number: float) -> float:
    return float(f"{max(number, 1.0):.3g}")
