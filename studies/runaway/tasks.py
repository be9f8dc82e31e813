"""A cooling gas with friction until spin has outlived translation, without positions or by events.

It starts from equilibrium as smooth disks, without spin. R is sampled after each collision per
particle.
"""

import math
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
import xarray as xr

from roughgas.gas import Gas, build, ratio
from roughgas.tasks import dsmc, seed_sequence, timed
from roughgas.tasks.free_cooling import FreeCooling
from roughgas.theory import RUNAWAY_R

SIMULATED = ("dsmc", "events")
"""Methods of simulation."""
STEP_LENGTH = 4  # collisions per particle between two samples of single particles
END_OF_EXAMPLE = 0.999  # R at the end of the example
SERIES = ("R", "largest_share", "participation")

Step = Callable[[], tuple[np.ndarray, np.ndarray]]
"""Function that advances a gas by STEP_LENGTH collisions per particle, and returns R after each and
the final spins."""


def tasks(settings: Mapping[str, Any]) -> list[str]:
    """Return the names of all gases, the longest first."""
    return list(gases_of(settings))


def task_name(kind: str, particles: int, mu: float) -> str:
    """Return the name of a task."""
    return f"{kind}-n{particles}-mu{mu:g}"


def gases_of(settings: Mapping[str, Any]) -> dict[str, tuple[str, float, Mapping[str, Any]]]:
    """Return (kind, mu, particles and lengths) of each gas by name, the longest first.

    The random numbers of a gas depend on its position in this list.
    """
    gases = [
        (kind, mu, row) for kind in SIMULATED for row in settings[kind] for mu in settings["mu"]
    ]
    gases += [("example", mu, settings["example"]) for mu in settings["example"]["mu"]]
    gases.sort(key=_cost, reverse=True)
    return {task_name(kind, row["particles"], mu): (kind, mu, row) for kind, mu, row in gases}


def _cost(gas):
    """Return the largest number of collisions of a gas, weighted by their cost: by events 20
    times."""
    kind, _, row = gas
    return (20 if kind == "events" else 1) * row["particles"] * row["limit"] * row.get("runs", 1)


def run(task: str, settings, experiments, progress: Callable[[int, int], None]) -> xr.Dataset:
    """Return the dataset of one task, for results.combine."""
    gases = gases_of(settings)
    kind, mu, row = gases[task]
    cooling = FreeCooling(experiments["cooling"], float(settings["r"]), float(settings["beta"]))
    start = {"events": by_events, "dsmc": without_positions, "example": without_positions}[kind]
    key = 1 + list(gases).index(task)
    run_until_escape(start(cooling, settings, mu, 100, seed_sequence(settings, 0)), STEP_LENGTH)
    seeds = seed_sequence(settings, key).spawn(row.get("runs", 1))
    if kind == "example":
        step = start(cooling, settings, mu, row["particles"], seeds[0])
        columns, seconds = timed(record_series, step, row["limit"])
        progress(1, 1)
        values = {name: ("sample", column) for name, column in zip(SERIES, columns, strict=True)}
        return xr.Dataset(values | {"seconds": seconds})
    rows = []
    for k, seed in enumerate(seeds):
        step = start(cooling, settings, mu, row["particles"], seed)
        values, seconds = timed(run_until_escape, step, row["limit"])
        rows.append((*values, seconds))
        progress(k + 1, len(seeds))
    names = ("time", "observed", *SERIES[1:], "seconds")
    columns = zip(names, np.array(rows).T, strict=True)
    return xr.Dataset({name: ("run", column) for name, column in columns})


def without_positions(cooling: FreeCooling, settings, mu, particles, seed) -> Step:
    """Return the Step of a homogeneous gas by direct simulation Monte Carlo."""
    rng, (r, beta, dimension, q) = np.random.default_rng(seed), cooling.constants
    gas = dsmc.new_gas(particles, 0.0, rng, dimension, q)
    material = dsmc.material(r, beta, dimension, q, mu=mu)
    return lambda: (dsmc.run(gas, material, rng, 1.0, STEP_LENGTH).R, gas.spin)


def by_events(cooling: FreeCooling, settings, mu, particles, seed) -> Step:
    """Return the Step of an event-driven gas in a box that it fills to the packing."""
    changes = {"particles": particles, "effects": {"friction": {"mu": mu}}}
    experiment = cooling.experiment.changed(changes)
    gas_in_box = cooling._replace(experiment=experiment).at_packing(settings["packing"])
    scene = build(gas_in_box.experiment, gas_in_box.r, gas_in_box.beta)
    gas = Gas.start(scene, gas_in_box.experiment, np.random.default_rng(seed))
    gas.thermalise(experiment.schedule.thermalise)
    gas.cool(STEP_LENGTH * gas.count(1.0))

    def step():
        rows = gas.in_collisions(gas.count(1.0), STEP_LENGTH)
        return ratio(gas.energies(rows)), gas.spins()

    return step


def run_until_escape(step: Step, limit: int) -> tuple[float, float, float, float]:
    """Return the collisions per particle until R > RUNAWAY_R (NaN if not reached within `limit`),
    the number observed, and `participation` at the last step."""
    for passed in range(0, limit, STEP_LENGTH):
        R, spin = step()
        beyond = np.flatnonzero(R > RUNAWAY_R)
        if beyond.size:
            time = float(passed + beyond[0] + 1)
            return time, time, *participation(spin)
    return math.nan, float(passed + STEP_LENGTH), *participation(spin)


def record_series(step: Step, limit: int) -> np.ndarray:
    """Return SERIES every STEP_LENGTH collisions per particle up to `limit`, NaN after R >
    END_OF_EXAMPLE."""
    rows = np.full((limit // STEP_LENGTH, len(SERIES)), math.nan)
    for k in range(len(rows)):
        R, spin = step()
        rows[k] = R[-1], *participation(spin)
        if R[-1] > END_OF_EXAMPLE:
            break
    return rows.T


def participation(spin: np.ndarray) -> tuple[float, float]:
    """Return the largest share of one particle in the energy of the spins, shape (N, D'), and
    the participation number (sum e)^2/sum e^2, the equivalent number of particles with equal
    energies."""
    energy = np.sum(spin**2, axis=1)
    total = energy.sum()
    return float(energy.max() / total), float(total**2 / np.sum(energy**2))
