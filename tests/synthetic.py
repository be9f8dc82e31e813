"""Reduced datasets as simulations would give them, but with R known beforehand."""

from collections.abc import Callable

import numpy as np
import xarray as xr

from roughgas.reduce import predicted_ratio

GRID = ("r", "beta")
BETA = (-0.95, *(round(-0.9 + 0.1 * step, 1) for step in range(20)))


def reduced(
    experiment: str = "vibrated",
    shift: Callable[[np.ndarray, np.ndarray], np.ndarray] = lambda r, beta: 0 * r * beta,
    r: tuple[float, ...] = (0.8, 0.9, 0.99),
    beta: tuple[float, ...] = BETA,
    error: float = 0.001,
    seeds: int = 4,
    **others: float | np.ndarray,
) -> xr.Dataset:
    """R = theory + shift(r, beta) + noise of standard error `error`; `others` set more of it."""
    attributes = {
        "experiment": experiment,
        "scale": "small",
        "dimension": 2,
        "inertia": 0.5,
        "particles": 160,
        "theory": "K" if experiment == "cooling" else "lun",
    }
    r_grid, beta_grid = np.meshgrid(r, beta, indexing="ij")
    exact = predicted_ratio(attributes, r_grid, beta_grid) + shift(r_grid, beta_grid)
    rng = np.random.default_rng(len(experiment))
    noise = rng.normal(0, error * np.sqrt(seeds), (*exact.shape, seeds))
    ratio = exact[..., None] + noise
    spread = ratio.std(-1, ddof=1) / np.sqrt(seeds) if seeds > 1 else np.full(exact.shape, error)
    values = {
        "R": ratio.mean(-1),
        "R_stderr": spread,
        "R_stderr_over_seeds": spread,
        "R_dof": seeds - 1.0,
        "R_stderr_within": error,
        "n_seeds": seeds,
        "equilibrated": 1.0,
        "measured_for": 2000.0,
        "collisions": 1000000,
        "contact_time_fraction": 0.0,
        "R_drift": noise[..., 0] / 10,
        "R_drift_stderr": error,
    } | others
    variables = {name: (GRID, np.full(exact.shape, value)) for name, value in values.items()}
    variables["R_seed"] = ((*GRID, "seed"), ratio)
    coordinates = {"r": list(r), "beta": list(beta), "seed": np.arange(1, seeds + 1)}
    return xr.Dataset(variables, coordinates, attributes)
