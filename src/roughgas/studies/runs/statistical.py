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
from roughgas.statistics.errors import autocorrelation_time, period_means
from roughgas.studies.tasks import PARTS, SCENES
from roughgas.tasks import stream, timed

BLOCK = 50  # autocorrelation times: beyond ten of them no tail is left
GENEROSITY = 4
"""A level gets more groups than it must have until it costs a fourth of the longest one."""


class Chain:
    """One gas of an experiment, advanced piece by piece.

    Lengths are in T, in a cooling gas in collisions per particle. It starts from a lattice, a
    cooling gas with the experiment's thermalisation; `rng` draws the initial state.
    """

    def __init__(self, experiment: Mapping[str, Any], r, beta, equilibrate, rng) -> None:
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
    measured = _reference if part == "reference" else partial(_estimates, way=part)
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
    rows = []
    for chain, equilibration in chains(settings["chains"]):
        before = chain.gas.recorder.collisions
        R, seconds = timed(chain.measure, length)
        unit, windowed = length / len(R), autocorrelation_time(R)
        row = {
            "equilibration": equilibration,
            "R": R.mean(),
            "variance": R.var(),
            "autocorrelation_time": time_from_blocks(R, math.ceil(BLOCK * windowed)) * unit,
            "windowed_time": windowed * unit,
            "time": length,
            "seconds": seconds,
            "contacts": chain.gas.recorder.collisions - before,
        }
        rows.append(row)
    return {name: ("chain", [row[name] for row in rows]) for name in rows[0]}


def _estimates(settings, shortest, chains, way) -> dict[str, tuple]:
    """R and CPU seconds of the groups of all levels, NaN where a level has no more groups.

    At level k, a group is a run of 2^k times the shortest length, or 2^k runs of this length, each
    of another chain.
    """
    sizes = 2 ** np.arange(settings["levels"])
    stretches = np.maximum(1, sizes[::-1] // GENEROSITY)  # for each group that a level must have
    if way == "length":
        number, runs, lengths = settings["groups"], np.ones_like(sizes), sizes * shortest
    else:
        number, runs, lengths = sizes[-1], sizes, np.full_like(sizes, shortest, np.float64)
        stretches = -(-settings["groups"] * stretches * sizes // number)
    rows, equilibration = [], []
    for chain, seconds in chains(number):
        equilibration.append(seconds)
        parts = (timed(chain.measure, length) for length in np.repeat(lengths, stretches))
        rows.append([(R.mean(), seconds) for R, seconds in parts])
    measured = np.moveaxis(np.array(rows), 2, 0)  # (2, chains, stretches)
    filled = np.full((2, len(sizes), np.max(number * stretches // runs)), np.nan)
    for level, part in enumerate(np.split(measured, np.cumsum(stretches)[:-1], axis=2)):
        part = part if way == "length" else part.swapaxes(1, 2)
        R, seconds = part.reshape(2, -1, runs[level])
        filled[:, level, : len(R)] = R.mean(axis=1), seconds.sum(axis=1)
    found = {
        name: (("level", "group"), x) for name, x in zip(("R", "seconds"), filled, strict=True)
    }
    return {**found, "equilibration": ("chain", equilibration)}
