"""The points of an experiment as one dataset over r, beta and the seed.

The grid has all combinations of the points' coordinates, a third axis first, if there is one. A
header describes the file of a point.
"""

import os
from collections.abc import Iterable, Mapping, Sequence
from glob import glob
from math import prod
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from roughgas.base import Attributes, InputError, NamedValues, on_one_line, short_repr
from roughgas.data.netcdf import POINT, opened, require
from roughgas.data.point import read_point
from roughgas.data.variables import POINT_COORDINATES, Array, described, swept_axis
from roughgas.results.axes import (
    POINT_ATTRIBUTES,
    Position,
    axes_of,
    coordinate,
    index_of,
    position_of,
)

if TYPE_CHECKING:
    import xarray

COMMON_ATTRIBUTES = ("experiment", "scale", "swept")
"""Attributes that must be the same at all points."""
NUMBERS, INTEGERS = "iuf", "iu"
"""Kinds of numpy dtypes for numbers and for integers."""


class Stored(NamedTuple):
    """A variable in the file of a point; `values` is None for values left in the file."""

    dims: tuple[str, ...]
    shape: tuple[int, ...]
    dtype: np.dtype[Any]
    attributes: Attributes
    values: np.ndarray | None
    is_coordinate: bool


class Header(NamedTuple):
    """Metadata of a point's file, which are read at once: its attributes and variables."""

    path: str
    attributes: Attributes
    position: Position
    variables: Mapping[str, Stored]
    source: Any  # dask object of all its arrays by name, or None


def open_points(points: str | Path | Iterable[str | Path]) -> "xarray.Dataset":
    """Return a dataset of several points over r, beta and the seed: see `roughgas.open_points`."""
    import xarray

    headers = [_header(path, lazy=_has_dask()) for path in _paths(points)]
    _check(headers)
    axes = axes_of(header.position for header in headers)
    grid = _grid_coordinates(headers, axes)
    lengths = _lengths(headers)
    unequal_dims = {
        dim for dim in lengths if not _are_equal(_in_all_points(dim, headers))
    } | grid.keys()
    variables: dict[str, Any] = dict(grid)
    coordinates = {*grid}
    for name in dict.fromkeys(name for header in headers for name in header.variables):
        stored = _in_all_points(name, headers)
        if name in grid or unequal_dims & {
            name,
            *(dim for variable in stored for dim in variable.dims),
        }:
            continue
        if (combined := _combined(name, headers, axes, lengths, tuple(grid))) is not None:
            variables[name] = combined
            coordinates |= {name} if stored[0].is_coordinate else set()
    variables_of_dataset = {
        name: xarray.Variable(*variable) for name, variable in variables.items()
    }
    shared = _common([header.attributes for header in headers])
    attributes = {name: value for name, value in shared.items() if name not in POINT_ATTRIBUTES}
    return xarray.Dataset(variables_of_dataset, attrs=attributes).set_coords(sorted(coordinates))


def _has_dask() -> bool:
    """Return whether dask is installed, so that arrays may stay in their files."""
    try:
        import dask.array  # noqa: F401
    except ImportError:
        return False
    return True


def _paths(points: str | Path | Iterable[str | Path]) -> list[str]:
    """Return the paths that a glob pattern, or a list of paths, selects.

    Raises InputError if there are none.
    """
    if not isinstance(points, str | os.PathLike):
        paths, quoted = [os.fspath(path) for path in points], "[]"
    else:
        text = os.fspath(points)
        paths = [text] if os.path.exists(text) else sorted(glob(text, recursive=True))
        quoted = short_repr(text)
    if not paths:
        raise InputError("points", quoted, "be files: there are none")
    return paths


def _header(path: str, lazy: bool) -> Header:
    """Return the header of the point at `path`; with `lazy`, arrays stay in the file, for dask.

    Raises InputError, which names the file, if it is no point.
    """
    data = read_point(path)
    require(data.attrs, ("swept_value",) if "swept" in data.attrs else (), path)
    variables = {}
    for name, variable in data.variables.items():
        is_coordinate = name in data.coords
        values = None if lazy and variable.dims and not is_coordinate else variable.values
        dims = tuple(map(str, variable.dims))
        variables[str(name)] = Stored(
            dims, variable.shape, variable.dtype, variable.attrs, values, is_coordinate
        )
    source = None
    if lazy:
        from dask import delayed

        source = delayed(_read)(os.path.abspath(path))
    return Header(path, data.attrs, position_of(data.attrs), variables, source)


def _check(headers: Sequence[Header]) -> None:
    """Raise InputError for points that do not belong in one dataset.

    They are of several experiments, scales or third axes, or two have the same coordinates.
    """
    for name in COMMON_ATTRIBUTES:
        values = sorted({str(header.attributes.get(name, "(none)")) for header in headers})
        if len(values) > 1:
            raise InputError(f"{name} of the points", on_one_line(" and ".join(values)), "be one")
    paths: dict[Position, str] = {}
    for header in headers:
        if header.position in paths:
            both = f"{paths[header.position]} and {header.path}"
            raise InputError("points", both, "differ in r, beta or seed")
        paths[header.position] = header.path


def _grid_coordinates(headers: Sequence[Header], axes: Sequence[Sequence[Any]]) -> dict[str, Array]:
    """Return the coordinate variables of the grid by name; `axes` are the coordinates."""
    values = [*map(coordinate, axes)]
    swept = swept_axis({**headers[0].attributes, "swept_value": values[0][0].item()})
    descriptions = {
        name: description._replace(dims=(name,))
        for name, description in (swept | POINT_COORDINATES).items()
    }
    return described(descriptions, dict(zip(descriptions, values, strict=True)))


def _in_all_points(name: str, headers: Sequence[Header]) -> list[Stored]:
    """Return the variable `name` of all points that have it, in their order."""
    return [header.variables[name] for header in headers if name in header.variables]


def _lengths(headers: Sequence[Header]) -> dict[str, int]:
    """Return the largest length of each netCDF dimension over the files of all points, by name."""
    lengths: dict[str, int] = {}
    for variable in (variable for header in headers for variable in header.variables.values()):
        for dim, length in zip(variable.dims, variable.shape, strict=True):
            lengths[dim] = max(length, lengths.get(dim, 0))
    return lengths


def _are_equal(variables: Sequence[Stored]) -> bool:
    """Return whether variables of points are in memory, with equal dimensions and values."""
    if any(variable.dims != variables[0].dims or variable.values is None for variable in variables):
        return False
    return all(_equal_values(variable.values, variables[0].values) for variable in variables)


def _equal_values(first: Any, second: Any) -> bool:
    """Return whether two arrays, or attributes, are equal; NaN equals NaN."""
    numbers = all(np.asarray(values).dtype.kind == "f" for values in (first, second))
    return bool(np.array_equal(first, second, equal_nan=numbers))


def _shared(variables: Sequence[Stored], shape: tuple[int, ...]) -> np.ndarray | None:
    """Return the values of a coordinate that all points share, each up to its length.

    They are the longest, with the given `shape`; None if values of points differ.
    """
    longest = next((variable for variable in variables if variable.shape == shape), None)
    if longest is None or longest.values is None:
        return None
    for variable in variables:
        begin = tuple(slice(length) for length in variable.shape)
        if variable.dims != longest.dims or not _equal_values(
            variable.values, longest.values[begin]
        ):
            return None
    return longest.values


def _combined(
    name: str,
    headers: Sequence[Header],
    axes: Sequence[Sequence[Any]],
    lengths: Mapping[str, int],
    grid: tuple[str, ...],
) -> Array | None:
    """Return the variable `name` over the grid of points, or a coordinate that all points share.

    `axes` are the coordinates of the grid, `grid` the names of its dimensions, `lengths` the
    largest length of each dimension in the files. None for variables that cannot be combined: text,
    variables with different dimensions, and integers along dimensions of different lengths, which
    NaN cannot pad.
    """
    stored = _in_all_points(name, headers)
    dims, attributes = stored[0].dims, _common([variable.attributes for variable in stored])
    shape = tuple(lengths[dim] for dim in dims)
    if stored[0].is_coordinate and (values := _shared(stored, shape)) is not None:
        return Array(dims, values, attributes)
    if any(variable.dims != dims or variable.dtype.kind not in NUMBERS for variable in stored):
        return None
    if any(variable.dtype.kind in INTEGERS for variable in stored) and any(
        variable.shape != shape for variable in stored
    ):
        return None
    return Array((*grid, *dims), _over_grid(name, headers, axes, shape), attributes)


def _over_grid(
    name: str, headers: Sequence[Header], axes: Sequence[Sequence[Any]], shape: tuple[int, ...]
) -> Any:
    """Return the values of the variable `name` over the grid, (*grid, *shape).

    They are a numpy array if all are in memory, else a dask array. `shape` is the shape in a point,
    or the largest. Missing values are NaN.
    """
    header_at = {
        index_of(header.position, axes): header for header in headers if name in header.variables
    }
    stored, sizes = _in_all_points(name, headers), tuple(map(len, axes))
    missing = [] if len(header_at) == prod(sizes) else [np.float64]
    dtype = np.result_type(*(variable.dtype for variable in stored), *missing)
    if any(variable.values is None for variable in stored):
        blocks = {k: _block(header.source, name, shape, dtype) for k, header in header_at.items()}
        return _stacked(blocks, sizes, shape, dtype)
    values = _empty((*sizes, *shape), dtype)
    for index, header in header_at.items():
        values[index] = _padded(header.variables[name].values, shape, dtype)
    return values


def _common(mappings: Sequence[Attributes]) -> NamedValues:
    """Return the attributes that have the same value in all mappings."""
    first, *remaining = mappings
    return {
        name: value
        for name, value in first.items()
        if all(name in mapping and _equal_values(mapping[name], value) for mapping in remaining)
    }


def _empty(shape: tuple[int, ...], dtype: np.dtype[Any]) -> np.ndarray:
    """Return an array of NaN, or of 0 for integers, which are overwritten."""
    return np.full(shape, np.nan if dtype.kind == "f" else 0, dtype)


def _read(path: str) -> dict[str, np.ndarray]:
    """Return the arrays of numbers in the file of a point by name; scalars are left out."""
    # threads of dask call this, but HDF5 allows only one: xarray, which may be writing, has a lock
    from xarray.backends.netCDF4_ import NETCDF4_PYTHON_LOCK

    with NETCDF4_PYTHON_LOCK, opened(path, POINT) as file:
        file.set_auto_mask(False)
        arrays = {
            name: variable for name, variable in file.variables.items() if variable.dtype is not str
        }
        return {name: variable[...] for name, variable in arrays.items() if variable.dimensions}


def _padded(values: Any, shape: tuple[int, ...], dtype: np.dtype[Any]) -> np.ndarray:
    """Return the values of a variable in a point, padded with NaN at the ends to a shape."""
    padded = _empty(shape, dtype)
    padded[tuple(slice(length) for length in values.shape)] = values
    return padded


def _block(source: Any, name: str, shape: tuple[int, ...], dtype: np.dtype[Any]) -> Any:
    """Return a dask array of the variable `name` of a point; computing it reads all of its file.

    `source` is the dask object of the arrays of that file.
    """
    from dask import array, delayed

    return array.from_delayed(delayed(_padded)(source[name], shape, dtype), shape, dtype)


def _stacked(
    blocks: Mapping[tuple[int, ...], Any],
    sizes: tuple[int, ...],
    shape: tuple[int, ...],
    dtype: np.dtype[Any],
    index: tuple[int, ...] = (),
) -> Any:
    """Return a dask array that stacks the arrays of points over the grid, NaN at missing points.

    `blocks` are the arrays, of the given `shape`, by the indices of the points, `sizes` the lengths
    of the grid's axes. It stacks along the axes after `index`, the indices along the first axes.
    """
    from dask import array

    if len(index) == len(sizes):
        return blocks[index] if index in blocks else array.full(shape, np.nan, dtype)
    inner = range(sizes[len(index)])
    return array.stack([_stacked(blocks, sizes, shape, dtype, (*index, k)) for k in inner])
