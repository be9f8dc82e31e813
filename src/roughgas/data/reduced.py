"""The reduced dataset of an experiment, over r and beta: what figures, tables and verdicts read."""

from collections.abc import Mapping
from typing import Any

from roughgas.data.netcdf import read_netcdf

GRID = ("r", "beta")
EQUILIBRATED = 0.5
"""A point counts as being in a steady state where more than this share of its seeds is."""

read_reduced = read_netcdf


def third_axis(attributes: Mapping[str, Any]) -> str | None:
    """Return the dimension besides r and beta of a dataset with these attributes; None without it.

    The parameter in `swept` names it: `inertia` for spin.inertia.
    """
    return attributes["swept"].split(".")[1] if "swept" in attributes else None
