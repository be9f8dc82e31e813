"""Judge of the slip of a flow at the walls of a channel."""

import numpy as np
import xarray as xr

from roughgas.judging import (
    Finding,
    check_power,
    grade,
    sample,
    steady,
    sum_error,
    text,
)


def rough_walls_slip_less(smooth: xr.Dataset, rough: xr.Dataset) -> Finding:
    """The velocity of the outer layers over the largest one is less between rough walls."""
    slips = [_slip(gas) for gas in (smooth, rough)]
    stderr, dof = sum_error([slip[1] for slip in slips], [slip[2] for slip in slips])
    gap = sample(slips[1][0] - slips[0][0], stderr, dof)
    largest, location = gap.largest()
    below = gap.is_significant() & (gap.value < 0.0)
    if not gap.is_significant().any():
        check_power(gap.detectable(), 0.1)
    reason = (
        f"The slip between rough walls is less significantly at {int(below.sum())} of {gap.size} "
        f"points; the largest difference is {text(largest)} at {location}."
    )
    return Finding(
        grade(bool(below.all()), below.mean() > 0.5),
        reason,
        (("largest difference of slip", largest),),
        gap.detectable(),
    )


def _slip(gas: xr.Dataset) -> tuple[xr.DataArray, np.ndarray, np.ndarray]:
    """Return the mean velocity in both outer layers over the largest one, its error and dof."""
    flow = gas.flow_profile.sel(component="x")
    stderr = gas.flow_profile_stderr.sel(component="x")
    highest = flow.max("height")
    outer = flow.isel(height=[0, -1]).mean("height")
    error = np.sqrt((stderr.isel(height=[0, -1]) ** 2).sum("height")) / 2.0
    dof = gas.flow_profile_dof.sel(component="x").isel(height=[0, -1]).min("height")
    return steady(gas, outer / highest), (error / highest).values, dof.values
