"""Autocorrelation of velocities, spins, stress and heat flux.

    C_v(t) = <V(t0) . V(t0 + t)>/D,    C_w(t) = <w(t0) . w(t0 + t)>/(2 D - 3),

over all particles and all observations t0. The coefficient of self-diffusion is the integral of C_v
over time, the rotational diffusion coefficient the integral of C_w/a^2: M. S. Green, J. Chem. Phys.
22, 398 (1954); R. Kubo, J. Phys. Soc. Jpn. 12, 570 (1957). In a cooling gas E_trans is 1 at either
time, the unit of velocities, and time is counted in collisions per particle.

In a gas in equilibrium viscosity and conductivity are such integrals, too,

    viscosity = (V/T) int <P_xy(0) P_xy(t)> dt,    conductivity = (V/T^2) int <q_x(0) q_x(t)> dt.

Here P_xy stands for the full traceless symmetric pressure tensor, <P : P>/[(D - 1) (D + 2)], and
q_x for the heat flux, <q.q>/D. Both are means over the interval between two observations: the
kinetic contributions, sum m v v and sum (m v^2 + m q a^2 w^2) v/2, over V, averaged over its ends,
and the transport by all contacts in the interval (effects/contacts.py). With such means the
integral up to t by the trapezium rule is half of the slope of the mean square of int P_xy dt (E.
Helfand, Phys. Rev. 119, 1 (1960)). Observations must be dense: an interval h, with a memory tau,
overestimates by (h/tau)^2/12. T is computed with N - 1 particles, since momentum is conserved, and
both integrals get the factor N/(N - 1). For mixtures only the viscosity is computed: their heat
flux has a contribution of diffusion.

All results depend on the box, which limits the wavelengths of flows; in two dimensions they grow
without bound, as the logarithm of its width: B. J. Alder & T. E. Wainwright, Phys. Rev. A 1, 18
(1970).

Arrays (k, ...) are of the k instants of a FrameSeries.
"""

from collections import deque
from collections.abc import Mapping
from typing import Annotated

import numpy as np

from roughgas.base import InputError
from roughgas.base.fields import whole
from roughgas.data.variables import SPIN, TIME, Variable
from roughgas.effects.contacts import HEAT, STRESSES
from roughgas.observables.averages import NamedArrays
from roughgas.observables.fields import energy_flux, momentum_flux
from roughgas.observables.frames import FrameSeries, System
from roughgas.observables.plugin import IN_THIS_BOX, Observable, ObservableSettings, columnwise

SQUARED_VELOCITY = "a^2 T^-2"
VELOCITY_NAME, SPIN_NAME = "velocity_autocorrelation", "spin_autocorrelation"


STRESS_NAME, HEAT_FLUX_NAME = "stress_autocorrelation", "heat_flux_autocorrelation"
VISCOSITY, CONDUCTIVITY = "viscosity_until", "conductivity_until"
DELAY_DIMS = ("delay",)
CACHED_PRODUCTS = 2**15
"""Products that are computed at once: 256 kB."""
DELAY = Variable("time from one observation to another", TIME, DELAY_DIMS)


class DelaySettings(ObservableSettings, frozen=True, kw_only=True):
    """Settings of `autocorrelation` and of `flux_autocorrelation`."""

    delays: Annotated[int, whole(2, 10_000, "Number of times, the first one 0.")] = 50


class Autocorrelation(Observable):
    """Autocorrelation of velocities and of spins, after 0, 1, 2, ... observations."""

    single_species = True

    settings = DelaySettings
    relaxations, depends_on_flow = 96.0, True
    variables: Mapping[str, Variable] = {
        "delay": DELAY,
        VELOCITY_NAME: Variable(
            f"autocorrelation of a velocity component{IN_THIS_BOX}", SQUARED_VELOCITY, DELAY_DIMS
        ),
        SPIN_NAME: Variable(
            "autocorrelation of a spin component", SQUARED_VELOCITY, DELAY_DIMS, when=(SPIN,)
        ),
    }

    def __init__(self, system: System, delays: int) -> None:
        """Keep velocities and spins of earlier observations; `delays` is their number."""
        super().__init__(system)
        self._delays, self._observations = delays, 0
        self._recent: tuple[np.ndarray, ...] = ()
        self.coordinates = {"delay": np.arange(delays) * system.interval}

    def observe_series(self, frames: FrameSeries) -> NamedArrays:
        """Return mean products with earlier observations, of velocities and of spins, (k, delays).

        They are in a^2/T^2, per component. NaN for delays that exceed the number of earlier
        observations.
        """
        present = frames.thermal_velocity, frames.thermal_spin
        if not self._recent:
            self._recent = tuple(np.zeros((self._delays, *x.shape[1:])) for x in present)
        products = [
            _mean_products(recent, values, self._observations)
            for recent, values in zip(self._recent, present, strict=True)
        ]
        self._observations += frames.instants
        return {VELOCITY_NAME: products[0], SPIN_NAME: products[1]}

    @columnwise
    def combine(self, means: NamedArrays) -> NamedArrays:
        """Return the mean autocorrelation of velocities, and of spins if particles spin."""
        if self.system.inertia is not None:
            return means
        return {VELOCITY_NAME: means[VELOCITY_NAME]}


def _mean_products(recent, series, observations):
    """Return mean products (k, delays) of vectors with the vectors of preceding observations.

    `recent` is a ring of the vectors at the latest observations, (delays, N, ...): observation n is
    row n modulo delays, so that no vector moves while it is needed. `series`, (k, N, ...), replaces
    its oldest rows after a number of earlier `observations`. NaN for delays beyond the first one.
    """
    delays, numbers = len(recent), np.arange(len(recent))
    ring, series = recent.reshape(delays, -1), series.reshape(len(series), -1)
    sums = np.full((len(series), delays), np.nan)
    rows = enumerate(zip(series, sums, strict=True), start=observations)
    for number, (vectors, sums_by_delay) in rows:
        row, known = number % delays, min(number + 1, delays)
        ring[row] = vectors
        sums_by_delay[:known] = _products(ring[:known], vectors)[row - numbers[:known]]
    return sums / ring.shape[1]


def _products(rows, vectors):
    """Return the sum of products of each of `rows`, (rows, n), with `vectors`, (n,).

    Products of a few rows at a time stay in the processor's cache.
    """
    products, step = np.empty(len(rows)), max(1, CACHED_PRODUCTS // len(vectors))
    for first in range(0, len(rows), step):
        block = slice(first, first + step)
        np.add.reduce(rows[block] * vectors, axis=1, out=products[block])
    return products


class FluxAutocorrelation(Observable):
    """Autocorrelation of stress and heat flux, and the coefficients that are its integrals."""

    effects = ("contact_stress", "contact_heat")
    settings = DelaySettings
    relaxations = 96.0
    variables: Mapping[str, Variable] = {
        "delay": DELAY,
        STRESS_NAME: Variable(
            "V <P_xy(0) P_xy(t)> of the pressure tensor", "m^2 a^(4-D) T^-4", DELAY_DIMS
        ),
        HEAT_FLUX_NAME: Variable(
            "V <q_x(0) q_x(t)> of the heat flux", "m^2 a^(6-D) T^-6", DELAY_DIMS
        ),
        VISCOSITY: Variable(
            f"shear viscosity, of memory up to this delay{IN_THIS_BOX}",
            "m a^(2-D) T^-1",
            DELAY_DIMS,
        ),
        CONDUCTIVITY: Variable(
            f"conductivity, of memory up to this delay{IN_THIS_BOX}", "a^(2-D) T^-1", DELAY_DIMS
        ),
    }

    def __init__(self, system: System, delays: int) -> None:
        """Keep the fluxes of earlier observations; `delays` is their number.

        Raises InputError for a gas that cools, is sheared, or is not in a periodic box.
        """
        super().__init__(system)
        if system.cooling or system.shear_rate or not all(system.periodic):
            legal = "be of a gas at rest in a periodic box that does not cool"
            raise InputError("observables", "flux_autocorrelation", legal)
        self._kinetic: tuple[np.ndarray, np.ndarray] | None = None
        self._path: tuple[deque[np.ndarray], ...] = deque(maxlen=delays), deque(maxlen=delays)
        self.coordinates = {"delay": np.arange(delays) * system.interval}

    def observe_series(self, frames: FrameSeries) -> NamedArrays:
        """Return mean products with earlier fluxes, (k, delays), and the temperature, (k,).

        The fluxes are stress and heat flux. NaN for delays that exceed the number of earlier
        observations.
        """
        system, D = self.system, self.system.dimension
        kinetic = momentum_flux(frames), energy_flux(frames)  # of a gas without mean flow
        rates = [frames.pair_rates(names).sum(axis=(1, 2)) for names in (STRESSES, HEAT)]
        contacts = rates[0].reshape(-1, 3, 3)[:, :D, :D], rates[1][:, :D]
        products = np.full((2, frames.instants, self._path[0].maxlen or 0), np.nan)
        for instant, (stress, heat, *collisional) in enumerate(
            zip(*kinetic, *contacts, strict=True)
        ):
            before, self._kinetic = self._kinetic, (stress, heat)
            if before is not None:
                fluxes = self._mean_fluxes(before, self._kinetic, collisional)
                products[:, instant] = self._products(fluxes)
        temperature = np.trace(kinetic[0], axis1=1, axis2=2) / (D * (system.particles - 1))
        return {STRESS_NAME: products[0], HEAT_FLUX_NAME: products[1], "temperature": temperature}

    def _mean_fluxes(self, before, present, collisional):
        """Return means since the previous observation of traceless stress and heat flux, times V.

        `before` and `present` are kinetic stress and heat flux at both ends, `collisional` the
        transport by contacts per T, all times V. The stress is flattened, (D^2,); the heat flux is
        (D,).
        """
        D = self.system.dimension
        stress, heat = (
            (initial + final) / 2.0 + collisional_flux
            for initial, final, collisional_flux in zip(before, present, collisional, strict=True)
        )
        stress = (stress + stress.T) / 2.0 - np.eye(D) * np.trace(stress) / D
        return stress.ravel(), heat

    def _products(self, fluxes):
        """Return mean products (2, delays) with present and earlier `fluxes`; NaN beyond these.

        `fluxes` are the stress and the heat flux of `_mean_fluxes`; the rows are in this order.
        """
        D, volume = self.system.dimension, self.system.volume
        products = np.full((2, self._path[0].maxlen or 0), np.nan)
        component_counts = (D - 1) * (D + 2), D
        for row, path, flux, component_count in zip(
            products, self._path, fluxes, component_counts, strict=True
        ):
            path.appendleft(flux)
            row[: len(path)] = np.array(path) @ flux / (component_count * volume)
        return products

    def combine(self, means: NamedArrays) -> NamedArrays:
        """Return autocorrelations and their integrals over time; for a mixture of the stress only.

        The integrals are the viscosity and the conductivity, (delays,).
        """
        momentum_factor = (self.system.particles - 1) / self.system.particles
        T, step = means["temperature"], self.system.interval
        units = {STRESS_NAME: (VISCOSITY, T)}
        if not self.system.species:
            units[HEAT_FLUX_NAME] = CONDUCTIVITY, T**2
        correlations = {name: means[name] / momentum_factor for name in units}
        integrals = {
            integral: _integral(correlations[name]) * step / unit
            for name, (integral, unit) in units.items()
        }
        return correlations | integrals


def _integral(values):
    """Return integrals of `values` from the first to each, by the trapezium rule, per step."""
    return np.concatenate([[0.0], np.cumsum((values[1:] + values[:-1]) / 2.0)])
