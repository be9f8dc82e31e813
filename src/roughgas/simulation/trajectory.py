"""The trajectory of a point as variables of a dataset: all particles at chosen times."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from roughgas.scene import Scene
from roughgas.simulation.by_species import names
from roughgas.simulation.snapshots import Snapshot

MOVED = {"image_shift": "slide", "floor_height": "floor", "wall_displacement": "walls"}
"""Variables of a trajectory that have other names in a Snapshot."""
OF_EACH = ("time", "position", "velocity", "spin", "angle", "E_trans", "E_rot", "R")


def variables(
    scene: Scene, experiment: Mapping[str, Any], shots: Sequence[Snapshot]
) -> dict[str, Any]:
    """Return the variables of a trajectory (see roughgas.data.trajectory) with these snapshots."""
    dimension = len(scene.box)
    names = {name: name for name in OF_EACH} | MOVED
    names["collisions_per_particle"] = "collisions"
    parts = {name: [getattr(shot, field) for shot in shots] for name, field in names.items()}
    lengths = [np.nan if side == "open" else float(side) for side in experiment["box"]]
    return {name: np.array(part) for name, part in parts.items() if part[0] is not None} | {
        "axis": list("xyz"[:dimension]),
        "radius": shots[0].radius(),
        **_bodies(shots[0], experiment),
        "box": np.array(lengths),
        "periodic": np.array([length is not None for length in scene.box], "i1"),
    }


def _bodies(shot: Snapshot, experiment: Mapping[str, Any]) -> dict[str, Any]:
    """Return what else each particle is, where they differ."""
    if shot.bodies is None:
        return {}
    return names(experiment) | {
        "mass": shot.bodies.mass,
        "inertia": shot.bodies.inertia,
        "species_of": shot.bodies.species,
    }
