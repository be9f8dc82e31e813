"""The one writer and the one reader of netCDF files.

Files are written with netCDF4 alone: importing xarray would double the start-up of a point's job.
"""

from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from roughgas.base.files import whole_file
from roughgas.data.cf import COMMON_ATTRIBUTES, ancillary, check_schema, unit_attributes
from roughgas.data.variables import CLOCKS, Array

if TYPE_CHECKING:
    import netCDF4
    import xarray


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
    return Content(dataset.variables, dataset.attrs, clocks)


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

    with whole_netcdf(path) as draft, netCDF4.Dataset(draft, "w") as file:
        _fill_file(file, content, groups or {}, complevel)


def in_memory(content: Content) -> "xarray.Dataset":
    """Return what `read_netcdf` gives of the file that `write_netcdf` makes, without that file."""
    import netCDF4
    import xarray

    file = netCDF4.Dataset("memory.nc", "w", memory=1)  # never gets to a disk
    _fill_file(file, content, {}, 0)
    file = netCDF4.Dataset("memory.nc", memory=file.close())
    return xarray.load_dataset(xarray.backends.NetCDF4DataStore(file))  # which closes it


def read_netcdf(path: str | Path, group: str | None = None) -> "xarray.Dataset":
    """Return the dataset at `path`, or a group of it, in memory; the file is closed.

    Raises InputError if the file is of a newer schema.
    """
    import xarray

    found = xarray.load_dataset(path, engine="netcdf4")
    check_schema(found.attrs, path)
    return found if group is None else xarray.load_dataset(path, group=group, engine="netcdf4")


@contextmanager
def whole_netcdf(path: str | Path) -> Iterator[Path]:
    """Yield a path as `whole_file` does, for a library with other names for a full disk."""
    try:
        with whole_file(path) as draft:
            yield draft
    except (RuntimeError, PermissionError) as error:
        reason = f"{error}; is the disk full or the folder read-only?"
        raise OSError(f"cannot write {path}: {reason}") from error


def _fill_file(
    file: "netCDF4.Dataset", content: Content, groups: Mapping[str, Content], complevel: int
) -> None:
    attributes = COMMON_ATTRIBUTES | dict(content.attributes)
    _fill(file, content._replace(attributes=attributes), complevel)
    for name, one in groups.items():
        _fill(file.createGroup(name), one, complevel)


def _fill(group: "netCDF4.Dataset", content: Content, complevel: int) -> None:
    group.setncatts(content.attributes)
    for variable in content.variables.values():
        for dim, length in zip(variable.dims, variable.values.shape, strict=True):
            if dim not in group.dimensions:
                group.createDimension(dim, length)
    for name in content.variables:
        _write_variable(group, name, content, complevel)


def _write_variable(group: "netCDF4.Dataset", name: str, content: Content, complevel: int) -> None:
    variable = content.variables[name]
    dims, values = variable.dims, variable.values
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
    return attributes | units | ancillary(name, variables) | along
