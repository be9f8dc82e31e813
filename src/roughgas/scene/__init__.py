"""A scene: a box, the material of its particles, and the active effects, built from settings.

Also the checks of combinations of walls, and the random bodies of a mixture. Bodies are drawn with
a separate generator: positions and velocities do not depend on them, so that several equal species
start in the same state as a single one.

Units: particle radius a = particle mass m = time unit T = 1. Symbols: r, the normal restitution;
beta, the roughness; q = I/(m a^2), the reduced moment of inertia; mu, the coefficient of friction;
R = E_rot/(E_rot + E_trans), the rotational share of the kinetic energy; D, the dimension.
"""

import math
from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np
from msgspec import to_builtins

from roughgas import theory
from roughgas.base import RESTITUTION, ROUGHNESS, InputError, NeedsError
from roughgas.effects import Effects, build_effects, effects_tuple
from roughgas.effects.bath import Rotation
from roughgas.effects.gravity import BodyForce
from roughgas.effects.settings import SceneContext
from roughgas.effects.species import Mixture, mixture_of
from roughgas.effects.walls import Floor, Wall
from roughgas.kernel import hooks
from roughgas.kernel.scheme import CHEAPEST, LISTS, SCHEMES
from roughgas.kernel.state import Bodies
from roughgas.scene.settings import SceneSettings

OPPOSITE_WALLS = (("left_wall", "right_wall"), ("front_wall", "back_wall"), ("bottom_wall", "lid"))


def check_sides(effects: Effects) -> None:
    """Raise InputError for walls on sides of the box that do not belong together.

    These are a side that is closed twice, an axis that is closed at one end only, and a wall on a
    side where shear has sliding images.
    """
    closed: dict[tuple[int, int], str] = {}
    for name, wall in _side_walls(effects).items():
        if effects.shear is not None and wall.axis < 2:
            legal = "not close the axis that is sheared along"
            if wall.axis == 1:
                legal = "not close the axis along which images slide past each other"
            raise InputError("effects", f"{name} and shear", legal)
        for end in wall.ends:
            if (first := closed.setdefault((wall.axis, end), name)) != name:
                raise InputError("effects", f"{first} and {name}", "not close the same axis twice")
    for name, opposite in (order for pair in OPPOSITE_WALLS for order in (pair, pair[::-1])):
        is_closed = getattr(effects, opposite) or (opposite == "bottom_wall" and effects.floor)
        if getattr(effects, name) is not None and not is_closed:
            raise NeedsError(f"effects.{name}", opposite)


def walls_drive_flow(effects: Effects) -> bool:
    """Return whether walls on the second axis move along the first, which makes the gas flow."""
    return any(wall.axis == 1 and wall.velocity != 0.0 for wall in _side_walls(effects).values())


def assumes_flow(effects: Effects) -> bool:
    """Return whether the energies in R are relative to a mean flow between sliding images or walls.

    The flow is a linear velocity profile.
    """
    return effects.shear is not None or walls_drive_flow(effects)


def rotation_of_medium(effects: Effects) -> Rotation | None:
    """Return the rotation of a bath's medium, to which its drag leads spins; None without one.

    The rotational energy in R is then relative to the mean spin of each species.
    """
    return None if effects.langevin is None else effects.langevin.rotation


def has_single_walls(effects: Effects) -> bool:
    """Return whether there are walls on single sides of the box, the floor not counted."""
    return any(len(wall.ends) == 1 for wall in _side_walls(effects).values())


def walls_of(effects: Effects) -> dict[str, Wall]:
    """Return all walls by name, among them the floor."""
    named = zip(effects._fields, effects, strict=True)
    return {name: effect for name, effect in named if isinstance(effect, Wall)}


def _side_walls(effects):
    """Return all walls by name, without the floor."""
    walls = walls_of(effects).items()
    return {name: wall for name, wall in walls if not isinstance(wall, Floor)}


DIAMETER = 2.0
# Minimum of a periodic side, in a: below two diameters a particle could meet two images of another,
# and at little more the horizon of predictions is very short
MIN_PERIOD = 4.01
MIN_CHANNEL_WIDTH = 2.01  # between side walls, in a
MAX_SIDE = 1e9  # of a box, in a: a product of three sides can still be squared
MIN_EXTENT = 8.0  # of an axis closed by walls, in a: without images it need not limit horizons


class Scene(NamedTuple):
    """A scene in the form that the kernel uses; code for fields that are None is removed."""

    box: tuple[float | None, ...]  # period of each axis in a, None if not periodic
    restitution: float
    roughness: float
    effects: Effects
    extent: float  # minimum of the box's periods and widths, in a
    middle: float  # height at which the mean flow vanishes, in a
    scheme: int = CHEAPEST  # how candidates for contacts are found, as in kernel/scheme.py


def shear_rate(scene: Scene) -> float:
    """Return the shear rate Gamma, the velocity gradient, in 1/T; 0 without shear."""
    shear = scene.effects.shear
    return 0.0 if shear is None else shear.velocity / (2.0 * scene.middle)


def build(experiment: SceneSettings, r: float, beta: float) -> Scene:
    """Return the scene of an experiment, with particles of restitution r and roughness beta.

    Raises InputError for values that are illegal or contradict each other.
    """
    RESTITUTION.check("restitution r", r)
    ROUGHNESS.check("roughness beta", beta)
    lengths = experiment.lengths
    mixture = mixture_of(experiment)
    effects = _effects(experiment, float(r), float(beta), mixture)
    if effects.spin is None and beta != -1.0:
        raise InputError("roughness beta", beta, "be -1 where particles do not spin")
    closed = closed_axes(effects)
    _check_axes(lengths, effects)
    _check_gravity(effects)
    check_sides(effects)
    largest = 1.0 if mixture is None else mixture.largest()
    check_box(lengths, effects, largest)
    _check_single_particle(experiment.particles, effects)
    extents = [
        max(length, MIN_EXTENT * largest) if axis in closed else length
        for axis, length in enumerate(lengths)
        if length is not None
    ]
    return Scene(
        box=tuple(None if axis in closed else length for axis, length in enumerate(lengths)),
        restitution=float(r),
        roughness=float(beta),
        effects=effects,
        extent=min(extents),
        middle=0.0 if lengths[1] is None else lengths[1] / 2.0,
        scheme=_scheme(experiment, effects),
    )


def _scheme(experiment, effects):
    """Return the scheme that finds candidates; raise InputError for lists under shear."""
    chosen = SCHEMES.index(experiment.neighbours)
    if chosen == LISTS and effects.shear is not None:
        legal = "be cheapest, sweep or cells where images slide past each other"
        raise InputError("neighbours", experiment.neighbours, legal)
    return chosen


def elastic(scene: Scene) -> Scene:
    """Return the scene with smooth elastic particles and side walls, for a thermalisation.

    r = 1 and beta = -1, also between species. Contacts are not logged.
    """
    smooth: Mapping[str, Any] = {"restitution": 1.0, "roughness": -1.0}
    effects = scene.effects
    changes = {name: wall._replace(**smooth) for name, wall in _side_walls(effects).items()}
    if effects.species is not None:
        changes["species"] = effects.species._replace(same_material=True)
    if effects.contact_log is not None:
        changes["contact_log"] = effects.contact_log._replace(on=False)
    return scene._replace(effects=effects._replace(**changes), **smooth)


def closed_axes(effects: Effects) -> set[int]:
    """Return the axes of the box that are closed by walls, counted from 0."""
    return {wall.axis for wall in _side_walls(effects).values()}


def conserves_momentum(scene: Scene) -> bool:
    """Return whether the total momentum is conserved.

    Random kicks act on pairs and conserve it; events of other effects may not. Nor does it count as
    conserved under shear: flow and mean spin are subtracted there, so that neither translation nor
    rotation has the degrees of freedom of all N particles (see roughgas.simulation.energies).
    """
    effects = scene.effects
    changing = {effects._fields[hook.effect_index] for hook in hooks.active(effects, "resolve")}
    return effects.gravity is None and effects.shear is None and changing <= {"thermostat"}


def wall_strokes(effects: Effects, dimension: int) -> np.ndarray:
    """Return the heights of the strokes of the walls at the low and the high end of each axis.

    Shape (D, 2), in particle radii a, into the box; 0 except for walls that are shaken along their
    normal, as a floor is.
    """
    amplitudes = np.zeros((dimension, 2))
    for wall in walls_of(effects).values():
        if wall.motion is not None:
            amplitudes[wall.axis, wall.ends] = wall.motion.amplitude
    return amplitudes


def check_box(lengths: Sequence[float | None], effects: Effects, largest: float) -> None:
    """Raise InputError for sides of the box too short for the largest radius, or above MAX_SIDE.

    `lengths` has the side of each axis, None along an open one; `largest` is the radius. Both are
    in particle radii a.
    """
    closed, strokes = closed_axes(effects), wall_strokes(effects, len(lengths)).sum(axis=1)
    for k, length in enumerate(lengths):
        min_length = (MIN_CHANNEL_WIDTH if k in closed else MIN_PERIOD) * largest + strokes[k]
        if length is not None and length > MAX_SIDE:
            raise InputError(f"box[{k}]", length, f"be at most {MAX_SIDE:g}")
        if length is not None and not min_length <= length:
            raise InputError(f"box[{k}]", length, f"be a number of at least {min_length:g}")


def _effects(experiment, r, beta, mixture):
    """Return the Effects of a scene from its SceneSettings, and its mixture or None.

    r and beta are the point's.
    """
    settings = experiment.effects
    context = SceneContext(
        experiment.lengths,
        r,
        beta,
        settings,
        *(
            () if mixture is None else mixture.values_set(quantity)
            for quantity in ("restitution", "roughness")
        ),
        tuple(species.spin_velocity for species in experiment.species),
        experiment.particles,
    )
    effects = build_effects(settings, context)
    return effects_tuple(effects | {"species": None if mixture is None else mixture.effect()})


def _check_axes(lengths, effects):
    """Raise InputError for open axes and a floor that do not belong together."""
    open_axes = [k for k, length in enumerate(lengths) if length is None]
    if open_axes not in ([], [len(lengths) - 1]):
        raise InputError("box", list(lengths), "be open along its last axis only")
    if effects.gravity is None and effects.floor is not None:
        raise NeedsError("effects.floor", "gravity")
    if (effects.floor is None or effects.lid is not None) == bool(open_axes):
        legal = "be open at the top if and only if there is a floor without a lid"
        raise InputError("box", list(lengths), legal)


def _check_gravity(effects):
    """Raise InputError for gravity in a direction that does not suit floor, walls or shear."""
    gravity = effects.gravity
    if gravity is None:
        return
    key, direction = "effects.gravity.direction", gravity.direction
    if effects.floor is not None and not gravity.along.get(effects.floor.axis, 0.0) < 0.0:
        raise InputError(key, direction, "point towards the floor")
    if effects.shear is not None and isinstance(gravity, BodyForce):
        raise InputError(key, direction, "be down the last axis where images slide past each other")
    for name, wall in _side_walls(effects).items():
        if wall.motion is not None and wall.axis in gravity.along and name != "lid":
            legal = "be along where gravity has a component across the wall"
            raise InputError(f"effects.{name}.shaken", "normal", legal)


def _check_single_particle(particles, effects):
    """Raise InputError for a single particle without a floor; `particles` is the number."""
    if particles == 1 and effects.floor is None:
        raise InputError("particles", 1, "be at least 2 where there is no floor to meet")


def draw_bodies(scene: Scene, experiment: SceneSettings, rng: np.random.Generator) -> Bodies | None:
    """Return the bodies of a mixture, in random order; None if all particles are alike.

    `rng` is the generator of the run's seed, which spawns a separate one for the bodies. Raises
    InputError if the box is too small for the largest particle.
    """
    mixture = mixture_of(experiment)
    if mixture is None:
        return None
    (body_rng,) = rng.spawn(1)
    radius = np.concatenate([kind.radii(body_rng) for kind in mixture.kinds])
    species = np.repeat(np.arange(len(mixture.kinds)), [kind.number for kind in mixture.kinds])
    order = body_rng.permutation(len(species))
    return _bodies(mixture, scene, experiment, radius[order], species[order])


def theory_mixture(scene: Scene, experiment: SceneSettings) -> theory.Mixture | None:
    """Return the species of an experiment as a theory.Mixture; None if all particles are alike.

    Restitution, roughness, friction and inertia that species do not set are the scene's.
    """
    if not experiment.species:
        return None
    friction, spin = scene.effects.friction, scene.effects.spin
    return theory.mixture(
        to_builtins(experiment.species),
        scene.restitution,
        scene.roughness,
        len(scene.box),
        None if spin is None else spin.inertia,
        math.inf if friction is None else friction.mu,
        to_builtins(experiment.species_pairs),
    )


def build_bodies(
    scene: Scene, experiment: SceneSettings, radius: np.ndarray, species: np.ndarray
) -> Bodies:
    """Return the bodies of a mixture with these radii (N,), in particle radii a, and species (N,).

    Species count from 0. Raises InputError if the numbers of particles differ from the
    experiment's, and for radii that are not positive.
    """
    mixture = mixture_of(experiment)
    assert mixture is not None
    numbers = [kind.number for kind in mixture.kinds]
    counts = np.bincount(np.maximum(species, 0), minlength=len(numbers)).tolist()
    if counts != numbers or species.min() < 0:
        raise InputError("initial.species", f"{counts} particles of each", f"be {numbers} of each")
    if not (np.isfinite(radius) & (radius > 0.0)).all():
        raise InputError("initial.radius", radius.min(), "be positive")
    return _bodies(mixture, scene, experiment, radius, species)


def _bodies(mixture: Mixture, scene, experiment, radius, species):
    """Return the Bodies of a mixture, with its species' masses, moments of inertia and materials.

    `radius` (N,) is in particle radii a; `species` (N,) counts from 0. Raises InputError if the box
    is too small for the largest radius.
    """
    check_box(experiment.lengths, scene.effects, float(radius.max()))
    effects = scene.effects
    q = 1.0 if effects.spin is None else effects.spin.inertia
    mass, inertia = radius ** len(scene.box), np.full(len(radius), q)
    for k, kind in enumerate(mixture.kinds):
        members = species == k
        mass[members] = mass[members] if kind.mass is None else kind.mass
        inertia[members] = q if kind.inertia is None else kind.inertia
    common = {
        "restitution": scene.restitution,
        "roughness": scene.roughness,
        "mu": np.nan if effects.friction is None else effects.friction.mu,
    }
    return Bodies(radius, mass, inertia, species, radius.max(keepdims=True), mixture.table(common))
