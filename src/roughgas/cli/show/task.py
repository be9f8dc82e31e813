"""A task of a study of accuracy."""

import json
from typing import TYPE_CHECKING, Any

import numpy as np

from roughgas.base.layout import columns
from roughgas.cli.show.parts import scalars
from roughgas.data.point import read_point as read

if TYPE_CHECKING:
    import xarray

__all__ = ["read", "record", "text"]

MOST_VALUES = 4  # of a variable, that are all shown


def record(data: "xarray.Dataset") -> dict[str, Any]:
    """Return attributes, sizes and single numbers."""
    return {"attributes": data.attrs, "sizes": dict(data.sizes), "variables": scalars(data)}


def text(data: "xarray.Dataset") -> str:
    """Return a summary for a person."""
    about = data.attrs
    chosen = json.loads(about["settings_json"])["study"]
    head = [["task", f"{about['task']} of the study {about['study']}, scale {about['scale']}"]]
    head += [[key, str(one)] for key, one in chosen.items() if not isinstance(one, dict | list)]
    table = [["variable", "over", "value"]]
    for name, one in data.variables.items():
        over = ", ".join(f"{dim} ({data.sizes[dim]})" for dim in one.dims)
        table.append([name, over, _values(one.values)])
    again = f"roughgas study {about['study']} {about['task']} --scale {about['scale']} -o task.nc"
    return "\n\n".join([columns(head), columns(table), f"To make it again: {again}"])


def _values(values: np.ndarray) -> str:
    """Return few values as they are, many as their range."""
    if values.size <= MOST_VALUES or values.dtype.kind not in "fiu":
        return ", ".join(_one(value) for value in values.ravel()[:MOST_VALUES])
    there = values[np.isfinite(values)]
    if not there.size:
        return "nothing"
    return f"{_one(there.min())} to {_one(there.max())}, {_one(there.mean())} on average"


def _one(value: Any) -> str:
    return str(value) if isinstance(value, str) else f"{value:.5g}"
