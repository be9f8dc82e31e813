"""The reduced dataset of an experiment, over r and beta: what figures, tables and verdicts read."""

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from roughgas.base.errors import InputError
from roughgas.base.legal import Interval
from roughgas.data import opening
from roughgas.data.netcdf import read_netcdf

if TYPE_CHECKING:
    import xarray

GRID = ("r", "beta")
EQUILIBRATED = 0.5
"""A point counts as being in a steady state where more than this share of its seeds is."""
SHARE, ENERGY = Interval("[0, 1]"), Interval("[0, inf)")
SOUND = {"R": SHARE, "R_ratio_of_means": SHARE, "E_trans": ENERGY, "E_rot": ENERGY}
"""What numbers of a simulation lie in, whatever was simulated."""


def read_reduced(path: str | Path) -> "xarray.Dataset":
    """Return a reduced dataset in memory; the file is closed.

    Raises InputError if the file is something else or damaged, or if a number in it cannot be
    right; OSError if there is none.
    """
    data = read_netcdf(path, opening.REDUCED)
    for name in SOUND.keys() & data.keys():
        check_sound(path, name, data[name].where(data.n_seeds > 0, 0.0).values)
    return data


def check_sound(path: str | Path, name: str, values: Any) -> None:
    """Raise InputError for the first of `values`, of one of SOUND, that cannot be right."""
    wrong = np.atleast_1d(values)[~np.atleast_1d(SOUND[name].holds(values))]
    if wrong.size:
        raise InputError(f"{name} of {path}", wrong[0], SOUND[name].legal)


def third_axis(attributes: Mapping[str, Any]) -> str | None:
    """Return the dimension besides r and beta of a dataset with these attributes; None without it.

    The parameter in `swept` names it: `inertia` for spin.inertia.
    """
    return attributes["swept"].rpartition(".")[2] if "swept" in attributes else None


def particles_of(data: "xarray.Dataset") -> str:
    """Return the number of particles as text: a range where it is swept."""
    if "particles" not in data.coords:
        return str(data.attrs["particles"])
    numbers = data.coords["particles"].values
    return f"{numbers.min():g} to {numbers.max():g}"
