"""Temperatures and stress of a dilute suspension in shear, by the moments of Grad's distribution.

Per particle, with the shear rate G, the drag g, the temperature T_ex of the medium, the relaxation
rate nu_s of the kinetic stress, and the changes C_tr and C_rot of the temperatures in contacts:

    dP_xy/dt = -G P_yy - (2 g + nu_s) P_xy,
    dP_yy/dt = -2 g (P_yy - T_ex) - nu_s (P_yy - T_tr) + C_tr,
    dT_tr/dt = -(2/D) G P_xy - 2 g (T_tr - T_ex) + C_tr,
    dT_rot/dt = -2 g_r (T_rot - T_ex) + C_rot.

R. Gomez Gonzalez & V. Garzo, Phys. Fluids 32, 073315 (2020), without products of stresses.
"""

import json
from typing import NamedTuple

import numpy as np
import xarray as xr

from roughgas import theory
from roughgas.judging import theory_over_grid

DILUTE = 1e-9
"""Packing fraction at which viscosity is kinetic alone."""
STEP = 0.02
"""Step of the integration, in the shortest of all times of relaxation."""
PRECISION = 1e-10


class Moments(NamedTuple):
    """Temperatures and stresses per particle, in m a^2/T^2."""

    T_tr: float
    T_rot: float
    P_xy: float
    P_yy: float


def E_trans(gas: xr.Dataset) -> xr.DataArray:
    """Return the translational energy per degree of freedom, in m a^2/T^2."""
    return theory_over_grid(gas, lambda point: 0.5 * stationary(gas.attrs, point).T_tr)


def stationary(attributes, point) -> Moments:
    """Return the stationary moments at a point of a dataset with these attributes."""
    bath = json.loads(attributes["langevin_json"])
    packing, kind = attributes["packing"], (attributes["dimension"], attributes["inertia"])
    height = (attributes["particles"] / theory.number_density(packing, kind[0])) ** (1 / kind[0])
    r, beta, rate = point["r"], point["beta"], point["velocity"] / height
    crowding = theory.contact_value(packing, kind[0])
    density = theory.number_density(packing, kind[0])
    moments = np.array([bath["temperature"], bath["spin_temperature"], 0.0, bath["temperature"]])
    while True:
        T_tr, T_rot, P_xy, P_yy = moments
        viscosity = theory.shear_viscosity(T_tr, T_rot, DILUTE, r, beta, *kind)
        relaxation = crowding * density * T_tr / viscosity
        frequency = theory.collision_frequency(T_tr, packing, kind[0])
        contact_tr, contact_rot = theory.temperature_changes(
            T_tr, T_rot, r, beta, *kind, frequency=frequency
        )
        changes = np.array(
            [
                -2.0 / kind[0] * rate * P_xy
                - 2.0 * bath["drag"] * (T_tr - bath["temperature"])
                + contact_tr,
                -2.0 * bath["spin_drag"] * (T_rot - bath["spin_temperature"]) + contact_rot,
                -rate * P_yy - (2.0 * bath["drag"] + relaxation) * P_xy,
                -2.0 * bath["drag"] * (P_yy - bath["temperature"])
                - relaxation * (P_yy - T_tr)
                + contact_tr,
            ]
        )
        step = changes * STEP / (rate + frequency + bath["drag"] + bath["spin_drag"])
        moments = moments + step
        if np.abs(step).max() < PRECISION * T_tr:
            return Moments(*moments)
