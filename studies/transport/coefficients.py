"""Transport coefficients of gases from observed displacements, memories and fluxes.

Coefficients of diffusion are reduced by the collision frequency:

D* = D_s nu/T_tr (m = 1), nu collisions per particle per time. 1/D* is the share of its velocity
that a particle loses in a collision. A cooling gas counts time in collisions per particle, and then
D* = D_s nu_1^2, nu_1 being nu at T_tr = 1. Viscosity and conductivity are divided by theory at the
measured temperatures. In a gas of N particles that keeps its momentum T_tr is N/(N - 1) times 2
E_trans.
"""

import numpy as np
import xarray as xr

from roughgas import theory
from roughgas.judging import Estimate
from roughgas.tasks.transport import exponential_tail

DIFFUSIVE_LAG = 6.0
"""Collisions per particle after which displacements grow in proportion to time: the slope has an
error of exp(-6) there."""


RESIDUAL_MEMORY = 0.02
"""Largest share of memory at the last time; its integral then misses the same share."""


def per_collision(gas: xr.Dataset) -> tuple[float, float]:
    """Return nu_1, and the collisions per particle in one unit of the observed times."""
    nu = float(theory.collision_frequency(1.0, gas.attrs["packing"], gas.attrs["dimension"]))
    cools = gas.attrs["theory"] == "K"
    return nu, 1.0 if cools else nu * float(2.0 * gas.E_trans) ** 0.5


def by_displacement(gas: xr.Dataset) -> Estimate:
    """Return D* of one point from its mean square displacements at two lags.

    Displacements at both are taken as independent, which makes the error too large if anything.
    """
    nu, unit = per_collision(gas)
    squares = gas.mean_square_displacement.mean("moving")
    errors = np.sqrt((gas.mean_square_displacement_stderr**2).mean("moving") / gas.sizes["moving"])
    lags = gas.lag.values * unit
    first = int(np.searchsorted(lags, DIFFUSIVE_LAG))
    pair = [first, first + 1]
    steps = np.diff(gas.lag.values[pair]).item()
    slope = np.diff(squares.values[pair]).item() / (2.0 * steps)
    stderr = float(np.linalg.norm(errors.values[pair])) / (2.0 * steps)
    scale = nu**2 if gas.attrs["theory"] == "K" else nu / float(2.0 * gas.E_trans) ** 0.5
    dof = float(gas.mean_square_displacement_dof.min())
    return Estimate(slope, stderr, max(dof, 1.0)).scaled(scale)


def by_memory(gas: xr.Dataset, name: str) -> Estimate:
    """Return D* of one point from an autocorrelation (Green and Kubo): of velocities, or of spins.

    Errors at different times are added as fully correlated, which makes the error too large. The
    error is NaN where the memory outlives the observed times.
    """
    _, unit = per_collision(gas)
    memory, errors = gas[name].values, gas[f"{name}_stderr"].values
    times = gas.delay.values * unit
    value = float(np.trapezoid(memory, times)) / memory[0]
    lasts = abs(memory[-1]) > RESIDUAL_MEMORY * memory[0] + 3.0 * errors[-1]
    stderr = np.nan if lasts else float(np.trapezoid(errors, times)) / memory[0]
    return Estimate(value, stderr, max(float(gas[f"{name}_dof"].min()), 1.0))


def expected(gas: xr.Dataset) -> float:
    """Return D* of theory, in first Sonine approximation."""
    parameters = float(gas.r), float(gas.beta), gas.attrs["dimension"], gas.attrs.get("inertia")
    packing = gas.attrs["packing"]
    nu = theory.collision_frequency(1.0, packing, parameters[2])
    return float(theory.self_diffusion(1.0, packing, *parameters) * nu)


def expected_of_spins(gas: xr.Dataset) -> float:
    """Return D* of spins in theory, infinite for spins that never change."""
    dimension, q = gas.attrs["dimension"], gas.attrs["inertia"]
    packing = gas.attrs["packing"]
    nu = theory.collision_frequency(1.0, packing, dimension)
    diffusion = theory.rotational_diffusion(1.0, 1.0, packing, float(gas.beta), dimension, q)
    return float(diffusion * nu * q)


def rough_over_smooth(rough: xr.Dataset, smooth: xr.Dataset) -> tuple[Estimate, float]:
    """Return D* of perfectly rough over smooth elastic particles, and this ratio in theory."""
    rough_diffusion, smooth_diffusion = (by_displacement(point(gas)) for gas in (rough, smooth))
    value = rough_diffusion.value / smooth_diffusion.value
    relative = np.hypot(
        rough_diffusion.stderr / rough_diffusion.value,
        smooth_diffusion.stderr / smooth_diffusion.value,
    )
    ratio = Estimate(value, float(value * relative), min(rough_diffusion.dof, smooth_diffusion.dof))
    return ratio, expected(point(rough)) / expected(point(smooth))


def point(gas: xr.Dataset) -> xr.Dataset:
    """Return the only point of a sweep."""
    return gas.isel(r=0, beta=0)


MEMORY_LENGTHS = {"viscosity": 6.0, "conductivity": 12.0}
"""Collisions per particle up to which stress and heat flux are integrated; in theory memories last
1 to 1.3, and up to 2.6."""
WALL_MARGIN = 0.2
"""Share of the height next to either wall that is left out: four mean free paths."""


def temperature(gas: xr.Dataset) -> xr.DataArray:
    """Return T_tr of a gas that keeps its momentum."""
    particles = gas.attrs["particles"]
    return 2.0 * gas.E_trans * particles / (particles - 1)


def in_equilibrium(gas: xr.Dataset, name: str) -> tuple[np.ndarray, np.ndarray, Estimate]:
    """Return a coefficient of one elastic gas over theory (Green and Kubo): collisions per
    particle, the coefficient from memory up to each of these, and its estimate.

    The estimate includes an exponential tail of the memory, which is also added to its error.
    """
    T, attributes = float(temperature(gas)), gas.attrs
    D, q, packing = attributes["dimension"], attributes.get("inertia"), attributes["packing"]
    if name == "viscosity":
        expected = theory.shear_viscosity(T, T, packing, 1.0, float(gas.beta), D, q)
    else:
        expected = theory.thermal_conductivity(T, D, packing, q)
    passed = gas.delay.values * float(theory.collision_frequency(T, packing, D))
    over_theory, ends = gas[f"{name}_until"] / expected, ("stderr", "dof")
    last = min(int(np.searchsorted(passed, MEMORY_LENGTHS[name])), len(passed) - 1)
    stderr, dof = (float(gas[f"{name}_until_{end}"][last]) for end in ends)
    steps = over_theory.values[[last - 2 * (last // 4), last - last // 4, last]]
    tail = exponential_tail(*steps)
    error = float(np.hypot(stderr / float(expected), tail))
    return passed, over_theory.values, Estimate(float(steps[-1]) + tail, error, dof)


def in_shear(gas: xr.Dataset) -> tuple[Estimate, Estimate, Estimate]:
    """Return the viscosity at one r and beta over theory: at two shear rates, and extrapolated to
    none.

    The change by a shear rate is proportional to its square over the temperature.
    """
    attributes, T = gas.attrs, temperature(gas)
    D, packing = attributes["dimension"], attributes["packing"]
    n = theory.number_density(packing, D)
    parameters = float(gas.r), float(gas.beta), D, attributes["inertia"]
    stress = (gas.stress_kinetic + gas.stress_collisional).sel(component="x", along="y").values
    rate = -n * gas.shear_power.values / stress
    expected = theory.shear_viscosity(T.values, 2.0 * gas.E_rot.values, packing, *parameters)
    unit = n / (rate**2 * expected)
    slow, fast = (
        Estimate(*map(float, power)).scaled(scale)
        for *power, scale in zip(
            gas.shear_power, gas.shear_power_stderr, gas.shear_power_dof, unit, strict=True
        )
    )
    small, large = rate**2 / T.values
    weights = large / (large - small), small / (large - small)
    return slow, fast, slow.scaled(weights[0]).minus(fast.scaled(weights[1]))


def between_walls(gas: xr.Dataset) -> Estimate:
    """Return the conductivity of one gas between thermal walls over theory, q/[int kappa dT/dz].

    Errors of the layers are added as fully correlated, which makes the error too large.
    """
    length = float(gas.height[0] + gas.height[-1])  # of their middles
    across = "xyz"[gas.attrs["dimension"] - 1]
    flux = Estimate(
        *(float(gas[f"heat_flux{end}"].sel(component=across)) for end in ("", "_stderr", "_dof"))
    ).scaled(-length / (length - 2.0))
    middle = abs(gas.height.values / length - 0.5) < 0.5 - WALL_MARGIN
    layers = gas.isel(height=middle)
    T = layers.temperature_profile.mean("component").values
    errors = layers.temperature_profile_stderr.mean("component").values
    kappa = theory.thermal_conductivity(
        T, gas.attrs["dimension"], layers.packing_profile.values, gas.attrs.get("inertia")
    )
    integral = np.concatenate([[0.0], np.cumsum((kappa[1:] + kappa[:-1]) / 2.0 * np.diff(T))])
    height = layers.height.values - layers.height.values.mean()
    weights = height / (height @ height)
    slope, stderr = float(weights @ integral), float(abs(weights) @ (kappa * errors))
    value = flux.value / slope
    relative = np.hypot(flux.stderr / flux.value, stderr / slope)
    return Estimate(value, float(value * relative), flux.dof)
