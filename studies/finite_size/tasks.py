"""A cooling gas of given numbers of particles: without positions, and by events in several
boxes."""

import math
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
import xarray as xr

from roughgas import theory
from roughgas.gas import CollapseError, Gas, ratio
from roughgas.tasks import seed_sequence, timed
from roughgas.tasks.free_cooling import FreeCooling, dsmc_means, thermalised_gas

RUN_PARTS = 16  # of a run; the first half of them is transient
REFRESH_INTERVAL = 4  # collisions per particle; the length of a part is a multiple of it
E_FOLDS = 4.0  # of the transient: R starts a few per cent off
SHORTEST_WAIT = 30.0  # collisions per particle
FEWEST_RUNS = 4
DSMC_PRECISION = 1 / 3  # error of DSMC over the error by events: it costs little
PART_VARIABLES = ("R", "R_now", "a02", "flow")


def tasks(settings: Mapping[str, Any]) -> list[str]:
    """Return the names of all tasks, one per point and number of particles, the longest first."""
    names = point_names(settings)
    return [f"{name}-n{n}" for n in sorted(settings["particles"], reverse=True) for name in names]


def point_names(settings: Mapping[str, Any]) -> dict[str, tuple[str, str, str]]:
    """Return experiment, r and beta of the points by their names.

    The random numbers of a gas depend on its position in this list and in the list of numbers of
    particles.
    """
    points = [(name, *pair) for name, pairs in settings["points"].items() for pair in pairs]
    return {f"{name}_r{r}_beta{beta}": (name, r, beta) for name, r, beta in points}


def run(task: str, settings, experiments, progress: Callable[[int, int], None]) -> xr.Dataset:
    """Return the dataset of one task, for results.combine."""
    names, (point, _, label) = point_names(settings), task.rpartition("-n")
    experiment, r, beta = names[point]
    cooling = FreeCooling(experiments[experiment], float(r), float(beta))
    number, packings, precision = int(label), settings["packings"], settings["precision"]
    row = list(names).index(point), settings["particles"].index(number)
    dsmc_means(cooling, 10, 1.0, seed_sequence(settings, 0))
    dsmc = dsmc_means(cooling, number, DSMC_PRECISION * precision, seed_sequence(settings, 1, *row))
    dsmc_names = ("R", "R_stderr", "a02", "a02_stderr", "seconds")
    values: dict[str, Any] = {f"dsmc_{name}": dsmc[name] for name in dsmc_names}
    length, runs = part_length(cooling), _number_of_runs(cooling, number, precision)
    part_values, seconds = [], []
    for k, packing in enumerate(packings):
        gas, seeds = (
            gas_in_box(cooling, number, packing),
            seed_sequence(settings, 2 + k, *row).spawn(runs),
        )
        run_by_events(gas, REFRESH_INTERVAL, 1, seed_sequence(settings, 0))
        gas_values, passed = timed(
            lambda g, s: [run_by_events(g, length, RUN_PARTS, seed) for seed in s], gas, seeds
        )
        part_values.append(gas_values)
        seconds.append(passed)
        progress(k + 1, len(packings))
    columns = np.moveaxis(np.array(part_values), -1, 0)
    values |= {
        n: (("packing", "run", "part"), x) for n, x in zip(PART_VARIABLES, columns, strict=True)
    }
    values |= {"length": RUN_PARTS * length, "seconds": ("packing", seconds)}
    values |= {"theory": float(theory.cooling_ratio(*cooling.constants))}
    return xr.Dataset(values, attrs={"dimension": cooling.constants[2]})


def gas_in_box(cooling: FreeCooling, number: int, packing: float) -> FreeCooling:
    """Return the gas with `number` particles, in a box that they fill to `packing`."""
    experiment = cooling.experiment.changed({"particles": number})
    return cooling._replace(experiment=experiment).at_packing(packing)


def part_length(cooling: FreeCooling) -> int:
    """Return the length of a part of a run, in collisions per particle: see E_FOLDS."""
    transient = max(SHORTEST_WAIT, E_FOLDS / cooling.rate)
    return REFRESH_INTERVAL * math.ceil(transient / (RUN_PARTS // 2 * REFRESH_INTERVAL))


def _number_of_runs(cooling, number, precision):
    """Return the number of runs for a relative error `precision` of R; fluctuations live for
    1/rate."""
    independent = max(1.0, RUN_PARTS // 2 * part_length(cooling) * cooling.rate / 2.0)
    variance = cooling.relative_variance(number)
    return max(FEWEST_RUNS, math.ceil(variance / precision**2 / independent))


def run_by_events(
    cooling: FreeCooling, length: int, number_of_parts: int, seed: np.random.SeedSequence
) -> np.ndarray:
    """Return (mean of R, and the last R, a02 and flow) of each part of a run, shape
    (number_of_parts, 4); columns are PART_VARIABLES.

    A part is `length` collisions per particle, a multiple of REFRESH_INTERVAL. After a collapse,
    which clusters may suffer without the contact-time model, rows are NaN.
    """
    gas, rows = (
        thermalised_gas(cooling, seed),
        np.full((number_of_parts, len(PART_VARIABLES)), math.nan),
    )
    for row in rows:
        try:
            R = ratio(gas.energies(gas.in_collisions(gas.count(1.0), length)))
        except CollapseError:
            break
        row[:] = R.mean(), R[-1], *cumulant_and_flow(gas)
    return rows


def cumulant_and_flow(gas: Gas) -> tuple[float, float]:
    """Return the cumulant a02 of the spins (see dsmc.Samples), and the share of E_trans in the
    longest shear waves: sines and cosines along each side of the box, transverse to their
    direction.

    Without correlations these are 2 (D - 1) of the D N degrees of freedom.
    """
    position, velocity = gas.positions_and_velocities()
    (number, dimension), box = position.shape, np.array(gas.scene.box)
    waves = np.exp(2j * np.pi * position / box).T @ velocity  # (direction, component)
    across = np.abs(waves[~np.eye(dimension, dtype=bool)]) ** 2
    spin = gas.spins()
    ww, spins = np.sum(spin**2, axis=1), spin.shape[1]
    a02 = spins * np.mean(ww**2) / ((spins + 2) * np.mean(ww) ** 2) - 1.0
    return float(a02), float(2.0 * np.sum(across) / (number * np.sum(velocity**2)))
