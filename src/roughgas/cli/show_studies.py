"""What `roughgas show` says of studies and their tasks."""

import json
from collections.abc import Mapping
from typing import Any

import numpy as np
from xarray import Dataset

from roughgas.base.layout import columns
from roughgas.statistics.errors import NO, UNKNOWN, YES

MOST_VALUES = 4  # of a variable, that are all shown
FLAGS = {YES: True, NO: False, UNKNOWN: None}


def scalars(data: Dataset) -> dict[str, Any]:
    """Return the single numbers of a dataset by name; flags are True, False, or None: unknown."""
    return {
        str(name): FLAGS[int(one)] if "flag_meanings" in one.attrs else one.values.item()
        for name, one in data.variables.items()
        if not one.dims
    }


def task_text(data: Dataset) -> str:
    """Return a table of the variables of a task."""
    about = data.attrs
    chosen = json.loads(about["settings_json"])["study"]
    head = [["task", f"{about['task']} of the study {about['study']}, scale {about['scale']}"]]
    head += [[key, str(one)] for key, one in chosen.items() if not isinstance(one, dict | list)]
    table = [["variable", "over", "value"]]
    for name, one in data.variables.items():
        over = ", ".join(f"{dim} ({data.sizes[dim]})" for dim in one.dims)
        table.append([str(name), over, _values(one.values)])
    file = f"results/{about['scale']}/studies/{about['study']}/{about['task']}.nc"
    return "\n\n".join([columns(head), columns(table), f"To make it again: snakemake -j1 {file}"])


def _values(values: np.ndarray) -> str:
    """Return few values as they are, many as their range."""
    if values.size <= MOST_VALUES or values.dtype.kind not in "fiu":
        few = values.ravel()[:MOST_VALUES]
        return ", ".join(str(one) if isinstance(one, str) else f"{one:.5g}" for one in few)
    there = values[np.isfinite(values)]
    if not there.size:
        return "nothing"
    return f"{there.min():.5g} to {there.max():.5g}, {there.mean():.5g} on average"


def task_record(data: Dataset) -> dict[str, Any]:
    """Return the sizes and single numbers of a task."""
    return {"sizes": dict(data.sizes), "variables": scalars(data)}


def studies_record(studies: Mapping[str, Dataset]) -> dict[str, Any]:
    """Return the same of each study, by name."""
    found = {name: {"attributes": one.attrs} | task_record(one) for name, one in studies.items()}
    return {"studies": found}


def studies_text(studies: Mapping[str, Dataset]) -> str:
    """Return the tables of all studies."""
    from roughgas.studies.tables import TABLES

    scales = {data.attrs["scale"] for data in studies.values()}
    parts = [TABLES[name](data).strip() for name, data in studies.items()]
    return "\n\n".join([f"scale {', '.join(sorted(scales))}", *parts])
