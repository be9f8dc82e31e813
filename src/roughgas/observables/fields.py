"""Fields: density, mean flow and temperatures in layers; the stress, of the whole box.

Layers are across the vertical axis, in a sheared gas across that of the shear. In each layer

    packing = n <V_a>,   T_k = <m (v_k - u_k)^2>,   T_rot = <m q a^2 (w - w_0)^2>/(2 D - 3),

and R = T_rot/(T_rot + T), T being the mean of T_k over the axes. <.> is the mean over the particles
in the layer at all looks; n their number density, V_a the area or volume of a particle, u = <m v>/
<m> the flow, and w_0 the mean spin likewise. In a sheared gas the linear flow is subtracted too.
As in a bed in J. J. Brey, M. J. Ruiz-Montero & F. Moreno, Phys. Rev. E 63, 061305 (2001).

The pressure tensor has a kinetic and a collisional part,

    P_kl = (1/V) [ sum_i m V_ik V_il  +  (1/t) sum_contacts J_k s_l ],    p = trace P/D,

where V is the velocity without the mean flow of a sheared gas, J the momentum that a contact passes
on, and s the vector from centre to centre along which it does: J. H. Irving & J. G. Kirkwood, J.
Chem. Phys. 18, 817 (1950); of rough spheres C. K. K. Lun, J. Fluid Mech. 233, 539 (1991). All
contacts of a measurement count. In a steady sheared gas -P_xy times the shear rate and the volume
is the power of the shear, its `energy_input` per time. p/(n T) of an elastic gas is an equation of
state, 1 + 2 phi chi (disks) or 1 + 4 phi chi (spheres): D. Henderson, Mol. Phys. 30, 971 (1975);
N. F. Carnahan & K. E. Starling, J. Chem. Phys. 51, 635 (1969). Between walls, the stress is the
average over the box of that between particles.

The heat flux is likewise (1/V) [ sum (m v^2 + m q a^2 w^2) v/2 + (1/t) sum_contacts e s ], e being
the energy that a contact passes on. Between thermal walls at a distance L it is the flux that they
give and take times (L - 2 a)/L, as centres come no closer than a.

Of a mixture, each species has the kinetic part of its own particles, and each pair of species the
collisional part of its contacts, half of it in either order: all pairs together make the whole, and
a species has the sum over its partners. In an elastic gas in equilibrium its partial pressure is

    p_i = n_i T [1 + (b/2) sum_j n_j (a_i + a_j)^D chi_ij],    b = pi (disks) or 4 pi/3 (spheres):

J. T. Jenkins & F. Mancini, J. Appl. Mech. 54, 27 (1987).
"""

import math
from collections.abc import Mapping
from typing import ClassVar

import numpy as np

from roughgas.base import InputError
from roughgas.data.variables import ENERGY, LENGTH, MIXTURE, SHEARED, SPEED, Variable
from roughgas.effects import contacts
from roughgas.effects.settings import Number
from roughgas.observables.plugin import PAIR, Frame, Observable, Setting, System, Values, Whole
from roughgas.theory.closed_forms import VOLUME

WIDTH = 2.0  # of a layer in a, in an open box
ALONG = ("height",)
EACH = (*ALONG, "component")


class Profiles(Observable):
    """Density, mean flow, temperatures and R in layers."""

    settings: ClassVar[Mapping[str, Setting]] = {
        "bins": Whole("Number of layers.", 1, 10_000, 50),
        "height": Number(
            "Height up to which layers reach, in a; the box's, or two a layer if it is open."
        ),
    }
    relaxations, of_flow, beds = 96.0, True, False
    variables: Mapping[str, Variable] = {
        "height": Variable("height of the middle of a layer", LENGTH, ALONG),
        "component": Variable("component of a vector", "", ("component",), "str"),
        "packing_profile": Variable("share of a layer that particles fill", "1", ALONG),
        "flow_profile": Variable("mean velocity in a layer", SPEED, EACH),
        "temperature_profile": Variable("mean square velocity about the mean flow", ENERGY, EACH),
        "T_rot_profile": Variable("temperature of the spins in a layer", ENERGY, ALONG),
        "R_profile": Variable("share of rotation in the energy of a layer", "1", ALONG),
        "share_above": Variable("share of particles above all layers"),
    }

    def __init__(self, system: System, bins: int, height: float | None) -> None:
        super().__init__(system)
        own = system.box[system.across]
        self._top = height or own or WIDTH * bins
        if own is not None and self._top > own:
            raise InputError("observables.profiles.height", height, f"be {own:g} or less, the box")
        self._bins, self._width = bins, self._top / bins
        self.coordinates = {
            "height": self._width * (np.arange(bins) + 0.5),
            "component": system.axes,
        }
        base = [length for axis, length in enumerate(system.box) if axis != system.across]
        self._volume = self._width * float(np.prod(np.array(base, float)))

    def look(self, frame: Frame) -> Values:
        """Return sums over the particles of each layer."""
        place = np.floor(frame.position[:, self.system.across] / self._width).astype(int)
        above, inside = np.mean(place >= self._bins), (place >= 0) & (place < self._bins)
        place, spin = place[inside], frame.thermal_spin[inside]
        velocity, V = frame.velocity[inside], frame.thermal_velocity[inside]
        mass, radius = frame.mass[inside], frame.radius[inside]
        spin_mass = mass * frame.inertia[inside]

        def summed(values, weight):
            columns = [np.bincount(place, weight * one, self._bins) for one in values.T]
            return np.array(columns).T

        return {
            "number": np.bincount(place, minlength=self._bins).astype(float),
            "filled": np.bincount(place, radius**self.system.dimension, self._bins),
            "m": np.bincount(place, mass, self._bins),
            "mv": summed(velocity, mass),
            "mV": summed(V, mass),
            "mVV": summed(V**2, mass),
            "s": np.bincount(place, spin_mass, self._bins),
            "sw": summed(spin, spin_mass),
            "sww": summed(spin**2, spin_mass),
            "above": np.array(above),
        }

    def combine(self, means: Values) -> Values:
        """Return the profiles."""
        number, system = means["number"], self.system
        mass, spin_mass = means["m"][:, None], means["s"][:, None]
        temperature = (means["mVV"] - means["mV"] ** 2 / mass) / number[:, None]
        found = {
            "packing_profile": means["filled"] * VOLUME[system.dimension] / self._volume,
            "flow_profile": means["mv"] / mass,
            "temperature_profile": temperature,
            "share_above": means["above"],
        }
        if system.inertia is None:
            return found
        turning = (means["sww"] - means["sw"] ** 2 / spin_mass).mean(axis=1)
        T_rot = turning / number
        R = T_rot / (T_rot + temperature.mean(axis=1))
        return found | {"T_rot_profile": T_rot, "R_profile": R}


PRESSURE, FLUX = f"{ENERGY} a^-D", f"{ENERGY} a^(1-D) T^-1"
TENSOR = ("component", "along")


class Stress(Observable):
    """The pressure tensor, and the pressure."""

    effects = ("contact_stress",)
    relaxations = 96.0
    doubtful = ("stress_collisional",)
    variables: Mapping[str, Variable] = {
        "component": Variable("component of a vector", "", ("component",), "str"),
        "along": Variable("axis that it is carried along", "", ("along",), "str"),
        "stress_kinetic": Variable("kinetic part of the pressure tensor", PRESSURE, TENSOR),
        "stress_collisional": Variable("collisional part of the pressure tensor", PRESSURE, TENSOR),
        "pressure": Variable("pressure p", PRESSURE),
        "compressibility": Variable("compressibility factor p/(n T)"),
        "shear_power": Variable(
            "power of the shear per particle, by the stress", f"{ENERGY} T^-1", when=(SHEARED,)
        ),
        "stress_kinetic_species": Variable(
            "kinetic part of a species", PRESSURE, ("species", *TENSOR), when=(MIXTURE,)
        ),
        "stress_collisional_species": Variable(
            "collisional part of a pair of species", PRESSURE, (*PAIR, *TENSOR), when=(MIXTURE,)
        ),
        "pressure_species": Variable(
            "pressure of a species", PRESSURE, ("species",), when=(MIXTURE,)
        ),
    }

    def __init__(self, system: System) -> None:
        super().__init__(system)
        if math.isinf(system.volume):
            legal = "not be given: an open box has no volume"
            raise InputError("observables.stress", "in this box", legal)
        self.coordinates = {"component": system.axes, "along": system.axes}

    def look(self, frame: Frame) -> Values:
        """Return both parts of the tensor, the collisional one since the look before."""
        D, volume = self.system.dimension, self.system.volume
        sums = frame.of_pairs(contacts.STRESSES)
        collisional = sums.reshape(*sums.shape[:2], 3, 3)[..., :D, :D] / volume
        found = {
            "stress_kinetic": _momentum_flux(frame) / volume,
            "stress_collisional": collisional.sum(axis=(0, 1)),
        }
        if not self.system.species:
            return found
        kinetic = [_momentum_flux(one) / volume for one in frame.of_each_species()]
        return found | {
            "stress_kinetic_species": np.array(kinetic),
            "stress_collisional_species": collisional,
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
        if system.species:
            own = means["stress_kinetic_species"] + means["stress_collisional_species"].sum(axis=1)
            found["pressure_species"] = np.trace(own, axis1=1, axis2=2) / system.dimension
        return found


def _momentum_flux(frame):
    """Return the sum of m V V, (D, D)."""
    V = frame.thermal_velocity
    return V.T @ (frame.mass[:, None] * V)


class HeatFlux(Observable):
    """The heat flux, of the whole box."""

    effects = ("contact_heat",)
    relaxations = 96.0
    variables: Mapping[str, Variable] = {
        "component": Variable("component of a vector", "", ("component",), "str"),
        "heat_flux": Variable("heat flux", FLUX, ("component",)),
        "heat_flux_species": Variable(
            "heat flux of a species, half of each contact with another",
            FLUX,
            ("species", "component"),
            when=(MIXTURE,),
        ),
        "heat_flux_collisional_species": Variable(
            "heat flux by contacts of a pair of species",
            FLUX,
            (*PAIR, "component"),
            when=(MIXTURE,),
        ),
    }

    def __init__(self, system: System) -> None:
        super().__init__(system)
        if math.isinf(system.volume) or system.shear_rate:
            raise InputError("observables.heat_flux", "in this box", "be of a closed one, at rest")
        self.coordinates = {"component": system.axes}

    def look(self, frame: Frame) -> Values:
        """Return the flux, its collisional part since the look before."""
        carried, volume = frame.of_pairs(contacts.HEAT), self.system.volume
        carried = carried[..., : self.system.dimension]
        flux = frame.energy @ frame.velocity + carried.sum(axis=(0, 1))
        found = {"heat_flux": flux / volume}
        if not self.system.species:
            return found
        flown = np.array([one.energy @ one.velocity for one in frame.of_each_species()])
        return found | {
            "heat_flux_species": (flown + carried.sum(axis=1)) / volume,
            "heat_flux_collisional_species": carried / volume,
        }
