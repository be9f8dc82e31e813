"""The particles of a mixture: what each one is, drawn with a generator of their own.

That of positions and velocities is left as it is: particles of several species that are alike in
all things begin as those of one.
"""

import math
from collections.abc import Mapping
from typing import Any

import numpy as np

from roughgas import theory
from roughgas.base import InputError
from roughgas.effects.species import Mixture, mixture_of
from roughgas.kernel.state import Bodies
from roughgas.scene.scene import Scene, check_box


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
