"""The film of a cooling gas, described, and what happened in it as a table."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import xarray as xr

from roughgas.tasks import dataset, markdown, variables

KNOWN = variables(Path(__file__).with_name("variables.yaml"))
ROWS = 8
"""Frames of the table, about."""
ATTRIBUTES = ("r", "beta", "seed", "particles", "inertia", "box", "window", "packing")


def combine(parts: Mapping[str, xr.Dataset], settings: Mapping[str, Any]) -> xr.Dataset:
    """Return the film with units and meanings, its numbers as the task has stored them."""
    film = parts["film"]
    values = {str(name): one.values for name, one in film.variables.items()}
    known = {name: KNOWN[name]._replace(dtype=values[name].dtype.str[1:]) for name in values}
    data = dataset(known, values, **{name: film.attrs[name] for name in ATTRIBUTES})
    data.disks.attrs["sample_dimension"] = "disk"  # a contiguous ragged array, in the terms of CF
    return data


def table(data: xr.Dataset) -> str:
    """Return energies and R of some frames as Markdown."""
    every = max(1, data.sizes["frame"] // ROWS)
    head = ["collisions per particle", "E_trans", "E_rot", "R"]
    columns = (data[name].values[::every] for name in ("collisions_per_particle", *head[1:]))
    rows = [[f"{value:.4g}" for value in row] for row in zip(*columns, strict=True)]
    touched, made = float(data.contact_time_fraction), int(data.collisions)
    return (
        f"## A cooling gas of {data.attrs['particles']} disks\n\nEnergies per degree of freedom, in"
        f" units of E_trans at the start:\n\n{markdown(head, rows)}\n{made} collisions; the"
        f" contact-time model changed {touched:.2%} of them.\n"
    )
