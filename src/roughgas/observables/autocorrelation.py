"""How long velocities and spins are remembered, and stress and heat flux.

    C_v(t) = <V(t0) . V(t0 + t)>/D,    C_w(t) = <w(t0) . w(t0 + t)>/(2 D - 3),

over all particles and all looks t0. The coefficient of self-diffusion is the integral of C_v over
time, that of the angle the integral of C_w/a^2: M. S. Green, J. Chem. Phys. 22, 398 (1954); R.
Kubo, J. Phys. Soc. Jpn. 12, 570 (1957). In a cooling gas velocities are in units of the present
E_trans at either time, which is 1, and time counts in collisions per particle.

In a gas in equilibrium viscosity and conductivity are such integrals, too,

    viscosity = (V/T) int <P_xy(0) P_xy(t)> dt,    conductivity = (V/T^2) int <q_x(0) q_x(t)> dt.

Here P_xy stands for all of the traceless symmetric part of the pressure tensor, <P : P>/[(D - 1)
(D + 2)], and q_x for the heat flux, <q.q>/D. Both are means over the time from one look to the
next: the kinetic parts, sum m v v and sum (m v^2 + m q a^2 w^2) v/2, over V, of its ends, and what
all contacts in between have carried (effects/contacts.py). Of such means the integral up to t by
the trapezium rule is half of the slope of the mean square of int P_xy dt (E. Helfand, Phys. Rev.
119, 1 (1960)). Looks must be dense: h apart, with a memory of tau, they give (h/tau)^2/12 too much.
T is that of N - 1 particles, since momentum is conserved, and both get the factor N/(N - 1). Of a
mixture there is the viscosity only: its heat flux has a part that diffusion carries.

All of these depend on the box, since what is longer than it is not there; in two dimensions without
end, as the logarithm of its width: B. J. Alder & T. E. Wainwright, Phys. Rev. A 1, 18 (1970).
"""

from collections import deque
from collections.abc import Mapping
from typing import ClassVar

import numpy as np

from roughgas.base import InputError
from roughgas.data.variables import SPIN, TIME, Variable
from roughgas.effects.contacts import HEAT, STRESSES
from roughgas.observables.plugin import (
    IN_THIS_BOX,
    Frame,
    Observable,
    Setting,
    System,
    Values,
    Whole,
)

SQUARED = "a^2 T^-2"
VELOCITY, OF_SPIN = "velocity_autocorrelation", "spin_autocorrelation"


STRESS, HEAT_FLUX = "stress_autocorrelation", "heat_flux_autocorrelation"
VISCOSITY, CONDUCTIVITY = "viscosity_until", "conductivity_until"
ALONG = ("delay",)
DELAY = Variable("time from one observation to another", TIME, ALONG)
DELAYS = {"delays": Whole("Number of times, the first one 0.", 2, 10_000, 50)}


class Autocorrelation(Observable):
    """Autocorrelation of velocities and of spins, after 0, 1, 2, ... observations."""

    alike = True

    settings: ClassVar[Mapping[str, Setting]] = DELAYS
    relaxations, of_flow = 96.0, True
    variables: Mapping[str, Variable] = {
        "delay": DELAY,
        VELOCITY: Variable(f"autocorrelation of a velocity component{IN_THIS_BOX}", SQUARED, ALONG),
        OF_SPIN: Variable("autocorrelation of a spin component", SQUARED, ALONG, when=(SPIN,)),
    }

    def __init__(self, system: System, delays: int) -> None:
        super().__init__(system)
        self._path: deque[tuple[np.ndarray, np.ndarray]] = deque(maxlen=delays)
        self.coordinates = {"delay": np.arange(delays) * system.interval}

    def look(self, frame: Frame) -> Values:
        """Return both since earlier looks, NaN where there was none."""
        self._path.appendleft((frame.thermal_velocity.copy(), frame.thermal_spin.copy()))
        found = np.full((2, self._path.maxlen or 0), np.nan)
        for k, before in enumerate(self._path):
            for row, then, now in zip(found, before, self._path[0], strict=True):
                row[k] = np.mean(then * now)
        return {VELOCITY: found[0], OF_SPIN: found[1]}

    def combine(self, means: Values) -> Values:
        """Return both; that of spins where there are any."""
        if self.system.inertia is not None:
            return means
        return {VELOCITY: means[VELOCITY]}


class FluxAutocorrelation(Observable):
    """Autocorrelation of stress and heat flux, and the coefficients that are its integrals."""

    effects = ("contact_stress", "contact_heat")
    settings: ClassVar[Mapping[str, Setting]] = DELAYS
    relaxations = 96.0
    variables: Mapping[str, Variable] = {
        "delay": DELAY,
        STRESS: Variable("V <P_xy(0) P_xy(t)> of the pressure tensor", "m^2 a^(4-D) T^-4", ALONG),
        HEAT_FLUX: Variable("V <q_x(0) q_x(t)> of the heat flux", "m^2 a^(6-D) T^-6", ALONG),
        VISCOSITY: Variable(
            f"shear viscosity, of memory up to this delay{IN_THIS_BOX}", "m a^(2-D) T^-1", ALONG
        ),
        CONDUCTIVITY: Variable(
            f"conductivity, of memory up to this delay{IN_THIS_BOX}", "a^(2-D) T^-1", ALONG
        ),
    }

    def __init__(self, system: System, delays: int) -> None:
        super().__init__(system)
        if system.cooling or system.shear_rate or not all(system.periodic):
            legal = "be of a gas at rest in a periodic box that does not cool"
            raise InputError("observables", "flux_autocorrelation", legal)
        self._kinetic: tuple[np.ndarray, np.ndarray] | None = None
        self._path: tuple[deque[np.ndarray], ...] = deque(maxlen=delays), deque(maxlen=delays)
        self.coordinates = {"delay": np.arange(delays) * system.interval}

    def look(self, frame: Frame) -> Values:
        """Return both since earlier looks, NaN where there was none, and the temperature."""
        system, V = self.system, frame.velocity
        D, volume, before = system.dimension, system.volume, self._kinetic
        self._kinetic = V.T @ (frame.mass[:, None] * V), frame.energy @ V
        temperature = np.trace(self._kinetic[0]) / (D * (system.particles - 1))
        found = np.full((2, self._path[0].maxlen or 0), np.nan)
        if before is not None:
            rates = [frame.of_pairs(names).sum(axis=(0, 1)) for names in (STRESSES, HEAT)]
            contacts = rates[0].reshape(3, 3)[:D, :D], rates[1][:D]
            stress, heat = (
                (one + other) / 2.0 + carried
                for one, other, carried in zip(before, self._kinetic, contacts, strict=True)
            )
            stress = (stress + stress.T) / 2.0 - np.eye(D) * np.trace(stress) / D
            numbers = (D - 1) * (D + 2), D
            for row, path, flux, number in zip(
                found, self._path, (stress.ravel(), heat), numbers, strict=True
            ):
                path.appendleft(flux)
                row[: len(path)] = np.array(path) @ flux / (number * volume)
        return {STRESS: found[0], HEAT_FLUX: found[1], "temperature": np.array(temperature)}

    def combine(self, means: Values) -> Values:
        """Return both, and their integrals; of a mixture those of the stress."""
        free = (self.system.particles - 1) / self.system.particles
        T, step = means["temperature"], self.system.interval
        units = {STRESS: (VISCOSITY, T)}
        if not self.system.species:
            units[HEAT_FLUX] = CONDUCTIVITY, T**2
        found = {name: means[name] / free for name in units}
        until = {
            integral: _integral(found[n]) * step / unit for n, (integral, unit) in units.items()
        }
        return found | until


def _integral(values):
    """Return the integral from the first value to each, by the trapezium rule, in steps."""
    return np.concatenate([[0.0], np.cumsum((values[1:] + values[:-1]) / 2.0)])
