"""Whether a run can begin in given states: their particles, and the seed that was chosen for it."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from roughgas.base import InputError
from roughgas.effects.drives import first_kicks
from roughgas.effects.species import mixture_of
from roughgas.kernel import hooks
from roughgas.scene import Scene, given_bodies
from roughgas.scene.initial import check_places
from roughgas.simulation.restart import (
    CARRIED,
    OF_BODIES,
    OF_SETTINGS,
    SEED,
    Initial,
    is_memory_of,
)

SINGLE = 1e-6  # relative deviation of a radius, or a mass, that single precision makes


def prepared(
    initial: Sequence[Initial], experiment: Mapping[str, Any], scene: Scene, seed: int
) -> list[Initial]:
    """Return the initial states of a run, their species numbered as in the experiment.

    Raises InputError where the run could not begin with them, or would not depend on a seed that
    was chosen for it.
    """
    states = [_renumbered(state, experiment) for state in initial]
    check_initial(states, experiment, scene)
    for state in states:
        _check_seed(state, scene, seed)
    return states


def _renumbered(initial, experiment):
    """Return a state whose species have the numbers of the experiment's species of these names."""
    mixture = mixture_of(experiment)
    if mixture is None or initial.species is None or not initial.names:
        return initial
    names = tuple(kind.name for kind in mixture.kinds)
    if {*initial.names} != {*names}:
        legal = f"be those of the experiment: {', '.join(names)}"
        raise InputError("initial.species", ", ".join(initial.names), legal)
    if initial.names == names:
        return initial
    if initial.species.max() >= len(names):
        legal = f"be below {len(names)}, the number of species"
        raise InputError("initial.species_of", initial.species.max(), legal)
    numbers = np.array([names.index(name) for name in initial.names], float)
    return initial._replace(species=numbers[initial.species.astype(int)], names=names)


def check_initial(initial: Sequence[Initial], experiment: Mapping[str, Any], scene: Scene) -> None:
    """Raise InputError where a run of this scene could not begin with these states."""
    replicas = experiment["schedule"].get("replicas", 1)
    if len(initial) != replicas:
        raise InputError("number of initial states", len(initial), f"be {replicas}, as replicas")
    if len({state.physics() for state in initial}) < len(initial):
        legal = "be another one for each replica: errors come from how replicas differ"
        raise InputError("initial", "with a state twice", legal)
    for state in initial:
        _check_vectors(state, experiment["particles"], scene)
        radius = _check_bodies(state, experiment, scene)
        if not is_memory_of(state, scene):
            check_places(scene, state.position, state.time, radius)


def _check_vectors(initial, number, scene):
    dimension = len(scene.box)
    widths = {"position": dimension, "velocity": dimension, "spin": 2 * dimension - 3}
    for name, width in widths.items():
        values = getattr(initial, name)
        if values is not None and values.shape != (number, width):
            legal = f"have the shape ({number}, {width}) in this scene"
            raise InputError(f"initial.{name}", f"of shape {values.shape}", legal)
    if initial.spin is not None and scene.effects.spin is None and np.any(initial.spin):
        raise InputError("initial.spin", "not zero", "not be there where particles do not spin")


def _check_bodies(initial, experiment, scene):
    """Check radii, species, masses and inertias; return the radii (N,), None where all are 1."""
    number, spin = experiment["particles"], scene.effects.spin
    if scene.effects.species is None:
        if initial.species is not None:
            legal = "not be there where the experiment has no species"
            raise InputError("initial.species_of", "there", legal)
        unit = {"radius": 1.0, "mass": 1.0, "inertia": 1.0 if spin is None else spin.inertia}
        _check_same(initial, {name: np.full(number, value) for name, value in unit.items()})
        return None
    for name, variable in OF_BODIES.items():
        values = getattr(initial, name)
        if values is None:
            legal = "be in the dataset where the experiment has species"
            raise InputError("initial", f"without {variable}", legal)
        if values.shape != (number,):
            legal = f"have the shape ({number},) in this scene"
            raise InputError(f"initial.{variable}", values.shape, legal)
    bodies = given_bodies(scene, experiment, *initial.bodies())
    _check_radii(*initial.bodies(), mixture_of(experiment))
    _check_same(initial, {name: getattr(bodies, name) for name in ("radius", *OF_SETTINGS)})
    return initial.radius


def _check_radii(radius, species, mixture):
    """Raise InputError for a particle with a radius that its species does not have."""
    for number, kind in enumerate(mixture.kinds):
        members = np.flatnonzero(species == number)
        wrong = members[~kind.admits(radius[members], SINGLE)]
        if len(wrong):
            key = f"initial.radius of particle {wrong[0]}, of species {kind.name}"
            raise InputError(key, radius[wrong[0]], "be one of its species, as in the settings")


def _check_same(initial, expected):
    """Raise InputError for a particle with another radius, mass or inertia than in the settings."""
    for name, values in {"radius": initial.radius, **initial.of_settings}.items():
        if values is None:
            continue
        wrong = np.flatnonzero(~np.isclose(values, expected[name], rtol=SINGLE, atol=0.0))
        if len(wrong):
            legal = f"be {expected[name][wrong[0]]:g}, as in the settings"
            raise InputError(f"initial.{name} of particle {wrong[0]}", values[wrong[0]], legal)


def _check_seed(initial, scene, seed):
    """Raise InputError for a seed that was chosen for this run and has no effect on it."""
    if initial.noise == CARRIED:
        return
    exact = is_memory_of(initial, scene)
    drawn = {part.own for part in hooks.present(scene.effects, "moment")}
    random = hooks.present(scene.effects, "random") or (not exact and first_kicks in drawn)
    if not random:
        legal = "be left out: nothing in this scene is random once its particles are there"
        raise InputError(initial.noise, seed, legal)
    if exact and initial.noise == SEED:
        legal = "be left out, as the run goes on with its own random numbers: reseed gives others"
        raise InputError(SEED, seed, legal)
