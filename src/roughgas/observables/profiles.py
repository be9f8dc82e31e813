"""Profiles: density, mean flow and temperatures in layers.

Layers are across the vertical axis, in a sheared gas across that of the shear. In each layer

    packing = n <V_a>,   T_k = <m (v_k - u_k)^2>,   T_rot = <m q a^2 (w - w_0)^2>/(2 D - 3),

and R = T_rot/(T_rot + T), T being the mean of T_k over the axes. <.> is the mean over the particles
in the layer at all looks; n their number density, V_a the area or volume of a particle, u = <m v>/
<m> the flow, and w_0 the mean spin likewise. In a sheared gas the linear flow is subtracted too.
As in a bed in J. J. Brey, M. J. Ruiz-Montero & F. Moreno, Phys. Rev. E 63, 061305 (2001).
"""

import numpy as np

from roughgas.base import InputError
from roughgas.data.variables import ENERGY, LENGTH, SPEED, Variable
from roughgas.effects.settings import Number
from roughgas.observables.frame import Frame, System
from roughgas.observables.plugin import Observable, Setting, Values, Whole
from roughgas.theory.transport import VOLUME

WIDTH = 2.0  # of a layer in a, in an open box
ALONG = ("height",)
EACH = (*ALONG, "component")

SETTINGS: dict[str, Setting] = {
    "bins": Whole("Number of layers.", 1, 10_000, 50),
    "height": Number(
        "Height up to which layers reach, in a; the box's, or two a layer if it is open."
    ),
}
VARIABLES = {
    "height": Variable("height of the middle of a layer", LENGTH, ALONG),
    "component": Variable("component of a vector", "", ("component",), "str"),
    "packing_profile": Variable("share of a layer that particles fill", "1", ALONG),
    "flow_profile": Variable("mean velocity in a layer", SPEED, EACH),
    "temperature_profile": Variable("mean square velocity about the mean flow", ENERGY, EACH),
    "T_rot_profile": Variable("temperature of the spins in a layer", ENERGY, ALONG),
    "R_profile": Variable("share of rotation in the energy of a layer", "1", ALONG),
    "share_above": Variable("share of particles above all layers"),
}


class Profiles(Observable):
    """Density, mean flow, temperatures and R in layers."""

    settings = SETTINGS
    variables = VARIABLES

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
