"""The angle between spin and velocity by the Sonine approximation."""

import xarray as xr

from roughgas.judging import theory_over_grid
from roughgas.theory import sonine_state

ANGLE_OF_ALIGNMENT = 3 / 25
"""<cos^2> - 1/3 over the alignment 3 <(V.w)^2>/<V^2 w^2> - 1, if the distribution is Maxwellian
times 1 + b V^2 w^2 P_2(cos): 2/15 b <V^2> <w^2> over 2/5 b <V^4> <w^4>/(<V^2> <w^2>)."""


def cos2_angle(gas: xr.Dataset) -> xr.DataArray:
    """Return the mean of cos^2 of the angle between V and w; 1/3 without a correlation."""
    kind = gas.attrs["dimension"], gas.attrs["inertia"]
    alignment = theory_over_grid(
        gas, lambda point: sonine_state(point["r"], point["beta"], *kind).alignment
    )
    return 1 / 3 + ANGLE_OF_ALIGNMENT * alignment
