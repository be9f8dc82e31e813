"""A scene: a box, the material of its particles, and the effects that act, built from settings.

Which walls go together, and what each particle of a mixture is, drawn with a generator of its own:
that of positions and velocities is left as it is, so that particles of several species that are
alike in all things begin as those of one.

Units: particle radius a = particle mass m = time unit T = 1.
"""

import math
from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np

from roughgas import theory
from roughgas.base import RESTITUTION, ROUGHNESS, InputError, NeedsError
from roughgas.effects import KINDS, Effects
from roughgas.effects.settings import SceneContext, make
from roughgas.effects.species import Mixture, mixture_of
from roughgas.effects.walls import Floor, Wall
from roughgas.kernel.state import Bodies

OPPOSITE = (("left_wall", "right_wall"), ("front_wall", "back_wall"), ("bottom_wall", "lid"))


def check_sides(effects: Effects) -> None:
    """Raise InputError for a side that is closed twice, or an axis that is closed at one end only,
    and for walls where images slide."""
    closed: dict[tuple[int, int], str] = {}
    for name, wall in _closing(effects).items():
        if effects.shear is not None and wall.axis < 2:
            legal = "not close the axis that is sheared along"
            if wall.axis == 1:
                legal = "not close the axis along which images slide past each other"
            raise InputError("effects", f"{name} and shear", legal)
        for end in wall.ends:
            if (other := closed.setdefault((wall.axis, end), name)) != name:
                raise InputError("effects", f"{other} and {name}", "not close the same axis twice")
    for name, other in (way for pair in OPPOSITE for way in (pair, pair[::-1])):
        there = getattr(effects, other) or (other == "bottom_wall" and effects.floor)
        if getattr(effects, name) is not None and not there:
            raise NeedsError(f"effects.{name}", other)


def moves_along(effects: Effects) -> bool:
    """Return whether walls that close the second axis move along the first, so that gas flows."""
    return any(wall.axis == 1 and wall.velocity != 0.0 for wall in _closing(effects).values())


def assumes_flow(effects: Effects) -> bool:
    """Return whether R leaves out a mean flow, a straight line: between images or walls that move
    along themselves."""
    return effects.shear is not None or moves_along(effects)


def has_sides(effects: Effects) -> bool:
    """Return whether there are walls on single sides of the box."""
    return any(len(wall.ends) == 1 for wall in _closing(effects).values())


def walls_of(effects: Effects) -> dict[str, Wall]:
    """Return all walls by name, and the floor."""
    named = zip(effects._fields, effects, strict=True)
    return {name: one for name, one in named if isinstance(one, Wall)}


def _closing(effects):
    walls = walls_of(effects).items()
    return {name: wall for name, wall in walls if not isinstance(wall, Floor)}


DIAMETER = 2.0
# Of a periodic box, in a: below two diameters a particle could meet two images of another, and a
# little above that contacts are foreseen for moments only
NARROWEST = 4.01
NARROWEST_CHANNEL = 2.01  # between side walls, in a
LONGEST = 1e9  # side of a box, in a: products of three still leave room for squares
CELLS, LISTS = "cells", "lists"  # where particles look for their neighbours
FAR_APART = 8.0  # of side walls, in a: nothing comes round there, however near they are


class Scene(NamedTuple):
    """A scene as the kernel takes it; what is None is compiled away."""

    box: tuple[float | None, ...]  # period of each axis in a, None where it has none
    restitution: float
    roughness: float
    effects: Effects
    extent: float  # least distance after which something comes round: a period or a width, in a
    middle: float  # height at which the mean flow vanishes, in a
    lists: bool = False  # whether many particles keep lists of their neighbours


def shear_rate(scene: Scene) -> float:
    """Return Gamma in 1/T, 0 where nothing shears the gas."""
    shear = scene.effects.shear
    return 0.0 if shear is None else shear.velocity / (2.0 * scene.middle)


def build(experiment: Mapping[str, Any], r: float, beta: float) -> Scene:
    """Return the scene of an experiment, with particles of restitution r and roughness beta.

    Raises InputError for values that are illegal or contradict each other.
    """
    RESTITUTION.check("restitution r", r)
    ROUGHNESS.check("roughness beta", beta)
    lengths = tuple(None if side == "open" else float(side) for side in experiment["box"])
    mixture = mixture_of(experiment)
    asked_for = dict(experiment["effects"])
    if experiment.get("observables"):
        from roughgas.observables import effects_of  # imported where they are wanted

        asked_for = effects_of(experiment["observables"]) | asked_for
    effects = _effects(asked_for, lengths, float(r), float(beta), mixture)
    if effects.spin is None and beta != -1.0:
        raise InputError("roughness beta", beta, "be -1 where particles do not spin")
    closed = closed_axes(effects)
    _check_axes(lengths, effects)
    check_sides(effects)
    largest = 1.0 if mixture is None else mixture.largest()
    check_box(lengths, effects, largest)
    _check_company(experiment.get("particles"), effects)
    # walls that are near shorten no outlook
    across = [
        max(length, FAR_APART * largest) if axis in closed else length
        for axis, length in enumerate(lengths)
        if length is not None
    ]
    return Scene(
        box=tuple(None if axis in closed else length for axis, length in enumerate(lengths)),
        restitution=float(r),
        roughness=float(beta),
        effects=effects,
        extent=min(across),
        middle=0.0 if lengths[1] is None else lengths[1] / 2.0,
        lists=_keeps_lists(experiment, effects),
    )


def _keeps_lists(experiment, effects):
    found = experiment.get("neighbours", CELLS)
    if found == LISTS and effects.shear is not None:
        raise InputError("neighbours", found, f"be {CELLS} where images slide past each other")
    return found == LISTS


def elastic(scene: Scene) -> Scene:
    """Return the scene with smooth elastic particles, and walls if it has any."""
    smooth: Mapping[str, Any] = {"restitution": 1.0, "roughness": -1.0}
    effects = scene.effects
    changes = {name: wall._replace(**smooth) for name, wall in _closing(effects).items()}
    if effects.species is not None:
        changes["species"] = effects.species._replace(alike=True)
    if effects.contact_log is not None:
        changes["contact_log"] = effects.contact_log._replace(on=False)
    return scene._replace(effects=effects._replace(**changes), **smooth)


def closed_axes(effects: Effects) -> set[int]:
    """Return the axes of the box that walls close."""
    return {wall.axis for wall in _closing(effects).values()}


def conserves_momentum(scene: Scene) -> bool:
    """Return whether nothing but the particles themselves changes their momenta.

    Random kicks go to pairs, and conserve the momentum. Of a sheared gas flow and mean spin are
    removed, so that neither motion has all N (see roughgas.simulation.energies).
    """
    effects = scene.effects
    apart = effects.gravity, effects.shear, effects.langevin
    return not closed_axes(effects) and all(one is None for one in apart)


def strokes(effects: Effects, dimension: int) -> np.ndarray:
    """Return how far walls at the low and the high end of each axis come into the box, in a.

    Those that do are shaken along their normal, as a floor is; shape (D, 2).
    """
    found = np.zeros((dimension, 2))
    for wall in walls_of(effects).values():
        if wall.motion is not None:
            found[wall.axis, wall.ends] = wall.motion.amplitude
    return found


def check_box(lengths: Sequence[float | None], effects: Effects, largest: float) -> None:
    """Raise InputError where sides of the box are too short for particles of the largest radius."""
    closed, taken = closed_axes(effects), strokes(effects, len(lengths)).sum(axis=1)
    for k, length in enumerate(lengths):
        least = (NARROWEST_CHANNEL if k in closed else NARROWEST) * largest + taken[k]
        if length is not None and length > LONGEST:
            raise InputError(f"box[{k}]", length, f"be at most {LONGEST:g}")
        if length is not None and not least <= length:
            raise InputError(f"box[{k}]", length, f"be a number of at least {least:g}")


def _effects(settings, lengths, r, beta, mixture):
    own = () if mixture is None else (mixture.own("restitution"), mixture.own("roughness"))
    around = SceneContext(lengths, r, beta, settings, *own)
    for name in settings:
        if name not in KINDS:
            raise InputError("effect", name, f"be one of {', '.join(KINDS)}")
    there = {name: kind for name, kind in KINDS.items() if name in settings}
    made = {name: make(kind, name, settings[name], around) for name, kind in there.items()}
    return Effects(**made, species=None if mixture is None else mixture.effect())


def _check_axes(lengths, effects):
    """Refuse a top or walls that do not suit the effects."""
    open_axes = [k for k, length in enumerate(lengths) if length is None]
    if open_axes not in ([], [len(lengths) - 1]):
        raise InputError("box", list(lengths), "be open along its last axis only")
    if effects.gravity is None and effects.floor is not None:
        raise NeedsError("effects.floor", "gravity")
    if effects.gravity is not None and effects.floor is None:
        raise NeedsError("effects.gravity", "a floor")
    if (effects.gravity is None or effects.lid is not None) == bool(open_axes):
        legal = "be open at the top if and only if there is gravity"
        raise InputError("box", list(lengths), legal)


def _check_company(particles, effects):
    """Refuse a single particle that would rest in its box, or have no partner for kicks."""
    if particles == 1 and effects.gravity is None:
        raise InputError("particles", 1, "be at least 2 where there is no floor to meet")
    if particles == 1 and effects.thermostat is not None:
        raise InputError("particles", 1, "be at least 2 where a thermostat kicks pairs")


def draw_bodies(
    scene: Scene, experiment: Mapping[str, Any], rng: np.random.Generator
) -> Bodies | None:
    """Return what each particle is, in random order; None where all are alike.

    Raises InputError where the box is too small for the largest.
    """
    mixture = mixture_of(experiment)
    if mixture is None:
        return None
    (own,) = rng.spawn(1)
    radius = np.concatenate([kind.radii(own) for kind in mixture.kinds])
    species = np.repeat(np.arange(len(mixture.kinds)), [kind.number for kind in mixture.kinds])
    order = own.permutation(len(species))
    return _bodies(mixture, scene, experiment, radius[order], species[order])


def for_theory(scene: Scene, experiment: Mapping[str, Any]) -> theory.Mixture | None:
    """Return the species as theory takes them; None where all particles are alike."""
    if not experiment.get("species"):
        return None
    friction, spin = scene.effects.friction, scene.effects.spin
    return theory.mixture(
        experiment["species"],
        scene.restitution,
        scene.roughness,
        len(scene.box),
        None if spin is None else spin.inertia,
        math.inf if friction is None else friction.mu,
        experiment.get("species_pairs") or (),
    )


def given_bodies(
    scene: Scene, experiment: Mapping[str, Any], radius: np.ndarray, species: np.ndarray
) -> Bodies:
    """Return the same of particles with these radii (N,), in a, and species (N,), from 0.

    Raises InputError where these are not the species of the experiment.
    """
    mixture = mixture_of(experiment)
    assert mixture is not None
    numbers = [kind.number for kind in mixture.kinds]
    found = np.bincount(np.maximum(species, 0), minlength=len(numbers)).tolist()
    if found != numbers or species.min() < 0:
        raise InputError("initial.species", f"{found} particles of each", f"be {numbers} of each")
    if not (np.isfinite(radius) & (radius > 0.0)).all():
        raise InputError("initial.radius", radius.min(), "be positive")
    return _bodies(mixture, scene, experiment, radius, species)


def _bodies(mixture: Mixture, scene, experiment, radius, species):
    sides = [None if side == "open" else float(side) for side in experiment["box"]]
    check_box(sides, scene.effects, float(radius.max()))
    effects = scene.effects
    q = 1.0 if effects.spin is None else effects.spin.inertia
    mass, inertia = radius ** len(scene.box), np.full(len(radius), q)
    for k, kind in enumerate(mixture.kinds):
        here = species == k
        mass[here] = mass[here] if kind.mass is None else kind.mass
        inertia[here] = q if kind.inertia is None else kind.inertia
    common = {
        "restitution": scene.restitution,
        "roughness": scene.roughness,
        "mu": np.nan if effects.friction is None else effects.friction.mu,
    }
    return Bodies(radius, mass, inertia, species, radius.max(keepdims=True), mixture.table(common))
