"""Measured quantities of all gases in one list."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from roughgas.tasks import (
    Estimate,
    dataset,
    markdown,
    mean_estimate,
    read_variables,
    slices_along,
    stack_rows,
    table_cell,
)

CONTACT_ROUNDING = 1e-11
"""Relative error of one contact: doubles have 2e-16, and glancing contacts lose digits."""
VARIABLES = Path(__file__).with_name("variables.yaml")


def combine(task_results: Mapping[str, xr.Dataset], settings: Mapping[str, Any]) -> xr.Dataset:
    """Return every measured quantity, with its error."""
    rows = [
        {"task": task, "quantity": str(name), "value": average(values), "runs": values.size}
        for task, task_result in task_results.items()
        for name, values in task_result.data_vars.items()
        if name != "seconds"
    ]
    spent = {
        "task_name": list(task_results),
        "seconds": [float(task_result.seconds) for task_result in task_results.values()],
    }
    contacts, tracers = settings["contacts"], settings["tracers"]
    attributes = {
        "seed": settings["seed"],
        "particles": settings["fluids"]["particles"],
        "tracers": tracers["tracers"] / tracers["particles"],
        "mixed": settings["mixtures"]["packing"],
        **{name: contacts[name] for name in ("restitution", "roughness", "mu")},
    }
    return dataset(read_variables(VARIABLES), stack_rows(rows) | spent, **attributes)


def average(values: xr.DataArray) -> Estimate:
    """Return the mean over independent runs, or the value of the contact farthest from the median.

    Contacts differ by rounding alone. Their errors need not be independent, nor Gaussian;
    CONTACT_ROUNDING is taken as the error.
    """
    if values.dims == ("run",):
        return mean_estimate(values.values)
    middle = float(values.median())
    farthest = float(values.values[np.abs(values.values - middle).argmax()])
    return Estimate(farthest, CONTACT_ROUNDING * abs(middle))


def table(data: xr.Dataset) -> str:
    """Return all quantities, Markdown."""
    numbers = slices_along(data, "number")
    rows = [
        [number.task.item(), number.quantity.item(), table_cell(number, "value")]
        for number in numbers
    ]
    return f"## Gases of which something is known\n\n{markdown(['gas', 'quantity', 'found'], rows)}"
