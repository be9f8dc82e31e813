"""Energy of a gas driven by the Delta model, for Maxwellian velocities and spins."""

import json

import xarray as xr

from roughgas.judging import theory_over_grid
from roughgas.theory import delta_temperatures


def E_trans(gas: xr.Dataset) -> xr.DataArray:
    """Return the translational energy per degree of freedom, in m a^2/T^2."""
    speed = json.loads(gas.attrs["experiment_json"])["effects"]["delta"]["speed"]
    kind = gas.attrs["dimension"], gas.attrs.get("inertia")

    def energy(point):
        """Return the energy at a point."""
        T_tr, _ = delta_temperatures(point["r"], point["beta"], speed, *kind)
        return 0.5 * T_tr

    return theory_over_grid(gas, energy)
