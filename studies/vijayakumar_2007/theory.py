"""Shear stress on the walls of a channel, from the balance of momentum: exact."""

import json

import numpy as np
import xarray as xr

from roughgas.judging import theory_over_grid


def wall_shear_stress(gas: xr.Dataset) -> xr.DataArray:
    """Return the shear stress on each wall: half the force on all particles over the length."""
    settings = json.loads(gas.attrs["experiment_json"])
    force = gas.attrs["particles"] * settings["effects"]["gravity"]["acceleration"]
    stress = np.array([0.5 * force / settings["box"][0], np.nan])
    return theory_over_grid(
        gas, lambda point: np.tile(stress, (gas.sizes["wall"], 1)), ("wall", "component")
    )
