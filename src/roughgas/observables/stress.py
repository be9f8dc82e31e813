"""Stress: the pressure tensor, its kinetic and its collisional part, and the pressure.

    P_kl = (1/V) [ sum_i m V_ik V_il  +  (1/t) sum_contacts J_k s_l ],    p = trace P/D,

where V is the velocity without the mean flow of a sheared gas, J the momentum that a contact passes
on, and s the vector from centre to centre along which it does: J. H. Irving & J. G. Kirkwood, J.
Chem. Phys. 18, 817 (1950); of rough spheres C. K. K. Lun, J. Fluid Mech. 233, 539 (1991). All
contacts of a measurement count. In a steady sheared gas -P_xy times the shear rate and the volume
is the power of the shear, its `energy_input` per time. p/(n T) of an elastic gas is an equation of
state, 1 + 2 phi chi (disks) or 1 + 4 phi chi (spheres): D. Henderson, Mol. Phys. 30, 971 (1975);
N. F. Carnahan & K. E. Starling, J. Chem. Phys. 51, 635 (1969). Between walls, the stress is the
average over the box of that between particles.
"""

import math

import numpy as np

from roughgas.base import InputError
from roughgas.data.variables import ENERGY, SHEARED, Variable
from roughgas.effects import contact_stress
from roughgas.observables.frame import Frame, System
from roughgas.observables.plugin import Observable, Values

PRESSURE = f"{ENERGY} a^-D"
TENSOR = ("component", "along")

VARIABLES = {
    "component": Variable("component of a vector", "", ("component",), "str"),
    "along": Variable("axis that it is carried along", "", ("along",), "str"),
    "stress_kinetic": Variable("kinetic part of the pressure tensor", PRESSURE, TENSOR),
    "stress_collisional": Variable("collisional part of the pressure tensor", PRESSURE, TENSOR),
    "pressure": Variable("pressure p", PRESSURE),
    "compressibility": Variable("compressibility factor p/(n T)"),
    "shear_power": Variable(
        "power of the shear per particle, by the stress", f"{ENERGY} T^-1", when=(SHEARED,)
    ),
}


class Stress(Observable):
    """The pressure tensor, and the pressure."""

    effects = ("contact_stress",)
    variables = VARIABLES

    def __init__(self, system: System) -> None:
        super().__init__(system)
        if math.isinf(system.volume):
            legal = "not be given: an open box has no volume"
            raise InputError("observables.stress", "in this box", legal)
        self.coordinates = {"component": system.axes, "along": system.axes}

    def look(self, frame: Frame) -> Values:
        """Return both parts of the tensor, the collisional one since the look before."""
        V, D, volume = frame.thermal_velocity, self.system.dimension, self.system.volume
        sums = np.array([frame.rates[name] for name in contact_stress.SUMS])
        return {
            "stress_kinetic": V.T @ (frame.mass[:, None] * V) / volume,
            "stress_collisional": sums.reshape(3, 3)[:D, :D] / volume,
        }

    def combine(self, means: Values) -> Values:
        """Return the tensors, and what follows from them."""
        system, kinetic = self.system, means["stress_kinetic"]
        total = kinetic + means["stress_collisional"]
        found = dict(means) | {
            "pressure": np.trace(total) / system.dimension,
            "compressibility": np.trace(total) / np.trace(kinetic),
        }
        if system.shear_rate:
            share = system.volume / system.particles
            found["shear_power"] = -total[0, 1] * system.shear_rate * share
        return found
