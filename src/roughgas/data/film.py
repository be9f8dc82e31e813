"""The dataset of a filmed gas: what it holds, and how it is written and read.

Units: particle radius a = particle mass m = time unit T = 1. At each frame there are the energies,
a map of where the particles are, and the single disks inside one window of the box: frame by frame
one after the other, `disks` of them in each (a contiguous ragged array in the terms of CF).
"""

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from roughgas.base.errors import InputError
from roughgas.data.cf import COMMON_ATTRIBUTES, check_schema, unit_attributes
from roughgas.data.point import CLOCKS, ENERGY, TIME, Variable, whole_netcdf

if TYPE_CHECKING:
    import xarray

LENGTH = "a"
START = "initial E_trans"


def _per_frame(long_name: str, units: str = "1") -> Variable:
    return Variable(long_name, units, ("frame",))


def _per_disk(long_name: str, units: str) -> Variable:
    return Variable(long_name, units, ("disk",), "f4")


VARIABLES = {
    "x": Variable("middle of a cell of the map", LENGTH, ("x",)),
    "y": Variable("middle of a cell of the map", LENGTH, ("y",)),
    "time": _per_frame("time since cooling began", TIME),
    "collisions_per_particle": _per_frame("collisions per particle since cooling began"),
    "E_trans": _per_frame("translational energy per degree of freedom", START),
    "E_rot": _per_frame("rotational energy per degree of freedom", START),
    "R": _per_frame("share of rotation in the energy, E_rot / (E_rot + E_trans)"),
    "count": Variable("number of particle centres in a cell", "1", ("frame", "y", "x"), "u2"),
    "disks": Variable("number of disks that reach into the window", "1", ("frame",), "i4"),
    "disk_x": _per_disk("position of a disk", LENGTH),
    "disk_y": _per_disk("position of a disk", LENGTH),
    "disk_spin": _per_disk("spin of a disk", "root mean square spin of all disks in its frame"),
    "E_trans_start": Variable("E_trans when cooling began", ENERGY),
    "contact_time": Variable("contact time t_c of the contact-time model, NaN without it", TIME),
    "contact_time_fraction": Variable("share of contacts changed by the contact-time model"),
    "collisions": Variable("collisions simulated", dtype="i8"),
    "kernel_seconds": Variable("time spent in the kernel", "s"),
}


def write_film(
    path: str | Path, variables: Mapping[str, Any], attributes: Mapping[str, str | int | float]
) -> None:
    """Write all of VARIABLES to `path` (netCDF4), whole or not at all; folders are created.

    Raises OSError when the file cannot be written, as on a full disk.
    """
    import netCDF4

    with whole_netcdf(path) as draft, netCDF4.Dataset(draft, "w") as file:
        file.setncatts(COMMON_ATTRIBUTES | dict(attributes))
        for name, about in VARIABLES.items():
            values = np.asarray(variables[name])
            for dim, length in zip(about.dims, values.shape, strict=True):
                if dim not in file.dimensions:
                    file.createDimension(dim, length)
            target = file.createVariable(name, about.dtype, about.dims, **_layout(name))
            target.setncatts({"long_name": about.long_name, **unit_attributes(about.units)})
            if "frame" in about.dims and name not in CLOCKS:
                target.coordinates = " ".join(CLOCKS)
            target[...] = values
        file["disks"].sample_dimension = "disk"


def _layout(name: str) -> dict[str, Any]:
    """How a variable is stored; of numbers that may be missing, by which value."""
    about = VARIABLES[name]
    packing = {"compression": "zlib", "complevel": 4, "shuffle": True} if about.dims else {}
    may_miss = about.dtype.startswith("f") and name not in (*about.dims, *CLOCKS)
    return packing | ({"fill_value": np.nan} if may_miss else {})


def read_film(path: str | Path) -> "xarray.Dataset":
    """The dataset at `path` as an xarray.Dataset in memory, the file closed.

    Raises InputError where it is of a newer schema, or no film.
    """
    import xarray

    found = xarray.load_dataset(path, engine="netcdf4")
    check_schema(found.attrs, path)
    if "frame" not in found.dims:
        raise InputError("film", path, "be a dataset of `roughgas clustering`")
    return found


def disks_of(film: "xarray.Dataset", frame: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """x and y (a) and spin (in units of its root mean square) of the disks in the window."""
    ends = np.cumsum(film.disks.values)
    one = slice(ends[frame] - film.disks.values[frame], ends[frame])
    return film.disk_x.values[one], film.disk_y.values[one], film.disk_spin.values[one]
