"""R and cumulants of spheres that white noise drives, in the Sonine approximation."""

from functools import partial

import xarray as xr

from roughgas.judging import theory_over_grid
from roughgas.theory import sonine_state


def _of_state(name: str, gas: xr.Dataset) -> xr.DataArray:
    """Return a quantity of `sonine_state`, by its name, at all points of a reduced dataset."""
    kind = gas.attrs["dimension"], gas.attrs["inertia"], gas.attrs["spin_share"]
    return theory_over_grid(
        gas, lambda point: getattr(sonine_state(point["r"], point["beta"], *kind), name)
    )


R, a20, a02, a11, alignment = (
    partial(_of_state, name) for name in ("R", "a20", "a02", "a11", "alignment")
)
