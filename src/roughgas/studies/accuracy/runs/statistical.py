"""Estimates of R from disjoint stretches of chains, each of them equilibrated once."""

import math
from collections.abc import Callable, Mapping
from functools import partial
from typing import Any

import numpy as np
import xarray as xr

from roughgas.scene import build
from roughgas.simulation import schedule
from roughgas.simulation.energies import ratio
from roughgas.simulation.steady import samples_per_period
from roughgas.statistics.averages import period_means
from roughgas.statistics.errors import autocorrelation_time
from roughgas.studies.accuracy.runs import stream, timed
from roughgas.studies.accuracy.tasks import PARTS, SCENES

BLOCK = 50  # autocorrelation times: beyond ten of them no tail is left
GENEROSITY = 4
"""A level gets more groups than it must have until it costs a fourth of the longest one."""


class Chain:
    """One gas of an experiment, advanced piece by piece.

    Lengths are in T, in a cooling gas in collisions per particle. It starts from a lattice, a
    cooling gas with the experiment's thermalisation; `rng` draws the initial state.
    """

    def __init__(
        self,
        experiment: Mapping[str, Any],
        r: float,
        beta: float,
        equilibrate: float,
        rng: np.random.Generator,
    ):
        self.kind, self.schedule = schedule.of(experiment), experiment["schedule"]
        self.gas = self.kind.start(build(experiment, r, beta), experiment, rng)
        self._sample(equilibrate)

    def measure(self, length: float) -> np.ndarray:
        """Return R of each period (or sample) in the next `length` of the chain."""
        R = ratio(self.gas.energies(self._sample(length)))
        return period_means(R, samples_per_period(self.schedule))

    def _sample(self, length: float):
        every = self.schedule["sample_every"]
        return self.kind.sample(self.gas, every, round(length / every))


def run(task: str, settings, experiments, progress: Callable[[int, int], None]) -> xr.Dataset:
    """Return estimates of R and their costs.

    A reference has dimension (chain,), levels have (level, group), NaN where a level has fewer
    groups. `equilibration` is the CPU seconds until the first measurement of each chain.
    """
    scene, part = task.split("-")
    own, material = settings["scenes"][scene], (float(settings["r"]), float(settings["beta"]))
    streams = stream(settings, SCENES.index(scene), PARTS.index(part))
    start = partial(Chain, experiments[scene], *material, own["equilibrate"])

    def chains(count):
        for done, seed in enumerate(streams.spawn(count)):
            progress(done, count)
            yield timed(start, np.random.default_rng(seed))
        progress(count, count)

    start(np.random.default_rng(0)).measure(own["shortest"])  # compiles
    measured = {"reference": _reference, "length": _lengths, "seeds": _seeds}[part]
    return xr.Dataset(measured(settings, own["shortest"], chains))


def time_from_blocks(series: np.ndarray, length: int) -> float:
    """Return the integrated autocorrelation time in samples, from means over `length` samples.

    Unlike an estimate with a window it misses no slow tail; known to (2 length/samples)^(1/2)
    only; too small by half of itself over `length`, relatively. NaN for fewer than two blocks.
    """
    if len(series) < 2 * length:
        return math.nan
    return float(length * period_means(series, length).var(ddof=1) / series.var())


def _reference(settings, shortest, chains) -> dict[str, tuple]:
    """Chains that are together `reference` times as long as the longest level."""
    total = settings["reference"] * 2 ** (settings["levels"] - 1)
    length = math.ceil(total / settings["chains"]) * shortest
    rows = [_of_reference(*made, length) for made in chains(settings["chains"])]
    return {name: ("chain", [row[name] for row in rows]) for name in rows[0]}


def _of_reference(chain, equilibration, length) -> dict[str, float]:
    before = chain.gas.recorder.collisions
    R, seconds = timed(chain.measure, length)
    unit, windowed = length / len(R), autocorrelation_time(R)
    return {
        "equilibration": equilibration,
        "R": R.mean(),
        "variance": R.var(),
        "autocorrelation_time": time_from_blocks(R, math.ceil(BLOCK * windowed)) * unit,
        "windowed_time": windowed * unit,
        "time": length,
        "seconds": seconds,
        "contacts": chain.gas.recorder.collisions - before,
    }


def _lengths(settings, shortest, chains) -> dict[str, tuple]:
    """Estimates from one run each: level k takes 2^k times the shortest length."""
    sizes, stretches = _sizes(settings)
    lengths = np.repeat(sizes, stretches) * shortest
    measured, equilibration = _measured(chains(settings["groups"]), lengths)
    levels = np.split(measured, np.cumsum(stretches)[:-1], axis=2)
    return _levels([level.reshape(2, -1) for level in levels], equilibration)


def _seeds(settings, shortest, chains) -> dict[str, tuple]:
    """Estimates from 2^k runs of the shortest length, each of another chain, at level k."""
    sizes, stretches = _sizes(settings)
    most = sizes[-1]
    counts = -(-settings["groups"] * stretches * sizes // most)
    measured, equilibration = _measured(chains(most), [shortest] * counts.sum())
    levels = np.split(measured.swapaxes(1, 2), np.cumsum(counts)[:-1], axis=1)
    groups = [level.reshape(2, -1, size) for level, size in zip(levels, sizes, strict=True)]
    return _levels([(R.mean(axis=1), seconds.sum(axis=1)) for R, seconds in groups], equilibration)


def _sizes(settings) -> tuple[np.ndarray, np.ndarray]:
    """Return the size of each level, and how many groups it gets for each that it must have."""
    sizes = 2 ** np.arange(settings["levels"])
    return sizes, np.maximum(1, sizes[::-1] // GENEROSITY)


def _measured(chains, lengths) -> tuple[np.ndarray, list[float]]:
    """Return mean R and CPU seconds, shape (2, chains, lengths), of stretches of each chain."""
    rows, equilibration = [], []
    for chain, seconds in chains:
        equilibration.append(seconds)
        measured = (timed(chain.measure, length) for length in lengths)
        rows.append([(R.mean(), seconds) for R, seconds in measured])
    return np.moveaxis(np.array(rows), 2, 0), equilibration


def _levels(found, equilibration) -> dict[str, tuple]:
    """Return R and CPU seconds of the groups of all levels, NaN where a level has no more."""
    filled = np.full((2, len(found), max(len(R) for R, _ in found)), np.nan)
    for level, values in enumerate(found):
        filled[:, level, : len(values[0])] = values
    R, seconds = ((("level", "group"), values) for values in filled)
    return {"R": R, "seconds": seconds, "equilibration": ("chain", equilibration)}
