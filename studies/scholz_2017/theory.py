"""Mean spin of spinners, which a medium leads to its spin velocity and contacts stop."""

import json

import xarray as xr

from roughgas.judging import theory_over_grid
from roughgas.theory import collision_frequency, mean_spin_of_spinners


def mean_spin(gas: xr.Dataset) -> xr.DataArray:
    """Return the mean spin at the measured temperature, in a/T."""
    attributes = gas.attrs
    velocity = json.loads(attributes["langevin_json"])["spin_velocity"]

    def spin(point):
        """Return the mean spin at a point."""
        T_tr = 2.0 * float(gas.E_trans.sel(point))
        frequency = collision_frequency(T_tr, attributes["packing"], attributes["dimension"])
        kind = attributes["dimension"], attributes["inertia"]
        return velocity * mean_spin_of_spinners(point["beta"], frequency, point["spin_drag"], *kind)

    return theory_over_grid(gas, spin)
