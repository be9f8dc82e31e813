"""Checks of initial states against an experiment: particles, species, radii, and the seed."""

from collections.abc import Iterator, Sequence
from contextlib import contextmanager

import numpy as np

from roughgas.base import InputError
from roughgas.effects.drives import first_kick_times
from roughgas.effects.species import mixture_of
from roughgas.kernel import hooks
from roughgas.scene import Scene, build_bodies
from roughgas.scene.initial import check_positions
from roughgas.simulation.experiment import Experiment
from roughgas.simulation.initial_states import (
    BODY_VARIABLES,
    CARRIED,
    CHECKED_QUANTITIES,
    SEED,
    InitialState,
    is_memory_of,
)

FLOAT32_TOLERANCE = 1e-6  # relative error of a radius or mass in single precision


def checked_initial_states(
    initial: Sequence[InitialState], experiment: Experiment, scene: Scene, seed: int
) -> list[InitialState]:
    """Return the `initial` states of a run, one per replica, with the experiment's species numbers.

    Raises InputError if the run cannot begin with them, or if a chosen `seed` has no effect on it.
    """
    with _naming(initial[0].file):
        states = [_with_experiment_numbers(state, experiment) for state in initial]
        check_initial_states(states, experiment, scene)
    for state in states:
        if not _may_draw_spins(state, experiment):
            _check_seed(state, scene, seed)
    return states


@contextmanager
def _naming(file: str) -> Iterator[None]:
    """Name the file of another program, if there is one, in the key of an InputError."""
    try:
        yield
    except InputError as error:
        if not file:
            raise
        raise InputError(f"{file}: {error.key}", error.value, error.legal) from error


def _may_draw_spins(initial, experiment):
    """Return whether a stage may draw random spins, since the initial state has none."""
    stages = getattr(experiment.schedule, "stages", ())
    still = initial.spin is None or not initial.spin.any()
    return still and any(stage.spin_temperature for stage in stages)


def _with_experiment_numbers(initial, experiment):
    """Return an initial state with species numbered in the order of the experiment."""
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


def check_initial_states(
    initial: Sequence[InitialState], experiment: Experiment, scene: Scene
) -> None:
    """Raise InputError if a run of this scene cannot begin with these states, one per replica."""
    replicas = getattr(experiment.schedule, "replicas", 1)
    if len(initial) != replicas:
        raise InputError("number of initial states", len(initial), f"be {replicas}, as replicas")
    if len({state.physics() for state in initial}) < len(initial):
        legal = "be another one for each replica: errors come from how replicas differ"
        raise InputError("initial", "with a state twice", legal)
    for state in initial:
        _check_vectors(state, experiment.particles, scene)
        _check_box(state, experiment)
        radius = _check_bodies(state, experiment, scene)
        if not is_memory_of(state, scene):
            check_positions(scene, state.position, state.time, radius)


def _check_vectors(initial, number, scene):
    """Raise InputError for positions, velocities or spins of the wrong shape.

    `number` is N.
    """
    dimension = len(scene.box)
    widths = {"position": dimension, "velocity": dimension, "spin": 2 * dimension - 3}
    for name, width in widths.items():
        values = getattr(initial, name)
        if values is not None and values.shape != (number, width):
            legal = f"have the shape ({number}, {width}) in this scene"
            raise InputError(f"initial.{name}", f"of shape {values.shape}", legal)
    if initial.spin is not None and scene.effects.spin is None and np.any(initial.spin):
        raise InputError("initial.spin", "not zero", "not be there where particles do not spin")


def _check_box(initial, experiment):
    """Raise InputError if a file of another program has a box of other sides than the settings."""
    if initial.box is None:
        return
    for axis, (side, length) in enumerate(zip(initial.box, experiment.lengths, strict=True)):
        if length is not None and not np.isclose(side, length, rtol=FLOAT32_TOLERANCE, atol=0.0):
            legal = f"be {length:g}, as in the settings"
            raise InputError(f"initial.box[{axis}]", f"{side:.9g}", legal)


def _check_bodies(initial, experiment, scene):
    """Check radii, species, masses and inertias; return the radii (N,) in a, None if all are 1.

    Raises InputError if they differ from the experiment.
    """
    number, spin = experiment.particles, scene.effects.spin
    if scene.effects.species is None:
        if initial.species is not None:
            legal = "not be there where the experiment has no species"
            raise InputError("initial.species_of", "there", legal)
        unit = {"radius": 1.0, "mass": 1.0, "inertia": 1.0 if spin is None else spin.inertia}
        _check_quantities(initial, {name: np.full(number, value) for name, value in unit.items()})
        return None
    for name, variable in BODY_VARIABLES.items():
        values = getattr(initial, name)
        if values is None:
            legal = "be in the dataset where the experiment has species"
            raise InputError("initial", f"without {variable}", legal)
        if values.shape != (number,):
            legal = f"have the shape ({number},) in this scene"
            raise InputError(f"initial.{variable}", values.shape, legal)
    bodies = build_bodies(scene, experiment, *initial.bodies())
    _check_radii(*initial.bodies(), mixture_of(experiment))
    _check_quantities(
        initial, {name: getattr(bodies, name) for name in ("radius", *CHECKED_QUANTITIES)}
    )
    return initial.radius


def _check_radii(radius, species, mixture):
    """Raise InputError for a particle whose radius its species does not admit.

    `radius` (N,) is in a, and `species` (N,) has the species' numbers.
    """
    for number, kind in enumerate(mixture.kinds):
        members = np.flatnonzero(species == number)
        mismatched = members[~kind.admits(radius[members], FLOAT32_TOLERANCE)]
        if len(mismatched):
            key = f"initial.radius of particle {mismatched[0]}, of species {kind.name}"
            raise InputError(
                key, radius[mismatched[0]], "be one of its species, as in the settings"
            )


def _check_quantities(initial, expected):
    """Raise InputError for a particle whose radius, mass or inertia differs from the settings.

    `expected` has their arrays (N,) by name.
    """
    for name, values in {"radius": initial.radius, **initial.of_settings}.items():
        if values is None:
            continue
        mismatched = np.flatnonzero(
            ~np.isclose(values, expected[name], rtol=FLOAT32_TOLERANCE, atol=0.0)
        )
        if len(mismatched):
            legal = f"be {expected[name][mismatched[0]]:g}, as in the settings"
            raise InputError(
                f"initial.{name} of particle {mismatched[0]}", values[mismatched[0]], legal
            )


def _check_seed(initial, scene, seed):
    """Raise InputError if a chosen `seed` has no effect on the run from an initial state."""
    if initial.noise == CARRIED:
        return
    exact = is_memory_of(initial, scene)
    start_hooks = {hook.function for hook in hooks.active(scene.effects, "particle_times")}
    random = hooks.active(scene.effects, "random") or (
        not exact and first_kick_times in start_hooks
    )
    if not random:
        legal = "be left out: nothing in this scene is random once its particles are there"
        raise InputError(initial.noise, seed, legal)
    if exact and initial.noise == SEED:
        legal = "be left out, as the run goes on with its own random numbers: reseed gives others"
        raise InputError(SEED, seed, legal)
