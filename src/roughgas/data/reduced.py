"""The reduced dataset of an experiment, over r and beta: what figures, tables and verdicts read."""

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from roughgas.data.cf import check_schema

if TYPE_CHECKING:
    import xarray

GRID = ("r", "beta")
EQUILIBRATED = 0.5
"""A point counts as being in a steady state where more than this share of its seeds is."""


def read_reduced(path: str | Path) -> "xarray.Dataset":
    """The reduced dataset at `path` in memory, the file closed.

    Raises InputError where it is of a newer schema.
    """
    import xarray

    found = xarray.load_dataset(path, engine="netcdf4")
    check_schema(found.attrs, path)
    return found


def third_axis(attributes: Mapping[str, Any]) -> str | None:
    """The dimension besides r and beta of a dataset with these attributes, such as `inertia`: the
    parameter in `swept`, such as spin.inertia. None where there is none."""
    return attributes["swept"].split(".")[1] if "swept" in attributes else None
