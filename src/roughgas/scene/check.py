"""Whether the points of an experiment could be simulated at all."""

from collections.abc import Mapping
from typing import Any

from roughgas.base.errors import InputError
from roughgas.kernel import hooks
from roughgas.scene.composition import build, check_company
from roughgas.scene.initial import lattice


def check(experiment: Mapping[str, Any]) -> None:
    """Raise InputError where no point of the experiment could be simulated."""
    scene = build(experiment, 0.5, 0.0 if "spin" in experiment["effects"] else -1.0)
    check_company(scene, experiment)
    lattice(scene, experiment)
    if "target_stderr" in experiment and scene.effects.spin is None:
        value = experiment["target_stderr"]
        raise InputError("target_stderr", value, "not be given where nothing spins: R is 0")
    if "schedule" in experiment:
        _check_schedule(scene.effects, experiment["schedule"]["kind"])


def _check_schedule(effects, kind):
    drives = [effects._fields[part.place] for part in hooks.present(effects, "drives")]
    if kind == "cooling" and drives:
        legal = f"be steady where there is a drive: {', '.join(drives)}"
        raise InputError("schedule.kind", kind, legal)
    if kind == "steady" and not drives:
        raise InputError("schedule.kind", kind, "be cooling where no effect drives the gas")
