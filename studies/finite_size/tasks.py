"""A cooling gas of so many particles: without positions, and by events in several boxes."""

import math
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
import xarray as xr

from roughgas import theory
from roughgas.gas import CollapseError, Gas, ratio
from roughgas.tasks import stream, timed
from roughgas.tasks.free_cooling import FreeCooling, homogeneous, thermalised

PARTS = 16  # of a run; the first half of them is waited for
REFRESHED = 4  # collisions per particle: a part has a multiple of so many
E_FOLDS, LEAST = 4.0, 30.0  # waited for: R starts a few per cent off; and collisions per particle
FEWEST = 4  # runs
SHARPER = 1 / 3  # error without positions, over that by events: it costs little
SEEN = ("R", "R_now", "a02", "flow")


def tasks(settings: Mapping[str, Any]) -> list[str]:
    """Return the names of all tasks, a point and a number of particles each, the longest first."""
    names = point_names(settings)
    return [f"{name}-n{n}" for n in sorted(settings["particles"], reverse=True) for name in names]


def point_names(settings: Mapping[str, Any]) -> dict[str, tuple[str, str, str]]:
    """Return experiment, r and beta of the points by their names.

    The random numbers of a gas are of its place in this list, and in that of numbers of particles.
    """
    places = [(name, *one) for name, points in settings["points"].items() for one in points]
    return {f"{name}_r{r}_beta{beta}": (name, r, beta) for name, r, beta in places}


def run(task: str, settings, experiments, progress: Callable[[int, int], None]) -> xr.Dataset:
    """Return what one task finds, as results.combine takes it."""
    names, (point, _, label) = point_names(settings), task.rpartition("-n")
    experiment, r, beta = names[point]
    cooling = FreeCooling(experiments[experiment], float(r), float(beta))
    number, packings, precision = int(label), settings["packings"], settings["precision"]
    row = list(names).index(point), settings["particles"].index(number)
    homogeneous(cooling, 10, 1.0, stream(settings, 0))
    without = homogeneous(cooling, number, SHARPER * precision, stream(settings, 1, *row))
    kept = ("R", "R_stderr", "a02", "a02_stderr", "seconds")
    found: dict[str, Any] = {f"dsmc_{name}": without[name] for name in kept}
    length, runs = part_length(cooling), _runs(cooling, number, precision)
    seen, seconds = [], []
    for k, packing in enumerate(packings):
        gas, seeds = at_density(cooling, number, packing), stream(settings, 2 + k, *row).spawn(runs)
        follow(gas, REFRESHED, 1, stream(settings, 0))
        every, passed = timed(lambda g, s: [follow(g, length, PARTS, one) for one in s], gas, seeds)
        seen.append(every)
        seconds.append(passed)
        progress(k + 1, len(packings))
    columns = np.moveaxis(np.array(seen), -1, 0)
    found |= {n: (("packing", "run", "part"), x) for n, x in zip(SEEN, columns, strict=True)}
    found |= {"length": PARTS * length, "seconds": ("packing", seconds)}
    found |= {"theory": float(theory.cooling_ratio(*cooling.constants))}
    return xr.Dataset(found, attrs={"dimension": cooling.constants[2]})


def at_density(cooling: FreeCooling, number: int, packing: float) -> FreeCooling:
    """Return the gas with so many particles, in a box that they fill to `packing`."""
    changed = dict(cooling.experiment) | {"particles": number}
    return cooling._replace(experiment=changed).at_packing(packing)


def part_length(cooling: FreeCooling) -> int:
    """Return the length of a part of a run, in collisions per particle: see E_FOLDS."""
    waited = max(LEAST, E_FOLDS / cooling.rate)
    return REFRESHED * math.ceil(waited / (PARTS // 2 * REFRESHED))


def _runs(cooling, number, precision):
    """Return how many runs a relative error `precision` of R needs: fluctuations live 1/rate."""
    independent = max(1.0, PARTS // 2 * part_length(cooling) * cooling.rate / 2.0)
    variance = cooling.relative_variance(number)
    return max(FEWEST, math.ceil(variance / precision**2 / independent))


def follow(
    cooling: FreeCooling, length: int, parts: int, seed: np.random.SeedSequence
) -> np.ndarray:
    """Return (mean of R, and R, a02 and flow as it ends) of each part of a run: (parts, SEEN).

    A part is `length` collisions per particle, a multiple of REFRESHED. NaN from where on the gas
    collapses, as a cluster may that has no contact-time model.
    """
    gas, rows = thermalised(cooling, seed), np.full((parts, len(SEEN)), math.nan)
    for row in rows:
        try:
            R = ratio(gas.energies(gas.in_collisions(gas.count(1.0), length)))
        except CollapseError:
            break
        row[:] = R.mean(), R[-1], *look(gas)
    return rows


def look(gas: Gas) -> tuple[float, float]:
    """Return the cumulant a02 of the spins (see dsmc.Samples), and the share of E_trans that the
    longest shear waves hold: sines and cosines along each side of the box, across their direction.

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
