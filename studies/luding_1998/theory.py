"""Mean-field theory of a cooling gas: the rate equations of its two temperatures."""

import xarray as xr

from roughgas.judging import theory_over_grid
from roughgas.theory import relax


def E_trans(gas: xr.Dataset) -> xr.DataArray:
    """Return E_trans at the begin of the measured window, of a gas that had no spin at first.

    The unit is the initial E_trans.
    """
    kind = gas.attrs["dimension"], gas.attrs["inertia"]

    def energy(point):
        """Return E_trans at a point."""
        collisions = float(gas.measured_from.sel(point))
        return relax(0.0, point["r"], point["beta"], collisions, *kind).T_tr

    return theory_over_grid(gas, energy)
