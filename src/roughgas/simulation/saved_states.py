"""Initial states from datasets of roughgas or of other programs, and seeds of continued runs."""

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from roughgas.base import InputError, short_repr
from roughgas.data.netcdf import check_version
from roughgas.data.states import READ_FROM, check_type, read_memory, read_quantity
from roughgas.simulation.initial_states import (
    BODY_VARIABLES,
    CARRIED,
    CHECKED_QUANTITIES,
    RESEED,
    SEED,
    InitialState,
)

if TYPE_CHECKING:
    import xarray


def initial_states_of(dataset: "xarray.Dataset") -> list[InitialState]:
    """Return the initial states in a dataset, one per replica.

    The dataset may be a point made with keep_state, a frame of a trajectory, or written by another
    program: `position` and `velocity` (particle, axis), `spin` (particle, spin_axis), `radius` and
    `species_of` (particle), `time`; roughgas.data.states defines the accepted forms. Raises
    InputError for other forms and versions, and for a missing position or velocity.
    """
    check_type(dataset)
    if str(dataset.attrs.get("source", "")).startswith("roughgas"):
        check_version(dataset.attrs, "initial.schema_version")
    prefix = "last_" if "last_position" in dataset else ""
    for name in ("position", "velocity"):
        if prefix + name not in dataset:
            legal = "be in the dataset: a point made with keep_state, or a frame of a trajectory"
            raise InputError("initial", f"without {name}", legal)
    vectors = ("position", "velocity", "spin")
    variables = (
        {name: name for name in vectors}
        | BODY_VARIABLES
        | {name: name for name in CHECKED_QUANTITIES}
    )
    states = {
        name: read_quantity(dataset, variable, prefix)
        for name, variable in variables.items()
        if prefix + variable in dataset
    }
    memories = read_memory(dataset)
    times = np.zeros(len(memories))
    if f"{prefix}time" in dataset:
        times = read_quantity(dataset, "time", prefix)
    if np.min(times) < 0.0:
        raise InputError("initial.time", short_repr(times.tolist()), "be a number >= 0")
    _check_species(states.get("species"))
    file = str(dataset.attrs.get(READ_FROM, ""))
    if file and "box" in dataset:
        states["box"] = read_quantity(dataset, "box")
    settings = {name: states.pop(name) for name in CHECKED_QUANTITIES if name in states}
    return [
        InitialState(
            **{name: values[number] for name, values in states.items()},
            time=float(times[number]),
            memory=memory,
            memory_owner=str(dataset.attrs.get("memory_of", "")),
            names=tuple(map(str, dataset["species"].values)) if "species" in dataset else (),
            file=file,
            of_settings={name: values[number] for name, values in settings.items()},
            seed=dataset.attrs.get("seed", 1),
        )
        for number, memory in enumerate(memories)
    ]


def _check_species(species):
    """Raise InputError unless the species numbers of all particles are whole and not negative."""
    if species is not None and not (np.floor(np.abs(species)) == species).all():
        illegal = species[np.floor(np.abs(species)) != species][0]
        raise InputError("initial.species_of", illegal, "be a whole number from 0")


def with_noise_source(
    states: Sequence[InitialState], seed: Any = None, reseed: Any = None
) -> tuple[list[InitialState], Any]:
    """Return the initial states with the source of the run's noise, and the seed or list of seeds.

    The options of a command are `seed`, the seed of a new run, and `reseed`, the seed of new noise
    for a run that continues a saved one. Each is one seed or a list. Without `seed` and `reseed`
    the run has the seed of the run that ended in the states, or 1 without states. Raises InputError
    if both are given, and for `reseed` without states.
    """
    if reseed is not None and not states:
        raise InputError("reseed", _listed(reseed), "come with a saved state: --from, or initial=")
    if reseed is not None and seed is not None:
        raise InputError("seed", _listed(seed), "not stand beside reseed")
    noise = RESEED if reseed is not None else CARRIED if seed is None else SEED
    run_seed = {RESEED: reseed, SEED: seed, CARRIED: states[0].seed if states else 1}[noise]
    return [state._replace(noise=noise) for state in states], run_seed


def _listed(seeds):
    """Return a list of seeds as text; a single seed as it is."""
    return " ".join(seeds) if isinstance(seeds, list) else seeds
