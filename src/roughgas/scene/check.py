"""Whether the points of an experiment could be simulated at all."""

from collections.abc import Mapping
from typing import Any

from roughgas.base.errors import InputError
from roughgas.scene.composition import Scene, build
from roughgas.scene.initial import lattice


def check(experiment: Mapping[str, Any]) -> Scene:
    """Return the scene of some point. Raises InputError where no point could be simulated."""
    scene = build(experiment, 0.5, 0.0 if "spin" in experiment["effects"] else -1.0)
    lattice(scene, experiment)
    if "target_stderr" in experiment and scene.effects.spin is None:
        value = experiment["target_stderr"]
        raise InputError("target_stderr", value, "not be given where nothing spins: R is 0")
    return scene
