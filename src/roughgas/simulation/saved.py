"""States that runs have saved, or that other programs have written: from a dataset to the start of
a run, and to its seed."""

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from roughgas.base import InputError, shown
from roughgas.data.states import check_type, read_memory, read_quantity
from roughgas.simulation.restart import CARRIED, OF_BODIES, OF_SETTINGS, RESEED, SEED, Initial

if TYPE_CHECKING:
    import xarray


def initial_of(dataset: "xarray.Dataset") -> list[Initial]:
    """Return the states in a dataset, one per replica.

    It may be a point that has kept its last state, a frame of a trajectory, or a dataset of another
    program: `position` and `velocity` (particle, axis), `spin` (particle, spin_axis), `radius` and
    `species_of` (particle), `time`; roughgas.data.states says which forms these may have. Raises
    InputError for other forms, and where a position or a velocity lacks.
    """
    check_type(dataset)
    prefix = "last_" if "last_position" in dataset else ""
    for name in ("position", "velocity"):
        if prefix + name not in dataset:
            legal = "be in the dataset: a point made with keep_state, or a frame of a trajectory"
            raise InputError("initial", f"without {name}", legal)
    vectors = ("position", "velocity", "spin")
    variables = {name: name for name in vectors} | OF_BODIES | {name: name for name in OF_SETTINGS}
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
        raise InputError("initial.time", shown(times.tolist()), "be a number >= 0")
    _check_species(states.get("species"))
    settings = {name: states.pop(name) for name in OF_SETTINGS if name in states}
    return [
        Initial(
            **{name: values[number] for name, values in states.items()},
            time=float(times[number]),
            memory=memory,
            owner=str(dataset.attrs.get("memory_of", "")),
            names=tuple(map(str, dataset["species"].values)) if "species" in dataset else (),
            of_settings={name: values[number] for name, values in settings.items()},
            seed=dataset.attrs.get("seed", 1),
        )
        for number, memory in enumerate(memories)
    ]


def _check_species(species):
    if species is not None and not (np.floor(np.abs(species)) == species).all():
        wrong = species[np.floor(np.abs(species)) != species][0]
        raise InputError("initial.species_of", wrong, "be a whole number from 0")


def seeded(
    states: Sequence[Initial], seed: Any = None, reseed: Any = None
) -> tuple[list[Initial], Any]:
    """Return states with the source of a run's noise, and the seed or the list of seeds.

    `seed` and `reseed` are None where none is chosen: then the run has the seed of the run that
    ended in the states, or without states 1. Raises InputError where both are chosen, and for
    `reseed` without states.
    """
    if reseed is not None and not states:
        raise InputError("reseed", _listed(reseed), "come with a saved state: --from, or initial=")
    if reseed is not None and seed is not None:
        raise InputError("seed", _listed(seed), "not stand beside reseed")
    noise = RESEED if reseed is not None else CARRIED if seed is None else SEED
    chosen = {RESEED: reseed, SEED: seed, CARRIED: states[0].seed if states else 1}[noise]
    return [state._replace(noise=noise) for state in states], chosen


def _listed(seeds):
    return " ".join(seeds) if isinstance(seeds, list) else seeds
