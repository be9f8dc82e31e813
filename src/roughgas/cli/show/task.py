"""A task of a study of accuracy."""

import json
from typing import TYPE_CHECKING, Any

import numpy as np

from roughgas.cli.layout import columns
from roughgas.data.point import read_point as read

if TYPE_CHECKING:
    import xarray

__all__ = ["read", "record", "text"]

MOST_VALUES = 4  # of a variable, that are all shown


def record(data: "xarray.Dataset") -> dict[str, Any]:
    """Attributes, sizes and single numbers, for a script."""
    scalars = {name: one.item() for name, one in data.variables.items() if not one.dims}
    return {"attributes": data.attrs, "sizes": dict(data.sizes), "variables": scalars}


def text(data: "xarray.Dataset") -> str:
    """For a person."""
    about = data.attrs
    again = f"roughgas study {about['study']} {about['task']} --scale {about['scale']} -o task.nc"
    chosen = json.loads(about["settings_json"])["study"]
    head = [["task", f"{about['task']} of the study {about['study']}, scale {about['scale']}"]]
    simple = {name: value for name, value in chosen.items() if not isinstance(value, dict | list)}
    head += [[name, str(value)] for name, value in simple.items()]
    table = [["variable", "over", "value"]]
    for name, one in data.variables.items():
        over = ", ".join(f"{dim} ({data.sizes[dim]})" for dim in one.dims)
        table.append([name, over, _values(one.values)])
    return "\n\n".join([columns(head), columns(table), f"To make it again: {again}"])


def _values(values: np.ndarray) -> str:
    """Few values as they are, many as their range."""
    if values.size <= MOST_VALUES or values.dtype.kind not in "fiu":
        return ", ".join(_one(value) for value in values.ravel()[:MOST_VALUES])
    there = values[np.isfinite(values)]
    if not there.size:
        return "nothing"
    return f"{_one(there.min())} to {_one(there.max())}, {_one(there.mean())} on average"


def _one(value: Any) -> str:
    return str(value) if isinstance(value, str) else f"{value:.5g}"
