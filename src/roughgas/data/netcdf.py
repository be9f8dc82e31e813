"""The one writer and the one reader of netCDF files, which follow the CF conventions.

Files are written with netCDF4 alone: importing xarray would double the start-up of a point's job.

UDUNITS, whose units CF asks for, reads T as tesla and a as a year. A quantity in a gas's own units
has no dimension there: its `units` are 1, and `reduced_units` says what it is a multiple of.
"""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from roughgas.base.files import whole_file
from roughgas.base.version import __version__
from roughgas.data.opening import SCHEMA_VERSION, STUDIES, opened, seal
from roughgas.data.variables import CLOCKS, Array

if TYPE_CHECKING:
    import netCDF4
    import xarray

COMMON_ATTRIBUTES = {
    "Conventions": "CF-1.11",
    "schema_version": SCHEMA_VERSION,
    "source": f"roughgas {__version__}, event-driven simulation of rough, inelastic particles",
    "history": f"written by roughgas {__version__}; undated: the same run gives the same bytes",
    "references": "S. McNamara and S. Luding, Phys. Rev. E 58, 2247 (1998), "
    "doi:10.1103/PhysRevE.58.2247",
    "comment": "Particle radius a = particle mass m = time unit T = 1; reduced_units of a variable "
    "are in terms of these, of collisions per particle, or of an energy at the start.",
}
UDUNITS = ("1", "s", "1/s")
QUALITIES = ("stderr", "dof", "ci95", "ci95_trusted")
"""Suffixes of the ancillary variables of <name>, which say how sure it is (<name>_stderr, ...)."""


class Content(NamedTuple):
    """What a file, or a group of it, holds.

    `clocks` are coordinates whose dimension has another name, as a time along `sample`.
    """

    variables: Mapping[str, "Array | xarray.Variable"]
    attributes: Mapping[str, Any]
    clocks: Sequence[str] = CLOCKS


def content_of(dataset: "xarray.Dataset") -> Content:
    """Return what `dataset` holds, whose variables have attributes as those of `described`."""
    clocks = sorted(str(name) for name in dataset.coords if name not in dataset.dims)
    return Content({str(k): one for k, one in dataset.variables.items()}, dataset.attrs, clocks)


def write_netcdf(
    path: str | Path,
    content: Content,
    groups: Mapping[str, Content] | None = None,
    complevel: int = 0,
) -> None:
    """Write a netCDF4 file with these contents, whole or not at all; parent folders are created.

    The root gets the attributes that all files have. `complevel` > 0 compresses arrays.
    Raises OSError if the file cannot be written, as on a full disk.
    """
    import netCDF4

    try:
        with whole_file(path) as draft:
            with netCDF4.Dataset(draft, "w") as file:
                _fill(file, content, COMMON_ATTRIBUTES, complevel)
                for name, one in (groups or {}).items():
                    _fill(file.createGroup(name), one, {}, complevel)
            seal(draft)
    except (RuntimeError, PermissionError) as error:  # as netCDF4 says that a disk is full
        reason = f"{error}; is the disk full or the folder read-only?"
        raise OSError(f"cannot write {path}: {reason}") from error


def in_memory(content: Content) -> "xarray.Dataset":
    """Return what `read_netcdf` gives of the file that `write_netcdf` makes, without that file."""
    import netCDF4
    import xarray

    file = netCDF4.Dataset("memory.nc", "w", memory=1)  # never gets to a disk
    _fill(file, content, COMMON_ATTRIBUTES, 0)
    file = netCDF4.Dataset("memory.nc", memory=file.close())
    return xarray.load_dataset(xarray.backends.NetCDF4DataStore(file))  # which closes it


def read_netcdf(path: str | Path, *kinds: str, group: str | None = None) -> "xarray.Dataset":
    """Return the dataset at `path`, or a group of it, in memory; the file is closed.

    Raises InputError and OSError as `opened` does, which checks that the file is of one of `kinds`.
    """
    import xarray

    with opened(path, *kinds):
        return xarray.load_dataset(path, group=group, engine="netcdf4")


def read_groups(path: str | Path) -> "dict[str, xarray.Dataset]":
    """Return all groups of a dataset of studies in memory, by name: the file is checked once.

    Raises InputError and OSError as `opened` does.
    """
    import xarray

    with opened(path, STUDIES) as file:
        names = list(file.groups)
    return {n: xarray.load_dataset(path, group=n, engine="netcdf4") for n in names}


def _fill(
    group: "netCDF4.Dataset", content: Content, common: Mapping[str, Any], complevel: int
) -> None:
    group.setncatts({**common, **content.attributes})
    for variable in content.variables.values():
        for dim, length in zip(variable.dims, variable.values.shape, strict=True):
            if dim not in group.dimensions:
                group.createDimension(str(dim), length)
    for name in content.variables:
        _write_variable(group, name, content, complevel)


def _write_variable(group: "netCDF4.Dataset", name: str, content: Content, complevel: int) -> None:
    variable = content.variables[name]
    dims, values = tuple(map(str, variable.dims)), variable.values
    words = values.dtype.kind in "OU"
    is_coordinate = name in dims or name in content.clocks
    layout: dict[str, Any] = {}
    if complevel and dims and not words:
        layout = {"compression": "zlib", "complevel": complevel, "shuffle": True}
    if values.dtype.kind == "f" and not is_coordinate:  # CF forbids it in coordinates
        layout["fill_value"] = np.nan
    target = group.createVariable(name, str if words else values.dtype, dims, **layout)
    target.setncatts(_attributes(name, content, is_coordinate))
    target[...] = values.astype(object) if words else values


def _attributes(name: str, content: Content, is_coordinate: bool) -> dict[str, Any]:
    """Return the attributes of a variable: units as CF has them, and what belongs to it."""
    variables = content.variables
    dims, attributes = variables[name].dims, dict(variables[name].attrs)
    is_number = variables[name].values.dtype.kind in "if"
    unit = attributes.pop("units", "1" if is_coordinate and is_number else "")
    units = {"units": unit} if "reduced_units" in attributes else unit_attributes(unit)
    clocks = [c for c in content.clocks if c in variables and set(variables[c].dims) <= set(dims)]
    along = {"coordinates": " ".join(clocks)} if clocks and not is_coordinate else {}
    sure = [f"{name}_{quality}" for quality in QUALITIES if f"{name}_{quality}" in variables]
    ancillary = {"ancillary_variables": " ".join(sure)} if sure else {}
    return attributes | units | ancillary | along


def unit_attributes(unit: str) -> dict[str, str]:
    """Return the attributes that tell a unit, such as "T", "1" or "s/T"; none for "", of words.

    CPU time in terms of a gas's own units is in seconds.
    """
    if not unit:
        return {}
    if unit in UDUNITS:
        return {"units": unit}
    return {"units": "s" if unit.startswith("s/") else "1", "reduced_units": unit}


def unit_of(attributes: Mapping[str, str]) -> str:
    """Return the unit that `unit_attributes` tell; "" for words."""
    return attributes.get("reduced_units", attributes.get("units", ""))
