"""The order of corners in figures and tables."""

import numpy as np
import xarray as xr

EXPERIMENTS = ("vibrated", "sheared", "cooling")


def in_order(data: xr.Dataset) -> xr.Dataset:
    """Return the corners sorted by experiment, and there from weak to strong dissipation."""
    order = [*EXPERIMENTS, *dict.fromkeys(data.experiment.values)]
    experiment = [order.index(name) for name in data.experiment.values]
    r, beta = data.r.values.astype(float), data.beta.values.astype(float)
    return data.isel(corner=np.lexsort((-beta, -r, experiment)))
