"""Mean square displacements in a cooling gas, by the first approximation of its memory.

Per collision of a particle, velocities forget at the rate `loss`, and all of them slow down at half
the rate of decay of the temperature, zeta. In units of the present thermal speed the memory is thus
exp(-(loss - zeta/2) n) after n collisions: A. Bodrova & N. Brilliantov, Granular Matter 14, 85
(2012), for a Maxwellian gas.
"""

import numpy as np
import xarray as xr

from roughgas import theory
from roughgas.judging import theory_over_grid


def mean_square_displacement(gas: xr.Dataset) -> xr.DataArray:
    """Return <(x - x0)^2> in a^2 over lags, in collisions per particle, and components."""
    packing, kind = gas.attrs["packing"], (gas.attrs["dimension"], gas.attrs["inertia"])
    frequency = theory.collision_frequency(1.0, packing, kind[0])
    lag, components = gas.lag.values, gas.sizes["moving"]

    def displacement(point):
        """Return the displacements (lags, components) at a point."""
        r, beta = point["r"], point["beta"]
        loss = 1.0 / (frequency * theory.self_diffusion(1.0, packing, r, beta, *kind))
        memory = loss - theory.decay_rate(r, beta, *kind) / 2.0
        square = 2.0 / (frequency**2 * memory) * (lag + np.expm1(-memory * lag) / memory)
        return np.tile(square[:, np.newaxis], components)

    return theory_over_grid(gas, displacement, ("lag", "moving"))
