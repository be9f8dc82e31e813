"""The film of a cooling gas as a described dataset, and a table of its energies."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import xarray as xr

from roughgas.tasks import dataset, markdown, read_variables

DESCRIPTIONS = read_variables(Path(__file__).with_name("variables.yaml"))
TABLE_ROWS = 8
"""Approximate number of frames in the table."""
ATTRIBUTES = ("r", "beta", "seed", "particles", "inertia", "box", "window", "packing")


def combine(task_results: Mapping[str, xr.Dataset], settings: Mapping[str, Any]) -> xr.Dataset:
    """Return the film with units and meanings, its numbers in the types that the task has
    stored."""
    film = task_results["film"]
    values = {str(name): column.values for name, column in film.variables.items()}
    descriptions = {
        name: DESCRIPTIONS[name]._replace(dtype=values[name].dtype.str[1:]) for name in values
    }
    data = dataset(descriptions, values, **{name: film.attrs[name] for name in ATTRIBUTES})
    data.disks.attrs["sample_dimension"] = "disk"  # a contiguous ragged array, in the terms of CF
    return data


def table(data: xr.Dataset) -> str:
    """Return energies and R of some frames, Markdown."""
    every = max(1, data.sizes["frame"] // TABLE_ROWS)
    head = ["collisions per particle", "E_trans", "E_rot", "R"]
    columns = (data[name].values[::every] for name in ("collisions_per_particle", *head[1:]))
    rows = [[f"{value:.4g}" for value in row] for row in zip(*columns, strict=True)]
    touched, collisions = float(data.contact_time_fraction), int(data.collisions)
    return (
        f"## A cooling gas of {data.attrs['particles']} disks\n\nEnergies per degree of freedom, in"
        f" units of E_trans at the start:\n\n{markdown(head, rows)}\n{collisions} collisions; the"
        f" contact-time model changed {touched:.2%} of them.\n"
    )
