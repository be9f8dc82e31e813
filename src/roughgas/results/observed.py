"""What observables have watched at points of an experiment, combined over seeds.

A point's file says itself what its observables are: their variables have an attribute `observable`,
and those that are averages an error, <name>_stderr and <name>_dof, besides.
"""

from collections.abc import Mapping, Sequence
from typing import Any, Protocol

import netCDF4
import numpy as np

from roughgas.base import InputError
from roughgas.data.netcdf import unit_of
from roughgas.data.variables import Array
from roughgas.statistics.errors import pooled

ERRORS = ("stderr", "dof")
SIMPLE = ("long_name", "observable")


class Seen(Protocol):
    """A point (roughgas.results.reduce.Summary)."""

    @property
    def place(self) -> tuple[Any, ...]: ...

    @property
    def observed(self) -> Mapping[str, Array]: ...


def observed_in(file: netCDF4.Dataset) -> dict[str, Array]:
    """Return the variables of observables in the file of a point."""
    found = {}
    for name, variable in file.variables.items():
        about = {key: variable.getncattr(key) for key in variable.ncattrs()}
        if "observable" in about:
            attributes = {key: about[key] for key in SIMPLE} | {"units": unit_of(about)}
            found[name] = Array(variable.dimensions, np.asarray(variable[...]), attributes)
    return found


def reduced_observables(
    points: Sequence[Seen], axes: Sequence[Sequence[Any]], grid: tuple[str, ...]
) -> dict[str, Array]:
    """Return means over seeds with pooled errors, over the grid (its `axes`, and last the seeds).

    Raises InputError where points have watched along different coordinates.
    """
    first = {name: one for point in reversed(points) for name, one in point.observed.items()}
    found: dict[str, Array] = {}
    for name, array in first.items():
        if f"{name}_stderr" in first:
            found |= _averages(name, array, points, axes, grid)
        elif not name.endswith(tuple(f"_{error}" for error in ERRORS)):
            found[name] = _coordinate(name, array, points)
    return found


def _coordinate(name: str, array: Array, points: Sequence[Seen]) -> Array:
    for point in points:
        other = point.observed.get(name, array)
        if not np.array_equal(other.values, array.values):
            raise InputError(f"{name} of the points", "not the same", "be the same at all points")
    return array


def _averages(name, array, points, axes, grid) -> dict[str, Array]:
    """Return the mean over seeds of one variable, and its error."""
    ends = ("", *(f"_{error}" for error in ERRORS))
    shape = (*map(len, axes), *array.values.shape)
    stacks = {end: np.full(shape, np.nan) for end in ends}
    for point in points:
        place = tuple(axis.index(value) for axis, value in zip(axes, point.place, strict=True))
        for end in ends:
            if name + end in point.observed:
                values = point.observed[name + end].values
                if values.shape != array.values.shape:
                    legal = "have the same shape at all points"
                    raise InputError(f"{name} of the points", values.shape, legal)
                stacks[end][place] = values
    seeds = {end: np.moveaxis(stack, len(axes) - 1, -1) for end, stack in stacks.items()}
    means = _over_seeds(seeds)
    about = {end: points_about(array.attrs, name, end) for end in ends}
    return {
        name + end: Array((*grid, *array.dims), values, about[end])
        for end, values in zip(ends, means, strict=True)
    }


def _over_seeds(seeds: Mapping[str, np.ndarray]) -> list[np.ndarray]:
    """Return means, pooled errors and their degrees of freedom, along the last axis."""
    value, stderr, dof = seeds.values()
    there = np.isfinite(value)
    found = [np.full(value.shape[:-1], np.nan) for _ in range(3)]
    for place in zip(*np.nonzero(there.any(-1)), strict=True):
        some = there[place]
        error = pooled(value[place][some], stderr[place][some], dof[place][some])
        for one, number in zip(found, (value[place][some].mean(), *error), strict=True):
            one[place] = number
    return found


def points_about(attributes: Mapping[str, Any], name: str, end: str) -> dict[str, Any]:
    """Return the attributes of a mean over seeds, or of its error."""
    if not end:
        return dict(attributes)
    pooled_error = f"standard error of {name}: scatter over seeds and error within them, pooled"
    freedom = f"degrees of freedom that {name}_stderr is known with"
    units = {"units": "1"} if end == "_dof" else {}
    return {**attributes, **units, "long_name": freedom if end == "_dof" else pooled_error}
