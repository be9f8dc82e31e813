"""Gases of which something is known, one a task: what is measured of each, run by run."""

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
import xarray as xr

from roughgas.tasks import stream, timed

from . import contacts, events, homogeneous

KINDS: dict[str, Callable[..., dict[str, float]]] = {
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
"""What finds numbers in one run of a gas, from settings, the gas and a seed."""
CONTACTS = "contacts"


def tasks(settings: Mapping[str, Any]) -> list[str]:
    """Return the names of all gases, the longest first, and at last of the single contacts."""
    return list(gases_of(settings))


def gases_of(settings: Mapping[str, Any]) -> dict[str, tuple[str, list[float]]]:
    """Return kind and parameters of each gas by name; its random numbers are of its place."""
    gases = []
    for kind in KINDS:
        about = settings[kind]
        found = about["gases"] if "gases" in about else [[one] for one in about["dimensions"]]
        gases += [(kind, gas) for gas in found]
    gases += [(CONTACTS, [dimension]) for dimension in settings[CONTACTS]["dimensions"]]
    return {name_of(kind, *gas): (kind, gas) for kind, gas in gases}


def name_of(kind: str, *gas: float) -> str:
    """Return the name of a task."""
    return "_".join([kind, *(f"{number:g}" for number in gas)])


def run(task: str, settings, experiments, progress: Callable[[int, int], None]) -> xr.Dataset:
    """Return what is found, by name: in each `run` of a gas, or in each `contact`."""
    gases = gases_of(settings)
    kind, gas = gases[task]
    seeds = stream(settings, list(gases).index(task)).spawn(settings["runs"])
    if kind == CONTACTS:
        found, seconds = timed(contacts.find, settings[CONTACTS], gas[0], seeds[0])
        parts = {name: ((f"contact_{name}",), values) for name, values in found.items()}
        return xr.Dataset({**parts, "seconds": seconds})
    rows, spent = [], 0.0
    for k, seed in enumerate(seeds):
        row, seconds = timed(KINDS[kind], settings[kind], gas, seed)
        rows.append(row)
        spent += seconds
        progress(k + 1, len(seeds))
    runs = {name: ("run", np.array([row[name] for row in rows])) for name in rows[0]}
    return xr.Dataset({**runs, "seconds": spent})
