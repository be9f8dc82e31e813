"""The reduced dataset of an experiment, over r and beta: what figures, tables and verdicts read."""

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from roughgas.data import opening
from roughgas.data.netcdf import read_netcdf

if TYPE_CHECKING:
    import xarray

GRID = ("r", "beta")
EQUILIBRATED = 0.5
"""A point counts as being in a steady state where more than this share of its seeds is."""


def read_reduced(path: str | Path) -> "xarray.Dataset":
    """Return a reduced dataset in memory; the file is closed.

    Raises InputError if the file is something else or damaged, OSError if there is none.
    """
    return read_netcdf(path, opening.REDUCED)


def third_axis(attributes: Mapping[str, Any]) -> str | None:
    """Return the dimension besides r and beta of a dataset with these attributes; None without it.

    The parameter in `swept` names it: `inertia` for spin.inertia.
    """
    return attributes["swept"].split(".")[1] if "swept" in attributes else None
