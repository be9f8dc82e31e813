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
NARROWEST = 2.0 * DIAMETER  # a periodic box in which no particle can meet two images of another


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
        extent=min(length for length in lengths if length is not None),
        middle=0.0 if lengths[1] is None else lengths[1] / 2.0,
    )


def check(experiment: Mapping[str, Any]) -> None:
    """Raise InputError where no point of the experiment could be simulated."""
    from roughgas.initial import lattice

    lattice(build(experiment, 0.5, 0.0), experiment)


def _effects(settings, around):
    known = {f: t.__args__[0] for f, t in Effects.__annotations__.items()}
    for name in settings:
        if name not in known:
            raise InputError("effect", name, f"be one of {', '.join(known)}")
    return Effects(
        **{name: known[name].from_settings(chosen, around) for name, chosen in settings.items()}
    )


def _check_range(key, value, low, high):
    if not low <= value <= high:  # NaN fails, too
        raise InputError(key, value, f"lie in [{low:g}, {high:g}]")


def _check_composition(lengths, effects):
    open_axes = [k for k, length in enumerate(lengths) if length is None]
    if open_axes not in ([], [len(lengths) - 1]):
        raise InputError("box", list(lengths), "be open along its last axis only")
    for k, length in enumerate(lengths):
        if length is not None and not NARROWEST < length < math.inf:
            raise InputError(f"box[{k}]", length, f"be more than {NARROWEST:g} (two diameters)")
    if (effects.gravity is None) != (effects.floor is None):
        raise InputError("effects", "gravity or floor alone", "have both gravity and floor or none")
    if (effects.gravity is None) == bool(open_axes):
        raise InputError("box", list(lengths), "be open above exactly where there is gravity")
    if effects.walls is not None and effects.shear is not None:
        raise InputError("effects", "walls and shear", "not close the axis that is sheared along")
