"""Kinds of schedule: all that depends on whether a gas is driven or cools, by one look-up."""

from collections.abc import Mapping, Sequence
from typing import Any, Protocol

from roughgas import scene
from roughgas.base.errors import InputError
from roughgas.kernel import hooks
from roughgas.scene import Scene
from roughgas.simulation import cooling, steady
from roughgas.simulation.ends import Initial
from roughgas.simulation.energies import Columns
from roughgas.simulation.gas import Gas, Recorder


class Kind(Protocol):
    """What a module of this room says of schedules of its kind."""

    DRIVEN: bool  # whether effects drive the gas; else progress is counted in collisions
    UNIT: str  # of lengths
    LENGTH: str  # key of the schedule: how long R is measured

    def length(self, scene: Scene, schedule: Mapping[str, Any]) -> float:
        """Return how much a point simulates, in UNIT."""

    def start(
        self, scene: Scene, experiment: Mapping[str, Any], seed: Any, recorder=None, initial=()
    ) -> Gas:
        """Return the gas of a point, the first of several, as its time begins to count."""

    def sample(self, gas: Gas, every: float, samples: int) -> Columns:
        """Advance a gas; return columns, sampled at intervals of `every` UNIT."""

    def run(
        self,
        scene: Scene,
        experiment: Mapping[str, Any],
        seed: int,
        recorder: Recorder,
        initial: Sequence[Initial] = (),
    ) -> dict[str, Any]:
        """Return the variables of a point (see roughgas.data.point)."""


KINDS: dict[str, Kind] = {"steady": steady, "cooling": cooling}


def of(experiment: Mapping[str, Any]) -> Kind:
    """Return the kind of an experiment's schedule."""
    return KINDS[experiment["schedule"]["kind"]]


def measured(schedule: Mapping[str, Any]) -> float:
    """Return how long R is measured in a run, all its replicas together."""
    return schedule.get("replicas", 1) * schedule[KINDS[schedule["kind"]].LENGTH]


def check(experiment: Mapping[str, Any]) -> None:
    """Raise InputError if no point of the experiment could be simulated."""
    effects = scene.check(experiment).effects
    drives = [effects._fields[part.place] for part in hooks.present(effects, "drives")]
    kind = experiment["schedule"]["kind"]
    if drives and not KINDS[kind].DRIVEN:
        legal = f"be steady where there is a drive: {', '.join(drives)}"
        raise InputError("schedule.kind", kind, legal)
    if KINDS[kind].DRIVEN and not drives:
        raise InputError("schedule.kind", kind, "be cooling where no effect drives the gas")
