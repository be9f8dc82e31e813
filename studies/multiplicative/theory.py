"""Energy of a gas whose kicks grow with the speed of the particle.

Kicks supply the power P <(v/v_0)^(2 delta)>, which balances the loss in contacts, proportional to
T^(3/2). In two dimensions, to first order in the cumulant a20 (the first Sonine polynomial),

    <(v/v_0)^(2 delta)> = (2 T/(m v_0^2))^delta Gamma(1 + delta) [1 + a20 delta (delta - 1)/2],

and the loss is that of a Maxwellian gas times 1 + 3 a20/16 (T. P. C. van Noije & M. H. Ernst,
Granular Matter 1, 57, 1998).
"""

import json
import math

import numpy as np
import xarray as xr

from roughgas.judging import theory_over_grid
from roughgas.theory import collision_frequency, temperature_changes

PLANE = 2
"""Dimension."""


def E_trans(gas: xr.Dataset) -> xr.DataArray:
    """Return the translational energy per degree of freedom of smooth disks, in m a^2/T^2.

    The cumulant a20 is the measured one.
    """
    kicks = json.loads(gas.attrs["experiment_json"])["effects"]["speed_kicks"]
    frequency = collision_frequency(1.0, gas.attrs["packing"])

    def maxwellian_power(point):
        """Return T^(3/2 - delta) of Maxwellian velocities at a point."""
        delta = point["exponent"]
        change, _ = temperature_changes(1.0, 0.0, point["r"], -1.0, PLANE, frequency=frequency)
        growth = math.gamma(1.0 + delta) * (2.0 / kicks["speed"] ** 2) ** delta
        return -kicks["power"] * growth / change

    delta, a20 = gas.exponent, gas.a20
    correction = (1.0 + a20 * delta * (delta - 1.0) / 2.0) / (1.0 + 3.0 * a20 / 16.0)
    power = theory_over_grid(gas, maxwellian_power) * correction
    return 0.5 * np.power(power, 1.0 / (1.5 - delta))
