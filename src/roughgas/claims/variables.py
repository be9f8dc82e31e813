"""Measured variables beside their theory, over the grid of a reduced dataset.

theory.py of a study has functions of a reduced dataset, named after its variables. They return the
theory of a variable over its dimensions.
"""

import itertools
import math
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from roughgas.base.files import study_module
from roughgas.claims.verdicts import NotTestedError, Sample, sample
from roughgas.data.reduced import STEADY_SHARE
from roughgas.theory.prediction import species_at

THEORY = "theory"
"""Module of a study with functions of a reduced dataset, named after variables: their theory."""


def theories_of(folder: str | Path, data: xr.Dataset) -> dict[str, xr.DataArray]:
    """Return the theory of variables of a reduced dataset by their names, from a study's theory.py.

    `folder` is the study's. Raises InputError for a missing file, or one that is no Python.
    """
    functions = vars(study_module(folder, THEORY))
    names = [str(name) for name in data.data_vars if callable(functions.get(str(name)))]
    return {name: functions[name](data) for name in names}


def theory_over_grid(
    data: xr.Dataset,
    theory: Callable[[Mapping[str, float]], Any],
    dims: tuple[str, ...] = (),
) -> xr.DataArray:
    """Return a theory at all points of a reduced dataset, over its grid and `dims`.

    `theory` is a function of the parameters of a point by name, r, beta and any swept quantity; its
    results are numbers, or arrays over `dims`, dimensions of the dataset.
    """
    grid = data.n_seeds.dims
    axes = [data[name].values for name in grid]
    results = [
        theory(dict(zip(map(str, grid), map(float, point), strict=True)))
        for point in itertools.product(*axes)
    ]
    shape = tuple(data.sizes[name] for name in (*grid, *dims))
    coordinates = {name: data[name] for name in (*grid, *dims) if name in data.coords}
    return xr.DataArray(np.reshape(results, shape), coordinates, (*grid, *dims))


def steady(data: xr.Dataset, values: xr.DataArray) -> xr.DataArray:
    """Return values over the grid of a reduced dataset, NaN where the gas is not known to be
    steady."""
    return values.where(data.equilibrated > STEADY_SHARE)


def deviation_of(
    data: xr.Dataset, name: str, expected: xr.DataArray, relative: bool = False
) -> Sample:
    """Return the variable `name` of a reduced dataset minus its theory at all steady points.

    `expected` is the theory, over dimensions of the variable. With `relative` the difference is
    over the theory. Errors are those of the variable, by default over seeds. Raises NotTestedError
    for a missing variable, and if no value is finite.
    """
    if name not in data:
        raise NotTestedError(f"the dataset holds no {name}")
    measured, theory = xr.broadcast(steady(data, data[name]), expected)
    gap = measured - theory
    stderr, dof, _ = xr.broadcast(
        data[f"{name}_stderr"], data.get(f"{name}_dof", data.n_seeds - 1.0), gap
    )
    scale = abs(theory) if relative else xr.ones_like(theory)
    ordered = (array.transpose(*gap.dims).values for array in (stderr / scale, dof))
    return sample(gap / scale, *ordered)


def species_temperature_ratio(data: xr.Dataset) -> xr.DataArray:
    """Return T_tr of each species by theory, over T_tr of the first: the theory of T_ratio_species.

    The first species is left out (NaN), since its ratio is 1 by definition. `data` is the reduced
    dataset of a mixture that cools.
    """

    def ratios(point):
        """Return the ratios (species,) at a point."""
        first, *others = species_at(data.attrs, point).T_tr
        return [math.nan, *(T / first for T in others)]

    return theory_over_grid(data, ratios, ("species",))
