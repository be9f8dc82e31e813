"""What the datasets of studies hold, as variables.yaml describes it, and how they are put together.

Needs neither kernel nor simulation: only numbers that jobs have found.
"""

import math
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr
import yaml

from roughgas.data.netcdf import read_groups
from roughgas.data.variables import Variable, described, register
from roughgas.statistics.errors import Estimate
from roughgas.studies.tasks import STUDIES

WORD, COUNT = "word", "count"


def dataset(study: str, found: Mapping[str, Any], **attributes: Any) -> xr.Dataset:
    """Return values and coordinates by name, each described; of Estimates, value and error."""
    return xr.Dataset(described(study, flat(found)), attrs=attributes)


def read_studies(path: str | Path) -> dict[str, xr.Dataset]:
    """Return the groups of all studies in the combined file at `path`, by name."""
    groups = read_groups(path)
    return {name: groups[name] for name in STUDIES if name in groups}


def estimate(data: xr.Dataset, name: str) -> Estimate:
    """Return the scalars `name` and `name`_stderr."""
    return Estimate(float(data[name]), float(data[f"{name}_stderr"]))


def mean(values: np.ndarray) -> Estimate:
    """Return the mean of independent values, shape (n,)."""
    return Estimate(float(values.mean()), float(values.std(ddof=1)) / math.sqrt(len(values)))


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


def _register_all() -> None:
    """Make the variables of all studies known to the registry."""
    studies = yaml.safe_load(Path(__file__).with_suffix(".yaml").read_text(encoding="utf-8"))
    words = studies.pop("placeholders")
    for study, groups in studies.items():
        entries = [(key, text, dims) for dims, one in groups.items() for key, text in one.items()]
        filled = [_variables(*one) for entry in entries for one in _filled(entry, words)]
        register(study, {name: about for one in filled for name, about in one.items()})


_register_all()
