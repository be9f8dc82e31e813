"""What studies with tasks of their own are made of: for questions that no sweep answers.

A task is an independent job that finds numbers; all tasks of a study are combined into one dataset,
of which a table and a figure are made. Here are the streams of random numbers of tasks, the
description of what they find, and the cells of tables.

`roughgas.tasks.free_cooling` has ways to R of a freely cooling gas, `roughgas.tasks.dsmc` a gas
without positions. Only these two need the kernel.
"""

import math
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr
import yaml

from roughgas.base import CollapseError, InputError, markdown, shown
from roughgas.data.variables import Variable, described
from roughgas.statistics.errors import Estimate

WORD, COUNT = "word", "count"


def stream(settings: Mapping[str, Any], *key: int) -> np.random.SeedSequence:
    """Return the seed of random numbers of their own, for each key and each `seed` of settings."""
    return np.random.SeedSequence(settings["seed"], spawn_key=key)


def timed(function: Callable[..., Any], *arguments: Any) -> tuple[Any, float]:
    """Return what a call returns, and the CPU seconds that it takes."""
    begin = time.process_time()
    return function(*arguments), time.process_time() - begin


def check_alike(experiment: Mapping[str, Any]) -> None:
    """Raise InputError for an experiment with species, in a study of particles that are alike."""
    if experiment.get("species"):
        legal = "not be there in an experiment of this study, whose particles are alike"
        raise InputError("species", shown(experiment["species"]), legal)


def variables(path: str | Path, study: str | None = None) -> dict[str, Variable]:
    """Return the variables that the YAML file at `path` describes, or its part `study`, by name.

    By dimensions, "name / unit: meaning"; no unit: a pure number, `count`: an integer, `word`: a
    string. A name with ± stands for NAME and for NAME_stderr, its standard error. <PLACEHOLDER>
    stands for each of the keys of that entry of `placeholders`, <name> for what these say.
    """
    found = yaml.safe_load(Path(path).read_text(encoding="utf-8"))
    words = found.pop("placeholders", {})
    groups = found if study is None else found[study]
    entries = [(key, text, dims) for dims, one in groups.items() for key, text in one.items()]
    filled = [_variables(*one) for entry in entries for one in _filled(entry, words)]
    return {name: about for one in filled for name, about in one.items()}


def _filled(texts: tuple[str, ...], words: Mapping[str, Any]) -> Iterator[tuple[str, ...]]:
    """Yield the texts once for each meaning of the placeholder in the first of them."""
    holder = next((word for word in words if f"<{word}>" in texts[0]), None)
    for word, name in words[holder].items() if holder else [("", "")]:
        yield tuple(text.replace(f"<{holder}>", word).replace("<name>", name) for text in texts)


def _variables(key: str, about: str, dims: str) -> dict[str, Variable]:
    name, _, unit = key.partition(" / ")
    units, dtype = {"": ("1", "f8"), WORD: ("", "str"), COUNT: ("1", "i8")}.get(unit, (unit, "f8"))
    one = Variable(about, units, tuple(dims.split(", ")) if dims else (), dtype)
    if not name.endswith(" ±"):
        return {name: one}
    name = name.removesuffix(" ±")
    error = one._replace(long_name=f"standard error of {name}")
    return {name: one, f"{name}_stderr": error}


def dataset(
    known: Mapping[str, Variable], found: Mapping[str, Any], **attributes: Any
) -> xr.Dataset:
    """Return values and coordinates by name, each described by `known`, in its order.

    An Estimate becomes its value and its error. Raises ValueError for variables that are not known,
    and for shapes that disagree.
    """
    return xr.Dataset(described(known, flat(found)), attrs=attributes)


def flat(found: Mapping[str, Any]) -> dict[str, Any]:
    """Return values by name, an Estimate NAME as NAME and NAME_stderr."""
    values: dict[str, Any] = {}
    for name, value in found.items():
        if isinstance(value, Estimate):
            values |= {name: value.value, f"{name}_stderr": value.stderr}
        else:
            values[name] = value
    return values


def stacked(rows: Sequence[Mapping[str, Any]]) -> dict[str, Any]:
    """Return what is found in several places by name, the places along the first axis."""
    rows = [flat(row) for row in rows]
    return {name: np.array([row[name] for row in rows]) for name in rows[0]}


def estimate(data: xr.Dataset, name: str) -> Estimate:
    """Return the scalars `name` and `name`_stderr."""
    return Estimate(float(data[name]), float(data[f"{name}_stderr"]))


def mean(values: np.ndarray) -> Estimate:
    """Return the mean of independent values, shape (n,)."""
    return Estimate(float(values.mean()), float(values.std(ddof=1)) / math.sqrt(len(values)))


def over(one: Estimate, other: Estimate) -> Estimate:
    """Return the quotient of two independent estimates."""
    quotient = one.value / other.value
    error = np.hypot(one.stderr / one.value, other.stderr / other.value)
    return Estimate(quotient, abs(quotient) * error)


def along(data: xr.Dataset, dim: str) -> list[xr.Dataset]:
    """Return the parts of a dataset along a dimension."""
    return [data.isel({dim: k}) for k in range(data.sizes[dim])]


def cell(data: xr.Dataset, name: str, how: str = "", factor: float = 1.0) -> str:
    """Return a value with its error, times `factor`, in a format of Estimate."""
    return f"{estimate(data, name).scaled(factor):{how}}"


def label(point: xr.Dataset) -> str:
    """Return what a point is called, of an experiment, r and beta as settings have them."""
    beta = str(np.asarray(point.beta)).replace("-", "−")
    return f"{point.experiment.values}, r = {point.r.values}, β = {beta}"
