"""Energies and R of each species of a mixture, as variables of a point (see roughgas.data.point).

All arrays have the species first. Where particles are alike there are no such variables.
"""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from roughgas.effects import inertia
from roughgas.effects.species import mixture_of
from roughgas.kernel.state import State
from roughgas.scene import Scene, moves_along, shear_rate
from roughgas.simulation.energies import (
    Columns,
    Energies,
    energies,
    fitted_flow,
    of_species,
    ratio,
    restored,
)
from roughgas.statistics.errors import blocking, period_means


def names(experiment: Mapping[str, Any]) -> dict[str, Any]:
    """Return what the species are called, and how many particles each has."""
    mixture = mixture_of(experiment)
    if mixture is None:
        return {}
    return {
        "species": [kind.name for kind in mixture.kinds],
        "species_particles": [kind.number for kind in mixture.kinds],
    }


def energies_of(
    columns: Columns, scene: Scene, state: State, species: int | None = None
) -> Energies:
    """Return the energies of samples, of all particles or of one species; of a sheared gas without
    mean flow and mean spin."""
    q, bodies = inertia(scene.effects), state.bodies
    rate = None if scene.effects.shear is None else shear_rate(scene)
    flows = moves_along(scene.effects)
    if bodies is None:
        number = len(state.changes)
        return energies(columns, number, q, rate, mass=float(number) if flows else None)
    which = np.full(len(bodies.mass), True) if species is None else bodies.species == species
    columns = columns if species is None else of_species(columns, species)
    moments = (bodies.mass * bodies.inertia * bodies.radius**2)[which]
    spins, mass = float(np.sum(moments / (q or 1.0))), float(np.sum(bodies.mass[which]))
    return energies(columns, int(which.sum()), q, rate, spins, mass if flows else None)


def shear_rates(columns: Columns, state: State) -> np.ndarray:
    """Return the gradient of the mean flow of samples between walls that move, in 1/T."""
    mass = len(state.changes) if state.bodies is None else np.sum(state.bodies.mass)
    return fitted_flow(columns, float(mass))[0]


def energies_of_each(columns: Columns, scene: Scene, state: State) -> list[Energies]:
    """Return the energies of the particles of each species; none where all particles are alike."""
    number = 0 if scene.effects.species is None else scene.effects.species.kinds
    return [energies_of(columns, scene, state, species) for species in range(number)]


def driven(parts: Sequence[Energies], per_period: int, together: int) -> dict[str, Any]:
    """Return averages over time, with errors by blocking over periods.

    `parts` are the energies (samples,) of each species in the measured window; of so many samples
    each, `together`, the stored series have the means.
    """
    if not parts:
        return {}
    found = _averages(
        parts,
        lambda part: part.translational,
        lambda part: part.rotational,
        np.mean,
        lambda values: blocking(period_means(values, per_period))[0],
    )
    series = _of_each(parts, lambda values: period_means(values, together))
    return found | {f"{name}_series": values for name, values in series.items()}


def cooling(
    parts: Sequence[Energies], total: Energies, exponent: np.ndarray, inside: np.ndarray
) -> dict[str, Any]:
    """Return averages over replicas and over the samples that are `inside` the measured window.

    `parts` are the energies (replicas, samples) of each species and `total` those of all particles,
    in the same units. Since all decay together, the shares E_species/E_trans are averaged, and
    given in units of E_trans when the measurement begins.
    """
    if not parts:
        return {}
    whole = restored(total, exponent).translational
    begun = whole.mean(axis=0)[np.argmax(inside)]

    def share(values):
        return begun * (values / total.translational)[:, inside].mean(axis=1)

    found = _averages(
        parts,
        lambda part: share(part.translational),
        lambda part: share(part.rotational),
        np.mean,
        lambda values: values.std(ddof=1) / np.sqrt(len(values)),
        lambda part: ratio(part)[:, inside].mean(axis=1),
    )
    means = [restored(part, exponent).map(lambda values: values.mean(axis=0)) for part in parts]
    series = _of_each(means, np.asarray)
    return found | {f"{name}_series": values for name, values in series.items()}


def _averages(parts, translational, rotational, mean, error, share=ratio):
    """Return the mean and the error of both energies and of R, of each species."""
    quantities = {"E_trans_species": translational}
    if parts[0].rotational is not None:
        quantities |= {"E_rot_species": rotational, "R_species": share}
    found = {}
    for name, quantity in quantities.items():
        values = [quantity(part) for part in parts]
        found[name] = [mean(one) for one in values]
        found[f"{name}_stderr"] = [error(one) for one in values]
    return found


def _of_each(parts, function):
    """Return a function of both energies of each species, by name."""
    stacked = {"E_trans_species": [function(part.translational) for part in parts]}
    if parts[0].rotational is not None:
        stacked["E_rot_species"] = [function(part.rotational) for part in parts]
    return stacked
