"""The dataset of one simulated point."""

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

from roughgas.base import Attributes, InputError, NamedValues, on_one_line
from roughgas.data import netcdf
from roughgas.data.netcdf import Content, in_memory, read_netcdf, write_netcdf
from roughgas.data.variables import (
    CLOCKS,
    POINT,
    POINT_COORDINATES,
    Array,
    Variable,
    described,
    raise_if_any,
    swept_axis,
)

if TYPE_CHECKING:
    import xarray

__all__ = ["Point", "as_dataset", "check", "read_point", "write_point"]

REQUIRED_OF_SPIN = ("R", "R_stderr", "R_dof", "R_ci95", "R_ratio_of_means", "E_rot")
"""Required variables of points whose particles spin, which have the attribute `inertia`."""
WALL_CLOCK = ("kernel_seconds",)
"""Variables that differ between runs of the same point; all others are reproducible."""


class Point(NamedTuple):
    """Results of one point (experiment, r, beta, seed): variables by name, and global attributes.

    Variables are registered ones (roughgas.data.variables.POINT), as numbers or arrays, and
    variables of observables, which `observed` describes. Attributes are strings, ints or floats.
    Required are the content of roughgas.data.netcdf's FILE_TYPES and, where particles spin,
    REQUIRED_OF_SPIN.
    """

    variables: dict[str, Any]
    attributes: dict[str, str | int | float]
    observed: Mapping[str, Variable] = {}  # descriptions of the variables of observables


def write_point(path: str | Path, point: Point) -> None:
    """Write `point` to `path` (netCDF4) atomically; parent folders are created.

    Raises ValueError for unregistered variables, for missing ones, and for shapes that disagree;
    OSError if the file cannot be written, as on a full disk.
    """
    write_netcdf(path, _content(point))


def read_point(path: str | Path) -> "xarray.Dataset":
    """Return the dataset of the point at `path` in memory; the file is closed.

    r, beta and the seed are coordinates even if the file, of an older roughgas, has them only as
    attributes. Raises InputError if the file is no point or damaged, OSError if it cannot be read.
    """
    import xarray

    data = read_netcdf(path, netcdf.POINT)
    variables: NamedValues = {str(name): data[name] for name in data.variables}
    coordinates = _coordinates(data.attrs, variables).items()
    try:
        missing = {
            name: xarray.Variable(*coordinate)
            for name, coordinate in coordinates
            if name not in variables
        }
        return data.assign_coords(missing)
    except ValueError as error:  # r may be a dimension, or an array, in a foreign file
        raise InputError("file", path, f"be a point: {on_one_line(str(error))}") from error


def as_dataset(point: Point) -> "xarray.Dataset":
    """Return the dataset that `write_point` and `read_point` would give, without a file.

    Raises ValueError as `write_point` does.
    """
    return in_memory(_content(point))


def check(point: Point) -> None:
    """Raise ValueError for variables that `write_point` would refuse.

    Missing variables and attributes are not noticed.
    """
    _described(point)


def _described(point: Point) -> NamedValues:
    """Return the variables of a point with dimensions and attributes, in units of its gas."""
    return described(
        "point", point.variables, CLOCKS[1] in point.variables, observed=point.observed
    )


def _coordinates(attributes: Attributes, variables: NamedValues) -> dict[str, Array]:
    """Return r, beta, the seed and the value on the third axis, if any, as scalar coordinates.

    Their values are in the attributes of the point. The third axis is left out if a variable in
    `variables`, or a dimension, has its name.
    """
    dims = {dim for variable in variables.values() for dim in variable.dims}
    used_names = {*variables} | dims | POINT.keys()
    third = {name: axis for name, axis in swept_axis(attributes).items() if name not in used_names}
    values = {name: attributes[name] for name in POINT_COORDINATES}
    values |= dict.fromkeys(third, attributes.get("swept_value"))
    return described(POINT_COORDINATES | third, values)


def _content(point: Point) -> Content:
    """Return the content of a point's file; raise ValueError as `write_point` does."""
    required_content = netcdf.FILE_TYPES[netcdf.POINT]
    required = required_content.variables | set(
        REQUIRED_OF_SPIN if "inertia" in point.attributes else ()
    )
    raise_if_any("missing variables of a point", required - set(point.variables))
    raise_if_any(
        "missing attributes of a point", required_content.attributes - set(point.attributes)
    )
    variables = _described(point)
    coordinates = _coordinates(point.attributes, variables)
    return Content(variables | coordinates, point.attributes, (*CLOCKS, *coordinates))
