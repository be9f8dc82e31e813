"""Tasks of gases with exact results, one gas per task: quantities measured in each run."""

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
import xarray as xr

from roughgas.tasks import seed_sequence, timed

from . import contacts, events, homogeneous

RUN_OF_KIND: dict[str, Callable[..., dict[str, float]]] = {
    "noise": events.noise,
    "fluids": events.fluid,
    "tracers": events.tracer,
    "cooling": homogeneous.cooling,
    "haff": homogeneous.haff,
    "rates": events.rates,
    "diffusion": homogeneous.diffusion,
    "tails": homogeneous.tails,
    "rough": homogeneous.rough,
    "mixtures": events.mixtures,
    "clusters": events.clusters,
}
"""Functions that measure quantities in one run of a gas, from settings, its parameters and a
seed."""
CONTACTS = "contacts"


def tasks(settings: Mapping[str, Any]) -> list[str]:
    """Return the names of all gases, the longest first, and last the names of the single
    contacts."""
    return list(gases_of(settings))


def gases_of(settings: Mapping[str, Any]) -> dict[str, tuple[str, list[float]]]:
    """Return kind and parameters of each gas by name; its random numbers depend on its position."""
    gases = []
    for kind in RUN_OF_KIND:
        kind_settings = settings[kind]
        if "gases" in kind_settings:
            parameters = kind_settings["gases"]
        else:
            parameters = [[dimension] for dimension in kind_settings["dimensions"]]
        gases += [(kind, gas) for gas in parameters]
    gases += [(CONTACTS, [dimension]) for dimension in settings[CONTACTS]["dimensions"]]
    return {name_of(kind, *gas): (kind, gas) for kind, gas in gases}


def name_of(kind: str, *gas: float) -> str:
    """Return the name of a task."""
    return "_".join([kind, *(f"{number:g}" for number in gas)])


def run(task: str, settings, experiments, progress: Callable[[int, int], None]) -> xr.Dataset:
    """Return the measured quantities by name: for each `run` of a gas, or for each `contact`."""
    gases = gases_of(settings)
    kind, gas = gases[task]
    seeds = seed_sequence(settings, list(gases).index(task)).spawn(settings["runs"])
    if kind == CONTACTS:
        values_of_contacts, seconds = timed(contacts.measure, settings[CONTACTS], gas[0], seeds[0])
        progress(1, 1)
        columns = {
            name: ((f"contact_{name}",), values) for name, values in values_of_contacts.items()
        }
        return xr.Dataset({**columns, "seconds": seconds})
    rows, spent = [], 0.0
    for k, seed in enumerate(seeds):
        row, seconds = timed(RUN_OF_KIND[kind], settings[kind], gas, seed)
        rows.append(row)
        spent += seconds
        progress(k + 1, len(seeds))
    runs = {name: ("run", np.array([row[name] for row in rows])) for name in rows[0]}
    return xr.Dataset({**runs, "seconds": spent})
