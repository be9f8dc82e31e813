"""The dataset of a filmed gas.

At each frame there are the energies, a map of where the particles are, and the single disks inside
one window of the box: frame by frame one after the other, `disks` of them in each (a contiguous
ragged array in the terms of CF).
"""

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from roughgas.data import opening
from roughgas.data.netcdf import Content, read_netcdf, write_netcdf
from roughgas.data.variables import FILM, described, refuse

if TYPE_CHECKING:
    import xarray

COMPLEVEL = 4


def write_film(
    path: str | Path, variables: Mapping[str, Any], attributes: Mapping[str, str | int | float]
) -> None:
    """Write all variables of a film to `path` (netCDF4), whole or not at all; folders are created.

    Raises OSError if the file cannot be written, as on a full disk.
    """
    refuse("missing variables of a film", set(FILM) - set(variables))
    arrays = described("film", variables)
    arrays["disks"].attrs["sample_dimension"] = "disk"
    write_netcdf(path, Content(arrays, attributes), complevel=COMPLEVEL)


def read_film(path: str | Path) -> "xarray.Dataset":
    """Return the dataset at `path` in memory; the file is closed.

    Raises InputError if it is something else or damaged, OSError if there is none.
    """
    return read_netcdf(path, opening.FILM)


def disks_of(film: "xarray.Dataset", frame: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return x and y (a) and spin (in units of its root mean square) of the disks in the window."""
    ends = np.cumsum(film.disks.values)
    one = slice(ends[frame] - film.disks.values[frame], ends[frame])
    return film.disk_x.values[one], film.disk_y.values[one], film.disk_spin.values[one]
