"""Kinds of schedule: all that depends on whether a gas is driven or cools, by one look-up."""

import math
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any, Protocol

from roughgas.base import InputError
from roughgas.effects import inertia
from roughgas.effects.species import mixture_of
from roughgas.kernel import hooks
from roughgas.scene import Scene, shear_rate
from roughgas.scene.initial import check as check_scene
from roughgas.simulation import cooling, stages, steady
from roughgas.simulation.energies import Columns
from roughgas.simulation.gas import Gas
from roughgas.simulation.recorder import LENGTHS, MOST_SAMPLES, Recorder, samples_of
from roughgas.simulation.restart import Initial

if TYPE_CHECKING:
    from roughgas.observables import System


class Kind(Protocol):
    """What a module of this room says of schedules of its kind."""

    DRIVEN: bool  # whether time is counted in T, as of a gas that effects drive; else in collisions
    UNIT: str  # of lengths
    LENGTH: str  # key of the schedule: how long R is measured
    SAMPLES_PER_REFRESH: int  # samples after which a gas is refreshed; 1 where none is

    def length(self, scene: Scene, experiment: Mapping[str, Any]) -> float:
        """Return how much a point simulates, in UNIT."""

    def start(
        self, scene: Scene, experiment: Mapping[str, Any], seed: Any, recorder=None, initial=()
    ) -> Gas:
        """Return the gas of a point, the first of several, as its time begins to count."""

    def interval(self, experiment: Mapping[str, Any]) -> float:
        """Return the UNIT between two samples, as they are taken."""

    def check(self, scene: Scene, experiment: Mapping[str, Any]) -> None:
        """Raise InputError for lengths that cannot be run, or that measure nothing."""

    def sample(self, gas: Gas, every: float, samples: int) -> Columns:
        """Advance a gas; return columns, sampled at intervals of `every` UNIT."""

    def samples_per_period(self, schedule: Mapping[str, Any]) -> int:
        """Return the samples in a period of the drive."""

    def phases(self, scene: Scene, schedule: Mapping[str, Any], every: int = 1) -> float:
        """Return how many phases of a periodic drive one in `every` samples shows; infinity without
        such a drive."""

    def wait(self, scene: Scene, experiment: Mapping[str, Any]) -> int:
        """Return the samples that are taken before any can count."""

    def run(
        self,
        scene: Scene,
        experiment: Mapping[str, Any],
        seed: int,
        recorder: Recorder,
        initial: Sequence[Initial] = (),
    ) -> dict[str, Any]:
        """Return the variables of a point (see roughgas.data.point)."""


KINDS: dict[str, Kind] = {"steady": steady, "cooling": cooling, "stages": stages}


def of(experiment: Mapping[str, Any]) -> Kind:
    """Return the kind of an experiment's schedule."""
    return KINDS[experiment["schedule"]["kind"]]


def system_of(scene: Scene, experiment: Mapping[str, Any]) -> "System":
    """Return what observables know of a run."""
    from roughgas.observables import System

    mixture = mixture_of(experiment)
    effects, schedule = scene.effects, experiment["schedule"]
    return System(
        particles=experiment["particles"],
        box=tuple(None if side == "open" else float(side) for side in experiment["box"]),
        periodic=tuple(length is not None for length in scene.box),
        inertia=inertia(effects),
        shear_rate=shear_rate(scene),
        interval=KINDS[schedule["kind"]].interval(experiment),
        cooling=not KINDS[schedule["kind"]].DRIVEN,
        species=() if mixture is None else tuple(map(_group, mixture.kinds)),
        period=schedule.get("period"),
    )


def _group(kind):
    from roughgas.observables.plugin import Group

    radii = {*kind.radius} if kind.spread is None else ()
    return Group(kind.number, *(radii if len(radii) == 1 else (math.nan,)))


def check(experiment: Mapping[str, Any]) -> None:
    """Raise InputError if no point of the experiment could be simulated."""
    built = check_scene(experiment)
    effects = built.effects
    drives = [effects._fields[part.place] for part in hooks.present(effects, "drives")]
    kind = experiment["schedule"]["kind"]
    if drives and not KINDS[kind].DRIVEN:
        legal = f"be steady or stages where there is a drive: {', '.join(drives)}"
        raise InputError("schedule.kind", kind, legal)
    if kind == "steady" and not drives:
        raise InputError(
            "schedule.kind", kind, "be cooling or stages where no effect drives the gas"
        )
    _check_samples(experiment)
    KINDS[kind].check(built, experiment)
    if experiment.get("observables"):
        _check_observables(experiment, built)


def _check_samples(experiment):
    """Raise InputError for lengths that make too many samples to keep."""
    schedule = experiment["schedule"]
    samples = samples_of(schedule)
    if samples > MOST_SAMPLES:
        asked = " and ".join(f"schedule.{name}" for name in LENGTHS if name in schedule)
        legal = f"make at most {MOST_SAMPLES:.0e} samples of {asked}, not {samples:.0e}"
        raise InputError("schedule.sample_every", schedule["sample_every"], legal)


def _check_observables(experiment, scene):
    """Raise InputError for settings that are illegal, or observables that do not suit the scene."""
    from roughgas.observables import wanted

    for one in wanted(experiment["observables"]):
        one.make(system_of(scene, experiment))
