"""What is simulated: a box, its particles' material, and the effects that act. Computes nothing.

Units: particle radius a = particle mass m = time unit T = 1.
"""

import math
from collections.abc import Mapping
from typing import Any, NamedTuple

from roughgas.effects import Effects
from roughgas.effects.settings import Surroundings
from roughgas.errors import InputError

DIAMETER = 2.0
# Of a periodic box, in a: below two diameters a particle could meet two images of another, and a
# little above that contacts are foreseen for moments only
NARROWEST = 4.01
NARROWEST_CHANNEL = 2.01  # between side walls, in a
FAR_APART = 8.0  # nothing comes round at walls: those nearer than this shorten no outlook


class Scene(NamedTuple):
    """A scene as the kernel takes it; what is None is compiled away."""

    box: tuple[float | None, ...]  # period of each axis in a, None where it has none
    restitution: float
    roughness: float
    effects: Effects
    extent: float  # least distance after which something comes round: a period or a width, in a
    middle: float  # height that the mean flow vanishes at, in a


def build(experiment: Mapping[str, Any], r: float, beta: float) -> Scene:
    """The scene of an experiment's settings with particles of restitution r and roughness beta.

    Raises InputError for values that are illegal or contradict each other.
    """
    _check_range("restitution r", r, 0.0, 1.0)
    _check_range("roughness beta", beta, -1.0, 1.0)
    lengths = tuple(None if side == "open" else float(side) for side in experiment["box"])
    effects = _effects(experiment["effects"], Surroundings(lengths, float(r), float(beta)))
    _check_composition(lengths, effects)
    box = lengths if effects.walls is None else (None, *lengths[1:])
    return Scene(
        box=box,
        restitution=float(r),
        roughness=float(beta),
        effects=effects,
        extent=_extent(lengths, effects.walls),
        middle=0.0 if lengths[1] is None else lengths[1] / 2.0,
    )


def check(experiment: Mapping[str, Any]) -> None:
    """Raise InputError where no point of the experiment could be simulated."""
    from roughgas.initial import lattice

    scene = build(experiment, 0.5, 0.0)
    check_company(scene, experiment)
    lattice(scene, experiment)


def check_company(scene: Scene, experiment: Mapping[str, Any]) -> None:
    """Raise InputError where a single particle would rest in its box, and have no energy."""
    if experiment["particles"] == 1 and scene.effects.gravity is None:
        raise InputError("particles", 1, "be at least 2 where there is no floor to meet")


def _effects(settings, around):
    known = {f: t.__args__[0] for f, t in Effects.__annotations__.items()}
    for name in settings:
        if name not in known:
            raise InputError("effect", name, f"be one of {', '.join(known)}")
    return Effects(
        **{name: known[name].from_settings(chosen, around) for name, chosen in settings.items()}
    )


def _extent(lengths, walls):
    across = lengths[0] if walls is None else max(lengths[0], FAR_APART)
    return min(length for length in (across, *lengths[1:]) if length is not None)


def _check_range(key, value, low, high):
    if not low <= value <= high:  # NaN fails, too
        raise InputError(key, value, f"lie in [{low:g}, {high:g}]")


def _check_composition(lengths, effects):
    open_axes = [k for k, length in enumerate(lengths) if length is None]
    if open_axes not in ([], [len(lengths) - 1]):
        raise InputError("box", list(lengths), "be open along its last axis only")
    for k, length in enumerate(lengths):
        least = NARROWEST_CHANNEL if k == 0 and effects.walls is not None else NARROWEST
        if length is not None and not least <= length < math.inf:
            raise InputError(f"box[{k}]", length, f"be a number of at least {least:g}")
    if (effects.gravity is None) != (effects.floor is None):
        raise InputError("effects", "gravity or floor alone", "have both gravity and floor or none")
    if (effects.gravity is None) == bool(open_axes):
        raise InputError("box", list(lengths), "be open above exactly where there is gravity")
    if effects.walls is not None and effects.shear is not None:
        raise InputError("effects", "walls and shear", "not close the axis that is sheared along")
