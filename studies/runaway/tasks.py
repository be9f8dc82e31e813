"""A cooling gas with friction until spin has outlived translation, without positions or by events.

It starts from equilibrium as smooth disks, without spin, and is looked at after each collision per
particle.
"""

import math
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
import xarray as xr

from roughgas.gas import Gas, build, ratio
from roughgas.tasks import dsmc, stream, timed
from roughgas.tasks.free_cooling import FreeCooling
from roughgas.theory import ESCAPED

SIMULATED = ("dsmc", "events")
"""How a gas is simulated."""
STRIDE = 4  # collisions per particle between two looks at single particles
WHOLLY = 0.999  # R up to which the example is followed
SERIES = ("R", "largest_share", "participation")

Step = Callable[[], tuple[np.ndarray, np.ndarray]]
"""Lets a gas make STRIDE collisions per particle: R after each, and the spins in the end."""


def tasks(settings: Mapping[str, Any]) -> list[str]:
    """Return the names of all gases, the longest first."""
    return list(gases_of(settings))


def gas_name(kind: str, particles: int, mu: float) -> str:
    """Return the name of a task."""
    return f"{kind}-n{particles}-mu{mu:g}"


def gases_of(settings: Mapping[str, Any]) -> dict[str, tuple[str, float, Mapping[str, Any]]]:
    """Return (kind, mu, particles and lengths) of each gas by name, the longest first.

    The random numbers of a gas are of its place in this list.
    """
    gases = [
        (kind, mu, one) for kind in SIMULATED for one in settings[kind] for mu in settings["mu"]
    ]
    gases += [("example", mu, settings["example"]) for mu in settings["example"]["mu"]]
    gases.sort(key=_collisions, reverse=True)
    return {gas_name(kind, one["particles"], mu): (kind, mu, one) for kind, mu, one in gases}


def _collisions(gas):
    """Return how many a gas makes at most, one by events counting as much as it takes longer."""
    kind, _, one = gas
    return (20 if kind == "events" else 1) * one["particles"] * one["limit"] * one.get("runs", 1)


def run(task: str, settings, experiments, progress: Callable[[int, int], None]) -> xr.Dataset:
    """Return what one task finds, as results.combine takes it."""
    gases = gases_of(settings)
    kind, mu, about = gases[task]
    cooling = FreeCooling(experiments["cooling"], float(settings["r"]), float(settings["beta"]))
    start = {"events": by_events, "dsmc": without_positions, "example": without_positions}[kind]
    place = 1 + list(gases).index(task)
    escape(start(cooling, settings, mu, 100, stream(settings, 0)), STRIDE)
    seeds = stream(settings, place).spawn(about.get("runs", 1))
    if kind == "example":
        step = start(cooling, settings, mu, about["particles"], seeds[0])
        columns, seconds = timed(follow, step, about["limit"])
        found = {name: ("sample", column) for name, column in zip(SERIES, columns, strict=True)}
        return xr.Dataset(found | {"seconds": seconds})
    rows = []
    for k, seed in enumerate(seeds):
        step = start(cooling, settings, mu, about["particles"], seed)
        found, seconds = timed(escape, step, about["limit"])
        rows.append((*found, seconds))
        progress(k + 1, len(seeds))
    names = ("time", "observed", *SERIES[1:], "seconds")
    columns = zip(names, np.array(rows).T, strict=True)
    return xr.Dataset({name: ("run", column) for name, column in columns})


def without_positions(cooling: FreeCooling, settings, mu, particles, seed) -> Step:
    """Return how to move a homogeneous gas by direct simulation Monte Carlo."""
    rng, (r, beta, dimension, q) = np.random.default_rng(seed), cooling.constants
    gas = dsmc.new_gas(particles, 0.0, rng, dimension, q)
    material = dsmc.material(r, beta, dimension, q, mu=mu)
    return lambda: (dsmc.run(gas, material, rng, 1.0, STRIDE).R, gas.spin)


def by_events(cooling: FreeCooling, settings, mu, particles, seed) -> Step:
    """Return how to move an event-driven gas in a box that it fills to the packing."""
    effects = dict(cooling.experiment["effects"]) | {"friction": {"mu": mu}}
    experiment = dict(cooling.experiment) | {"particles": particles, "effects": effects}
    there = cooling._replace(experiment=experiment).at_packing(settings["packing"])
    scene = build(there.experiment, there.r, there.beta)
    gas = Gas.start(scene, there.experiment, np.random.default_rng(seed))
    gas.thermalise(experiment["schedule"]["thermalise"])
    gas.cool(STRIDE * gas.count(1.0))

    def step():
        rows = gas.in_collisions(gas.count(1.0), STRIDE)
        return ratio(gas.energies(rows)), gas.spins()

    return step


def escape(step: Step, limit: int) -> tuple[float, float, float, float]:
    """Return the collisions per particle until R > ESCAPED (NaN if that is not within `limit`), how
    many were observed, and `participation` when it was last looked at."""
    for passed in range(0, limit, STRIDE):
        R, spin = step()
        beyond = np.flatnonzero(R > ESCAPED)
        if beyond.size:
            time = float(passed + beyond[0] + 1)
            return time, time, *participation(spin)
    return math.nan, float(passed + STRIDE), *participation(spin)


def follow(step: Step, limit: int) -> np.ndarray:
    """Return SERIES every STRIDE collisions per particle up to `limit`, NaN after R > WHOLLY."""
    rows = np.full((limit // STRIDE, len(SERIES)), math.nan)
    for k in range(len(rows)):
        R, spin = step()
        rows[k] = R[-1], *participation(spin)
        if R[-1] > WHOLLY:
            break
    return rows.T


def participation(spin: np.ndarray) -> tuple[float, float]:
    """Return the largest share of a particle in the energy of the spins, shape (N, D'), and the
    participation number (sum e)^2/sum e^2: how many particles hold that energy, if alike."""
    energy = np.sum(spin**2, axis=1)
    total = energy.sum()
    return float(energy.max() / total), float(total**2 / np.sum(energy**2))
