"""Profiles of density, mean flow and temperatures in layers; stress and heat flux of the box.

Layers are normal to the vertical axis, in a sheared gas to the gradient axis. In each layer

    packing = n <V_a>,   T_k = <m (v_k - u_k)^2>,   T_rot = <m q a^2 (w - w_0)^2>/(2 D - 3),

and R = T_rot/(T_rot + T), T being the mean of T_k over the axes. <.> is the mean over the particles
in the layer in all observations; n is their number density, V_a the area or volume of a particle,
u = <m v>/<m> the flow, and w_0 the mean spin likewise. In a sheared gas the linear flow is
subtracted too. As in a bed in J. J. Brey, M. J. Ruiz-Montero & F. Moreno, Phys. Rev. E 63, 061305
(2001).

The pressure tensor is the sum of a kinetic and a collisional term,

    P_kl = (1/V) [ sum_i m V_ik V_il  +  (1/t) sum_contacts J_k s_l ],    p = trace P/D,

where V is the velocity without the mean flow of a sheared gas, J the momentum that a contact
transfers, and s the vector from centre to centre in its direction: J. H. Irving & J. G. Kirkwood,
J. Chem. Phys. 18, 817 (1950); for rough spheres C. K. K. Lun, J. Fluid Mech. 233, 539 (1991). All
contacts of a measurement count. In a steady sheared gas -P_xy times the shear rate and the volume
is the power of the shear, its `energy_input` per time. p/(n T) of an elastic gas is an equation of
state, 1 + 2 phi chi (disks) or 1 + 4 phi chi (spheres): D. Henderson, Mol. Phys. 30, 971 (1975);
N. F. Carnahan & K. E. Starling, J. Chem. Phys. 51, 635 (1969). Between walls, the stress between
particles is averaged over the box.

The heat flux is likewise (1/V) [ sum (m v^2 + m q a^2 w^2) v/2 + (1/t) sum_contacts e s ], e being
the energy that a contact transfers. Between thermal walls at a distance L it is the flux through
the walls times (L - 2 a)/L, as centres stay at a distance a from walls.

In a mixture, the kinetic term of a species is a sum over its particles, and the collisional term of
a pair of species a sum over its contacts, half for each order, so that the total is the sum over
all pairs. A species has the sum over its partners. In an elastic gas in equilibrium its partial
pressure is

    p_i = n_i T [1 + (b/2) sum_j n_j (a_i + a_j)^D chi_ij],    b = pi (disks) or 4 pi/3 (spheres):

J. T. Jenkins & F. Mancini, J. Appl. Mech. 54, 27 (1987).

Arrays (k, ...) are of the k instants of a FrameSeries.
"""

import math
from collections.abc import Mapping
from typing import Annotated

import numpy as np

from roughgas.base import InputError
from roughgas.base.fields import number, whole
from roughgas.data.variables import ENERGY, LENGTH, MIXTURE, SHEARED, SPEED, Variable
from roughgas.effects import contacts
from roughgas.observables.averages import NamedArrays
from roughgas.observables.frames import FrameSeries, System
from roughgas.observables.plugin import PAIR, Observable, ObservableSettings, columnwise
from roughgas.theory.closed_forms import VOLUME

DEFAULT_LAYER_WIDTH = 2.0  # in a, in an open box
HEIGHT_DIMS = ("height",)
HEIGHT_COMPONENT_DIMS = (*HEIGHT_DIMS, "component")


Height = Annotated[
    float,
    number(
        "(0, inf)",
        "Height up to which layers reach, in a; the box's, or two a layer if it is open.",
    ),
]


class ProfilesSettings(ObservableSettings, frozen=True, kw_only=True):
    """Settings of `profiles`."""

    bins: Annotated[int, whole(1, 10_000, "Number of layers.")] = 50
    height: Height | None = None


class Profiles(Observable):
    """Density, mean flow, temperatures and R in layers."""

    settings = ProfilesSettings
    relaxations, depends_on_flow, valid_in_beds = 96.0, True, False
    variables: Mapping[str, Variable] = {
        "height": Variable("height of the middle of a layer", LENGTH, HEIGHT_DIMS),
        "component": Variable("component of a vector", "", ("component",), "str"),
        "packing_profile": Variable("share of a layer that particles fill", "1", HEIGHT_DIMS),
        "flow_profile": Variable("mean velocity in a layer", SPEED, HEIGHT_COMPONENT_DIMS),
        "temperature_profile": Variable(
            "mean square velocity about the mean flow", ENERGY, HEIGHT_COMPONENT_DIMS
        ),
        "T_rot_profile": Variable("temperature of the spins in a layer", ENERGY, HEIGHT_DIMS),
        "R_profile": Variable("share of rotation in the energy of a layer", "1", HEIGHT_DIMS),
        "share_above": Variable("share of particles above all layers"),
    }

    def __init__(self, system: System, bins: int, height: float | None) -> None:
        """Divide the box up to `height` (particle radii a) into `bins` layers, as in settings.

        Raises InputError for a height above the box.
        """
        super().__init__(system)
        box_height = system.box[system.layer_axis]
        self._top = height or box_height or DEFAULT_LAYER_WIDTH * bins
        if box_height is not None and self._top > box_height:
            raise InputError(
                "observables.profiles.height", height, f"be {box_height:g} or less, the box"
            )
        self._bins, self._width = bins, self._top / bins
        self.coordinates = {
            "height": self._width * (np.arange(bins) + 0.5),
            "component": system.axes,
        }
        base_lengths = [
            length for axis, length in enumerate(system.box) if axis != system.layer_axis
        ]
        self._volume = self._width * float(np.prod(np.array(base_lengths, float)))

    def observe_series(self, frames: FrameSeries) -> NamedArrays:
        """Return sums over the particles of each layer, (k, layers) or (k, layers, axes).

        They are the number, radius^D, and moments of velocities and spins with masses; `above` (k,)
        is the share of particles above all layers.
        """
        instants, bins = frames.instants, self._bins
        layer = np.floor(frames.position[..., self.system.layer_axis] / self._width).astype(int)
        share_above = np.mean(layer >= bins, axis=-1)
        layer[(layer < 0) | (layer > bins)] = bins  # one bin for all particles outside
        layer = (layer + (bins + 1) * np.arange(instants)[:, None]).ravel()

        def layer_sums(values):
            """Return the sums of `values` (k, N) of particles in each layer, (k, layers)."""
            weights = np.broadcast_to(values, frames.position.shape[:-1]).ravel()
            sums = np.bincount(layer, weights, instants * (bins + 1))
            return sums.reshape(instants, -1)[:, :-1]

        def component_sums(values, weight):
            """Return sums of `weight` times vectors `values` in each layer."""
            columns = [layer_sums(weight * values[..., axis]) for axis in range(values.shape[-1])]
            return np.stack(columns, axis=-1)

        V, spin = frames.thermal_velocity, frames.thermal_spin
        mass, spin_mass = frames.mass, frames.mass * frames.inertia
        return {
            "number": layer_sums(1.0),
            "filled": layer_sums(frames.radius**self.system.dimension),
            "m": layer_sums(mass),
            "mv": component_sums(frames.velocity, mass),
            "mV": component_sums(V, mass),
            "mVV": component_sums(V**2, mass),
            "s": layer_sums(spin_mass),
            "sw": component_sums(spin, spin_mass),
            "sww": component_sums(spin**2, spin_mass),
            "above": share_above,
        }

    @columnwise
    def combine(self, means: NamedArrays) -> NamedArrays:
        """Return the profiles, (layers,) or (layers, D), from `means` of sums over layers."""
        number, system = means["number"], self.system
        mass, spin_mass = means["m"][:, None], means["s"][:, None]
        temperature = (means["mVV"] - means["mV"] ** 2 / mass) / number[:, None]
        profiles = {
            "packing_profile": means["filled"] * VOLUME[system.dimension] / self._volume,
            "flow_profile": means["mv"] / mass,
            "temperature_profile": temperature,
            "share_above": means["above"],
        }
        if system.inertia is None:
            return profiles
        spin_energy = (means["sww"] - means["sw"] ** 2 / spin_mass).mean(axis=1)
        T_rot = spin_energy / number
        R = T_rot / (T_rot + temperature.mean(axis=1))
        return profiles | {"T_rot_profile": T_rot, "R_profile": R}


PRESSURE, FLUX = f"{ENERGY} a^-D", f"{ENERGY} a^(1-D) T^-1"
TENSOR = ("component", "along")


class Stress(Observable):
    """The pressure tensor, and the pressure."""

    effects = ("contact_stress",)
    relaxations = 96.0
    unvalidated = ("stress_collisional",)
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
        """Store the system; raise InputError for an open box."""
        super().__init__(system)
        if math.isinf(system.volume):
            legal = "not be given: an open box has no volume"
            raise InputError("observables.stress", "in this box", legal)
        self.coordinates = {"component": system.axes, "along": system.axes}

    def observe_series(self, frames: FrameSeries) -> NamedArrays:
        """Return kinetic and collisional pressure tensors, in m a^2/T^2 over a^D.

        Shape (k, D, D); for each species and pair of species (k, species, ..., D, D). The
        collisional term is a mean since the previous observation.
        """
        D, volume = self.system.dimension, self.system.volume
        sums = frames.pair_rates(contacts.STRESSES)
        collisional = sums.reshape(*sums.shape[:-1], 3, 3)[..., :D, :D] / volume
        stresses = {
            "stress_kinetic": momentum_flux(frames) / volume,
            "stress_collisional": collisional.sum(axis=(1, 2)),
        }
        if not self.system.species:
            return stresses
        kinetic = [
            momentum_flux(frames_of_species) / volume for frames_of_species in frames.by_species()
        ]
        return stresses | {
            "stress_kinetic_species": np.stack(kinetic, axis=1),
            "stress_collisional_species": collisional,
        }

    @columnwise
    def combine(self, means: NamedArrays) -> NamedArrays:
        """Return the mean pressure tensors, and pressure, compressibility and power.

        Tensors are (D, D), or have leading axes of species.
        """
        system, kinetic = self.system, means["stress_kinetic"]
        total = kinetic + means["stress_collisional"]
        results = dict(means) | {
            "pressure": np.trace(total) / system.dimension,
            "compressibility": np.trace(total) / np.trace(kinetic),
        }
        if system.shear_rate:
            volume_per_particle = system.volume / system.particles
            results["shear_power"] = -total[0, 1] * system.shear_rate * volume_per_particle
        if system.species:
            species_stress = means["stress_kinetic_species"] + means[
                "stress_collisional_species"
            ].sum(axis=1)
            results["pressure_species"] = (
                np.trace(species_stress, axis1=1, axis2=2) / system.dimension
            )
        return results


def momentum_flux(frames: FrameSeries) -> np.ndarray:
    """Return the sum of m V V over particles in m a^2/T^2, (k, D, D).

    V is the velocity without the mean flow.
    """
    V = frames.thermal_velocity
    return V.swapaxes(-1, -2) @ (frames.mass[:, None] * V)


def energy_flux(frames: FrameSeries) -> np.ndarray:
    """Return the sum of (m v^2 + m q a^2 w^2) v/2 over particles in m a^3/T^3, (k, D)."""
    return (frames.energy[:, None] @ frames.velocity)[:, 0]


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
        """Store the system; raise InputError for an open box, and for a sheared gas."""
        super().__init__(system)
        if math.isinf(system.volume) or system.shear_rate:
            raise InputError("observables.heat_flux", "in this box", "be of a closed one, at rest")
        self.coordinates = {"component": system.axes}

    def observe_series(self, frames: FrameSeries) -> NamedArrays:
        """Return the heat flux of the box in m/T^3 times a^(3-D), (k, D), and by species.

        The collisional term is a mean since the previous observation.
        """
        collisional, volume = frames.pair_rates(contacts.HEAT), self.system.volume
        collisional = collisional[..., : self.system.dimension]
        flux = energy_flux(frames) + collisional.sum(axis=(1, 2))
        fluxes = {"heat_flux": flux / volume}
        if not self.system.species:
            return fluxes
        kinetic = np.stack(
            [energy_flux(frames_of_species) for frames_of_species in frames.by_species()], axis=1
        )
        return fluxes | {
            "heat_flux_species": (kinetic + collisional.sum(axis=2)) / volume,
            "heat_flux_collisional_species": collisional / volume,
        }
