"""Tools for studies that consist of tasks, where a parameter sweep is not enough.

A task is an independent job that computes numbers; all tasks of a study are combined into one
dataset, which a table and a figure show. This module has random seeds of tasks, descriptions of
their results, and cells of tables.

`roughgas.tasks.free_cooling` has methods to compute R of a freely cooling gas,
`roughgas.tasks.dsmc` a gas without positions, which `roughgas.tasks.driven_dsmc` drives by white
noise, and `roughgas.tasks.transport` its transport coefficients. Only these need the kernel.
"""

import math
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import xarray as xr
import yaml
from msgspec import to_builtins

from roughgas.base import CollapseError, InputError, NamedValues, Record, markdown, short_repr
from roughgas.base.fields import OwnSettings
from roughgas.base.text import with_minus_signs
from roughgas.data.variables import Variable, described
from roughgas.statistics.estimates import Estimate

if TYPE_CHECKING:
    from roughgas.scene.settings import SceneSettings

TEXT_UNIT, COUNT_UNIT = "word", "count"


def seed_sequence(settings: OwnSettings, *key: int) -> np.random.SeedSequence:
    """Return an independent seed of random numbers for each `key` and each `seed` of settings.

    `key` are numbers that tell the tasks of a study apart.
    """
    return np.random.SeedSequence(settings["seed"], spawn_key=key)


def timed(function: Callable[..., Any], *arguments: Any) -> tuple[Any, float]:
    """Return the result of `function(*arguments)`, and its CPU time in seconds."""
    start = time.process_time()
    return function(*arguments), time.process_time() - start


def require_single_species(experiment: "SceneSettings") -> None:
    """Raise InputError for an experiment with several species of particles."""
    if experiment.species:
        legal = "not be there in an experiment of this study, whose particles are alike"
        raise InputError("species", short_repr(to_builtins(experiment.species)), legal)


def read_variables(path: str | Path, study: str | None = None) -> dict[str, Variable]:
    """Return the variables that the YAML file at `path` describes, or its section `study`, by name.

    The format is, by dimensions, "name / unit: meaning"; no unit: a pure number, `count`: an
    integer, `word`: a string. A name with ± stands for NAME and for NAME_stderr, its standard
    error. <PLACEHOLDER> stands for each key of this entry of `placeholders`, <name> for its value.
    """
    content = yaml.safe_load(Path(path).read_text(encoding="utf-8"))
    placeholders = content.pop("placeholders", {})
    groups = content if study is None else content[study]
    entries = [
        (key, text, dims)
        for dims, entries_of_dims in groups.items()
        for key, text in entries_of_dims.items()
    ]
    filled = [
        _variables_of_entry(*texts)
        for entry in entries
        for texts in _without_placeholders(entry, placeholders)
    ]
    return {name: variable for variables in filled for name, variable in variables.items()}


def _without_placeholders(
    texts: tuple[str, ...], placeholders: Record
) -> Iterator[tuple[str, ...]]:
    """Yield the texts once for each key of the placeholder in the first text, filled in.

    `texts` are name, meaning and dimensions of an entry, `placeholders` the values by key and
    placeholder.
    """
    placeholder = next((key for key in placeholders if f"<{key}>" in texts[0]), None)
    for key, meaning in placeholders[placeholder].items() if placeholder else [("", "")]:
        yield tuple(
            text.replace(f"<{placeholder}>", key).replace("<name>", meaning) for text in texts
        )


def _variables_of_entry(key: str, long_name: str, dims: str) -> dict[str, Variable]:
    """Return the variable of an entry by name, and with ± also the variable of its standard error.

    `key` is "name / unit", `long_name` the meaning, `dims` has the dimensions, with commas between
    them.
    """
    name, _, unit = key.partition(" / ")
    units, dtype = {"": ("1", "f8"), TEXT_UNIT: ("", "str"), COUNT_UNIT: ("1", "i8")}.get(
        unit, (unit, "f8")
    )
    variable = Variable(long_name, units, tuple(dims.split(", ")) if dims else (), dtype)
    if not name.endswith(" ±"):
        return {name: variable}
    name = name.removesuffix(" ±")
    error_variable = variable._replace(long_name=f"standard error of {name}")
    return {name: variable, f"{name}_stderr": error_variable}


def dataset(variables: Mapping[str, Variable], values: Record, **attributes: Any) -> xr.Dataset:
    """Return a dataset of `values` by name, coordinates included, in the order of `variables`.

    `variables` describes them by name, `attributes` are the attributes of the dataset. An Estimate
    becomes its value and its error. Raises ValueError for values without a description, and for
    shapes that disagree.
    """
    return xr.Dataset(described(variables, split_estimates(values)), attrs=attributes)


def split_estimates(results: Record) -> NamedValues:
    """Return `results` by name, with each Estimate NAME replaced by NAME and NAME_stderr."""
    flat_values: dict[str, Any] = {}
    for name, value in results.items():
        if isinstance(value, Estimate):
            flat_values |= {name: value.value, f"{name}_stderr": value.stderr}
        else:
            flat_values[name] = value
    return flat_values


def stack_rows(rows: Sequence[Record]) -> NamedValues:
    """Return the values of several rows as arrays by name, with the rows along the first axis.

    A row is a mapping of values by name; all have the same names. An Estimate becomes its value and
    its error.
    """
    rows = [split_estimates(row) for row in rows]
    return {name: np.array([row[name] for row in rows]) for name in rows[0]}


def estimate_of(data: xr.Dataset, name: str) -> Estimate:
    """Return the Estimate of the scalar variables `name` and `name`_stderr of a dataset."""
    return Estimate(float(data[name]), float(data[f"{name}_stderr"]))


def mean_estimate(values: np.ndarray) -> Estimate:
    """Return the mean of independent `values`, shape (n,), with its standard error and its dof."""
    stderr = float(values.std(ddof=1)) / math.sqrt(len(values))
    return Estimate(float(values.mean()), stderr, len(values) - 1.0)


def estimate_ratio(numerator: Estimate, denominator: Estimate) -> Estimate:
    """Return `numerator` over `denominator`, two independent estimates, and its error.

    The error is to first order, and has infinitely many degrees of freedom. Neither estimate may be
    0.
    """
    quotient = numerator.value / denominator.value
    error = np.hypot(numerator.stderr / numerator.value, denominator.stderr / denominator.value)
    return Estimate(quotient, abs(quotient) * error)


def slices_along(data: xr.Dataset, dim: str) -> list[xr.Dataset]:
    """Return the slices of a dataset along a dimension."""
    return [data.isel({dim: k}) for k in range(data.sizes[dim])]


def table_cell(data: xr.Dataset, name: str, format_spec: str = "", factor: float = 1.0) -> str:
    """Return the scalar `name` of a dataset with its error, times `factor`, as text.

    `format_spec` is a format of Estimate, such as ".3f".
    """
    return f"{estimate_of(data, name).scaled(factor):{format_spec}}"


def point_title(point: xr.Dataset) -> str:
    """Return a title with the experiment, r and beta of a point, a dataset, as in settings."""
    beta = with_minus_signs(str(np.asarray(point.beta)))
    return f"{point.experiment.values}, r = {point.r.values}, β = {beta}"
