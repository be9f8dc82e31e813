"""The dataset of one simulated point."""

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

from roughgas.data import netcdf
from roughgas.data.netcdf import Content, in_memory, read_netcdf, write_netcdf
from roughgas.data.variables import CLOCKS, Variable, described, refuse

if TYPE_CHECKING:
    import xarray

__all__ = ["Point", "as_dataset", "read_point", "write_point"]

REQUIRED_OF_SPIN = ("R", "R_stderr", "R_dof", "R_ci95", "R_ratio_of_means", "E_rot")
"""What a point holds besides netcdf.KINDS where particles spin, and so has `inertia`."""
WALL_CLOCK = ("kernel_seconds",)
"""The only variables that differ when the same point is run again."""


class Point(NamedTuple):
    """One (experiment, r, beta, seed): registered variables by name, and global attributes.

    Attributes are strings, ints or floats. What roughgas.data.netcdf.KINDS says must be there, and
    REQUIRED_OF_SPIN where particles spin.
    """

    variables: dict[str, Any]
    attributes: dict[str, str | int | float]
    observed: Mapping[str, Variable] = {}  # what those of observables are


def write_point(path: str | Path, point: Point) -> None:
    """Write `point` to `path` (netCDF4), whole or not at all; parent folders are created.

    Raises ValueError for unregistered variables, for missing ones, and for shapes that disagree;
    OSError if the file cannot be written, as on a full disk.
    """
    write_netcdf(path, _content(point))


def read_point(path: str | Path) -> "xarray.Dataset":
    """Return the dataset of a point in memory; the file is closed.

    Raises InputError if the file is something else or damaged, OSError if there is none.
    """
    return read_netcdf(path, netcdf.POINT)


def as_dataset(point: Point) -> "xarray.Dataset":
    """Return what `read_point` gives of the file that `write_point` makes, without that file.

    Raises ValueError as `write_point` does.
    """
    return in_memory(_content(point))


def _content(point: Point) -> Content:
    least = netcdf.KINDS[netcdf.POINT]
    required = least.variables | set(REQUIRED_OF_SPIN if "inertia" in point.attributes else ())
    refuse("missing variables of a point", required - set(point.variables))
    refuse("missing attributes of a point", least.attributes - set(point.attributes))
    cooling = CLOCKS[1] in point.variables
    found = described("point", point.variables, cooling, observed=point.observed)
    return Content(found, point.attributes)
