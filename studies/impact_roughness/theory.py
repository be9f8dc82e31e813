"""R of a gas whose roughness depends on the normal speed, for Maxwellian velocities and spins.

Where kicks and collisions leave the spins' energy constant, McNamara & Luding (1998), Eq. (lun),
hold with averages over collisions of eta = q (1 + beta)/(2 + 2 q) and its square:

    T_rot/T_tr = <eta^2>/(<eta> - <eta^2>/q)

The normal speed g of collisions has the density g exp(-m g^2/(4 T_tr)), and is independent of the
tangential velocity. With a constant beta this is Lun's formula.
"""

import json

import numpy as np
import xarray as xr

NODES, WEIGHTS = np.polynomial.laguerre.laggauss(100)
"""Nodes m g^2/(4 T_tr) and weights of the average over collisions."""


def R(gas: xr.Dataset) -> xr.DataArray:
    """Return R at the measured temperature of translation."""
    law = json.loads(gas.attrs["experiment_json"])["effects"]["roughness_law"]
    q = gas.attrs["inertia"]
    collisions = xr.DataArray(NODES, dims="collision"), xr.DataArray(WEIGHTS, dims="collision")
    speed = np.sqrt(8.0 * gas.E_trans * collisions[0])  # E_trans is T_tr/2
    beta = 1.0 - (1.0 - gas.beta) * (speed / law["speed"]) ** gas.exponent
    eta = q * (1.0 + beta.clip(-1.0)) / (2.0 + 2.0 * q)
    mean, square = ((power * collisions[1]).sum("collision") for power in (eta, eta**2))
    return square / (mean + (1.0 - 1.0 / q) * square)
