"""What all gases have shown: one long list of numbers."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from roughgas.tasks import Estimate, along, cell, dataset, markdown, mean, stacked, variables

ROUNDING = 1e-11
"""Relative error of one contact: numbers have 2e-16, of which glancing contacts lose digits."""
VARIABLES = Path(__file__).with_name("variables.yaml")


def combine(parts: Mapping[str, xr.Dataset], settings: Mapping[str, Any]) -> xr.Dataset:
    """Return every number that was measured, with its error."""
    rows = [
        {"task": task, "quantity": str(name), "value": average(values), "runs": values.size}
        for task, part in parts.items()
        for name, values in part.data_vars.items()
        if name != "seconds"
    ]
    spent = {"task_name": list(parts), "seconds": [float(part.seconds) for part in parts.values()]}
    contacts, tracers = settings["contacts"], settings["tracers"]
    about = {
        "seed": settings["seed"],
        "particles": settings["fluids"]["particles"],
        "tracers": tracers["tracers"] / tracers["particles"],
        "mixed": settings["mixtures"]["packing"],
        **{name: contacts[name] for name in ("restitution", "roughness", "mu")},
    }
    return dataset(variables(VARIABLES), stacked(rows) | spent, **about)


def average(values: xr.DataArray) -> Estimate:
    """Return the mean over independent runs, or the contact that is farthest from the median.

    Contacts differ by roundings alone. Their errors need not be independent, nor Gaussian: ROUNDING
    stands for them.
    """
    if values.dims == ("run",):
        return mean(values.values)
    middle = float(values.median())
    farthest = float(values.values[np.abs(values.values - middle).argmax()])
    return Estimate(farthest, ROUNDING * abs(middle))


def table(data: xr.Dataset) -> str:
    """Return all numbers as a table."""
    every = along(data, "number")
    rows = [[one.task.item(), one.quantity.item(), cell(one, "value")] for one in every]
    return f"## Gases of which something is known\n\n{markdown(['gas', 'quantity', 'found'], rows)}"
