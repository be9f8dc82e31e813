"""Coefficients of gases without positions: elastic ones in equilibrium and under small forces, and
the self-diffusion of driven disks."""

from collections.abc import Callable, Mapping
from typing import Any, NamedTuple

import numpy as np
import xarray as xr

from roughgas.tasks import seed_sequence, timed
from roughgas.tasks.transport import (
    GasProperties,
    correlations,
    driven_diffusion,
    forced_coefficients,
)

DIMENSIONS = {"disks": 2, "spheres": 3}
DELAYS = 33
"""Delays of autocorrelations; their distance is `interval` of the settings."""
MEMORY_WINDOW = 6.4
"""Collisions per particle over which velocities of driven disks are remembered."""


class Gas(NamedTuple):
    """A gas of `kind` disks or spheres, simulated by a `method`."""

    method: str  # equilibrium, forced or driven
    kind: str
    r: float
    beta: float
    inertia: float  # q; of smooth particles without effect
    particles: int
    force: float = 0.0  # shear rate of a forced gas, in collisions per particle

    @property
    def name(self) -> str:
        """Name of the task."""
        material = f"r{self.r:g}-beta{self.beta:g}-q{self.inertia:g}"
        force = f"-force{self.force:g}" if self.force else ""
        return f"{self.method}-{self.kind}-{material}-n{self.particles}{force}"

    @property
    def properties(self) -> GasProperties:
        """Properties of its particles."""
        return GasProperties(self.r, self.beta, DIMENSIONS[self.kind], self.inertia)


def gases_of(settings: Mapping[str, Any]) -> dict[str, Gas]:
    """Return all gases by the names of their tasks, the longest first.

    The random numbers of a gas depend on its position in this list.
    """
    gases = []
    for kind in DIMENSIONS:
        elastic = [(kind, 1.0, 1.0 if q else -1.0, q or 0.4) for q in settings[kind]]
        for number in settings["equilibrium"]["particles"]:
            gases += [Gas("equilibrium", *gas, number) for gas in elastic]
        forced = [gas for gas in elastic if gas[2] == -1.0 or gas[3] in settings["forced"]["q"]]
        for force in settings["forced"]["forces"]:
            number = settings["forced"]["particles"]
            gases += [Gas("forced", *gas, number, force) for gas in forced]
    driven = settings["driven"]
    gases += [
        Gas("driven", "disks", float(r), float(beta), 0.5, driven["particles"])
        for r in driven["r"]
        for beta in driven["beta"]
    ]
    gases.sort(key=lambda gas: gas.particles * (gas.method == "equilibrium"), reverse=True)
    return {gas.name: gas for gas in gases}


def tasks(settings: Mapping[str, Any]) -> list[str]:
    """Return the names of all tasks, the longest first."""
    return list(gases_of(settings))


def run(task: str, settings, experiments, progress: Callable[[int, int], None]) -> xr.Dataset:
    """Return the dataset of one task, for results.combine: autocorrelations of a gas in
    equilibrium, else coefficients over their first Sonine approximation."""
    gases = gases_of(settings)
    gas, seed = gases[task], seed_sequence(settings, list(gases).index(task))
    function = {"equilibrium": _equilibrium, "forced": _forced, "driven": _driven}[gas.method]
    values, seconds = timed(function, gas, settings[gas.method], seed)
    progress(1, 1)
    dims = ("block", "delay") if gas.method == "equilibrium" else ("field",)
    return xr.Dataset({name: (dims, np.array(x)) for name, x in values.items()}).assign(
        seconds=seconds
    )


def steps_of(gas: Gas, settings: Mapping[str, Any]) -> tuple[int, float]:
    """Return the collisions between two observations of a gas in equilibrium, of all particles and
    of each. `settings` are of the method."""
    collisions = max(1, round(settings["interval"] * gas.particles / 2))
    return collisions, 2.0 * collisions / gas.particles


def _equilibrium(gas, settings, seed):
    """Return autocorrelations of stress and heat flux, (blocks, delays), by coefficient."""
    collisions, interval = steps_of(gas, settings)
    block = round(settings["length"] / settings["blocks"] / interval), collisions, DELAYS
    return correlations(gas.properties, gas.particles, block, settings["blocks"], seed)


def _forced(gas, settings, seed):
    """Return viscosity and conductivity in a steady state under small forces, by name."""
    return forced_coefficients(gas.properties, gas.particles, gas.force, settings["length"], seed)


def _driven(gas, settings, seed):
    """Return the coefficient of self-diffusion, by name."""
    windows = settings["windows"]
    diffusion = driven_diffusion(gas.properties, gas.particles, MEMORY_WINDOW, windows, seed)
    return {"diffusion": diffusion}
