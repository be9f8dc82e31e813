"""Energies and R of each species of a mixture, as variables of a point (see roughgas.data.point).

All arrays have the species first. Where particles are alike there are no such variables.
"""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from roughgas.effects.species import mixture_of
from roughgas.simulation.energies import Energies, ratio, restored
from roughgas.statistics.averages import period_means
from roughgas.statistics.errors import blocking


def names(experiment: Mapping[str, Any]) -> dict[str, Any]:
    """Return what the species are called, and how many particles each has."""
    mixture = mixture_of(experiment)
    if mixture is None:
        return {}
    return {
        "species": [kind.name for kind in mixture.kinds],
        "species_particles": [kind.number for kind in mixture.kinds],
    }


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
