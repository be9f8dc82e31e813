"""The dataset of a filmed gas.

At each frame there are the energies, a map of where the particles are, and the single disks inside
one window of the box: frame by frame one after the other, `disks` of them in each (a contiguous
ragged array in the terms of CF).
"""

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from roughgas.data import netcdf
from roughgas.data.netcdf import Content, read_netcdf, write_netcdf
from roughgas.data.variables import (
    ENERGY,
    LENGTH,
    START,
    TIME,
    Variable,
    described,
    refuse,
    register,
)

if TYPE_CHECKING:
    import xarray

COMPLEVEL = 4
FILM = register(
    "film",
    {
        "x": Variable("middle of a cell of the map", LENGTH, ("x",)),
        "y": Variable("middle of a cell of the map", LENGTH, ("y",)),
        "time": Variable("time since cooling began", TIME, ("frame",)),
        "collisions_per_particle": Variable(
            "collisions per particle since cooling began", dims=("frame",)
        ),
        "E_trans": Variable("translational energy per degree of freedom", START, ("frame",)),
        "E_rot": Variable("rotational energy per degree of freedom", START, ("frame",)),
        "R": Variable(
            "share of rotation in the energy, E_rot / (E_rot + E_trans)", dims=("frame",)
        ),
        "count": Variable("number of particle centres in a cell", "1", ("frame", "y", "x"), "u2"),
        "disks": Variable("number of disks that reach into the window", "1", ("frame",), "i4"),
        "disk_x": Variable("position of a disk", LENGTH, ("disk",), "f4"),
        "disk_y": Variable("position of a disk", LENGTH, ("disk",), "f4"),
        "disk_spin": Variable(
            "spin of a disk", "root mean square spin of all disks in its frame", ("disk",), "f4"
        ),
        "E_trans_start": Variable("E_trans when cooling began", ENERGY),
        "contact_time": Variable(
            "contact time t_c of the contact-time model, NaN without it", TIME
        ),
        "contact_time_fraction": Variable("share of contacts changed by the contact-time model"),
        "collisions": Variable("collisions simulated", dtype="i8"),
        "kernel_seconds": Variable("time spent in the kernel", "s"),
    },
)


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
    return read_netcdf(path, netcdf.FILM)


def disks_of(film: "xarray.Dataset", frame: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return x and y (a) and spin (in units of its root mean square) of the disks in the window."""
    ends = np.cumsum(film.disks.values)
    one = slice(ends[frame] - film.disks.values[frame], ends[frame])
    return film.disk_x.values[one], film.disk_y.values[one], film.disk_spin.values[one]
