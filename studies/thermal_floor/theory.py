"""Elastic disks above a thermal floor: they have its temperature, and fall off with height.

Energies are exact at any density. The density follows from the pressure p, the weight above, and
the equation of state p = n T (1 + 2 phi chi) of the packing fraction phi: dp/dy = -n m g. In a
dilute gas this is the barometric law.
"""

import json

import numpy as np
import xarray as xr

from roughgas.judging import theory_over_grid
from roughgas.theory import contact_value

LOWEST = 1e-9
"""Packing fraction above which there are no particles."""


def E_trans(bed: xr.Dataset) -> xr.DataArray:
    """Return the translational energy per degree of freedom, in m a^2/T^2; NaN for r < 1."""
    return theory_over_grid(bed, lambda point: _if_elastic(point, 0.5 * point["temperature"]))


def E_rot(bed: xr.Dataset) -> xr.DataArray:
    """Return the rotational energy per degree of freedom: equipartition."""
    return E_trans(bed)


def packing_profile(bed: xr.Dataset) -> xr.DataArray:
    """Return the packing fraction in layers; NaN for r < 1."""
    settings = json.loads(bed.attrs["experiment_json"])
    gravity, width = settings["effects"]["gravity"]["acceleration"], settings["box"][0]
    middle = bed.height.values
    edges = (middle[1] - middle[0]) * np.arange(len(middle) + 1)
    weight = np.pi * bed.attrs["particles"] * gravity / width  # times the packing over the density

    def profile(point):
        """Return the packing fractions (height,) at a point."""
        temperature = point["temperature"]
        packing = np.geomspace(LOWEST, 0.7, 10_000)
        pressure = packing * (1.0 + 2.0 * packing * contact_value(packing)) * temperature
        height = np.append(0.0, np.cumsum(np.diff(pressure) / packing[1:])) / gravity
        bottom = np.interp(weight, pressure, height)
        pressures = np.interp(np.maximum(edges - 1.0, 0.0), (bottom - height)[::-1], pressure[::-1])
        return _if_elastic(point, -np.diff(pressures) / np.diff(edges) / gravity)

    return theory_over_grid(bed, profile, ("height",))


def _if_elastic(point, value):
    """Return the value at a point of elastic particles; NaN at any other."""
    return value if point["r"] == 1.0 else np.nan * value
