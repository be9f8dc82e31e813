"""From a pilot and a wanted standard error: how long to run, how often, and what it will cost."""

import math
from collections.abc import Mapping
from statistics import NormalDist
from typing import Any, NamedTuple

from roughgas.planning.pilot import Pilot
from roughgas.scene import Scene
from roughgas.simulation.cooling import TRANSIENT, rate_of, transient_length
from roughgas.theory import collisions_to_relax, cooling_ratio, lun_ratio

BIAS = 0.1  # of the target: what may be left of the transient
CARE = 1.3  # theory's relaxation is followed within a few per cent
TWICE = 2.0  # the transient is waited for: whether a gas is steady is judged from half of that on
FEWEST_SEEDS = 2
ALONE = 0.5  # of a seed: where so little would do, one says enough of its own error
RESERVE = (
    0.9  # of the target is aimed at, lest noise in the error ask for more seeds: errors of runs
)
# that stop when they look small enough are too small
REPLICAS = 5  # of a cooling gas to a seed
MEMORIES = {
    "steady": 20.0,
    "cooling": 3.0,
}  # autocorrelation times in a run, at least: blocks, which
# tell the error within one run, need the more of them
BLOCKS = 6.0  # degrees of freedom that they have in such a run


class Plan(NamedTuple):
    """How a point is run, and what is expected of it; lengths as in Pilot."""

    schedule: dict[str, Any]  # of each run, complete
    seeds: int
    stderr: float  # expected, of the mean over these seeds
    collisions: float  # expected, with the seeds that may have to be added
    seconds: float  # the same of CPU time of the kernel


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


def plan_point(scene: Scene, experiment: Mapping[str, Any], pilot: Pilot) -> Plan:
    """The plan of a point: for its `target_stderr`, or for the lengths and seeds that are set.

    Half of a run, or more where R remembers long, is measured; the number of seeds follows. So,
    where a point needs more than the fewest seeds, its cost is proportional to the inverse square
    of its error, but for the logarithm of what may be left of the transient.
    """
    if "target_stderr" in experiment:
        schedule, lengths = _chosen(scene, experiment, pilot)
        enough = pilot.variance / (lengths.runs * lengths.measured * _target(experiment) ** 2)
        wanted = enough / RESERVE**2
        seeds = 1 if wanted <= ALONE else max(FEWEST_SEEDS, math.ceil(wanted))
        made = seeds * (1.0 + added(enough / seeds, seeds * _freedom(lengths)))
    else:
        schedule, lengths = dict(experiment["schedule"]), _given(scene, experiment)
        made = seeds = experiment["sweep"]["seeds"]
    simulated = made * lengths.simulated
    return Plan(
        schedule=schedule,
        seeds=seeds,
        stderr=math.sqrt(pilot.variance / (seeds * lengths.runs * lengths.measured)),
        collisions=simulated * pilot.pace * experiment["particles"] / 2,
        seconds=simulated * pilot.seconds_per_length,
    )


def added(needed: float, dof: float) -> float:
    """The share of seeds that are expected to be added, where the planned ones find their error too
    large: they need this share (at most 1) of their number, and know their variance with so many
    degrees of freedom, taken for Gaussian."""
    scatter = math.sqrt(2.0 / dof) * needed
    if scatter == 0.0:
        return 0.0
    reserve = (1.0 - needed) / scatter
    gauss = NormalDist()
    return scatter * gauss.pdf(reserve) - (1.0 - needed) * gauss.cdf(-reserve)


def _freedom(lengths: Lengths) -> float:
    """Degrees of freedom that a seed adds to the error of all."""
    return float(lengths.runs if lengths.runs > 1 else 1.0 + BLOCKS)


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
    given = experiment["schedule"]
    choose = {"steady": _chosen_driven, "cooling": _chosen_cooling}[given["kind"]]
    return choose(scene, given, pilot, _target(experiment))


def _chosen_driven(scene, given, pilot, target):
    unit = given.get("period", given["sample_every"])
    relaxed = relaxation(scene, BIAS * target, cooling=False) / pilot.pace
    transient = _whole(max(relaxed, TWICE * pilot.transient), unit)
    needed = pilot.variance / (FEWEST_SEEDS * (RESERVE * target) ** 2)
    measured = _whole(_measured("steady", transient, needed, pilot), unit)
    schedule = given | {"equilibrate": transient, "measure": measured}
    return schedule, Lengths(transient, measured)


def _chosen_cooling(scene, given, pilot, target):
    e_folds = _rounded(relaxation(scene, BIAS * target, cooling=True) * rate_of(scene))
    transient = transient_length(scene, e_folds)
    spent = given["thermalise"] + transient
    needed = pilot.variance / (FEWEST_SEEDS * REPLICAS * (RESERVE * target) ** 2)
    plateau = _whole(_measured("cooling", spent, needed, pilot), given["sample_every"])
    schedule = given | {"replicas": REPLICAS, "relaxation_times": e_folds, "plateau": plateau}
    return schedule, Lengths(transient, plateau, REPLICAS, given["thermalise"])


def _given(scene: Scene, experiment: Mapping[str, Any]) -> Lengths:
    """The lengths of a run whose schedule is complete."""
    schedule = experiment["schedule"]
    if schedule["kind"] == "steady":
        return Lengths(schedule["equilibrate"], schedule["measure"])
    transient = transient_length(scene, schedule["relaxation_times"])
    return Lengths(transient, schedule["plateau"], schedule["replicas"], schedule["thermalise"])


def _measured(kind, spent, needed, pilot):
    """How long a run is measured: as long as was spent before, but no longer than is `needed`; and
    many times what R remembers (NaN where it is constant)."""
    memory = pilot.autocorrelation_time
    return max(min(spent, needed), 0.0 if math.isnan(memory) else MEMORIES[kind] * memory)


def _target(experiment: Mapping[str, Any]) -> float:
    return float(experiment["target_stderr"])


def _whole(length: float, unit: float) -> float:
    """The length in whole units, at least twenty, and short in writing."""
    return round(unit * max(20, math.ceil(length / unit)), 9)


def _rounded(number: float) -> float:
    return float(f"{max(number, 1.0):.3g}")
