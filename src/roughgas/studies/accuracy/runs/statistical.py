"""Estimates of R from disjoint stretches of chains, each of them equilibrated once."""

import math
import time
from collections.abc import Callable, Iterator, Mapping
from typing import Any, NamedTuple

import numpy as np
import xarray as xr

from roughgas.scene import build
from roughgas.simulation import schedule
from roughgas.simulation.energies import ratio
from roughgas.simulation.steady import samples_per_period
from roughgas.statistics.averages import period_means
from roughgas.statistics.errors import autocorrelation_time
from roughgas.studies.accuracy.tasks import PARTS, SCENES

BLOCK = 50  # autocorrelation times: beyond ten of them no tail is left
GENEROSITY = 4
"""A level gets more groups than it must have until it costs a fourth of the longest one."""


class Segment(NamedTuple):
    """A stretch of a chain: R of each period (or sample), the CPU seconds and the collisions."""

    R: np.ndarray
    seconds: float
    collisions: int


class Chain:
    """One gas of an experiment, advanced piece by piece.

    Lengths are in T, in a cooling gas in collisions per particle. `equilibration` is the CPU
    seconds until the first measurement: from a lattice, through `equilibrate`, and before that, in
    a cooling gas, through the experiment's thermalisation. `rng` draws the initial state.
    """

    def __init__(
        self,
        experiment: Mapping[str, Any],
        r: float,
        beta: float,
        equilibrate: float,
        rng: np.random.Generator,
    ):
        begin = time.process_time()
        self.kind, self.schedule = schedule.of(experiment), experiment["schedule"]
        self.gas = self.kind.start(build(experiment, r, beta), experiment, rng)
        self._sample(equilibrate)
        self.equilibration = time.process_time() - begin

    def measure(self, length: float) -> Segment:
        """Return the next `length` of the chain."""
        begin, before = time.process_time(), self.gas.recorder.collisions
        R = ratio(self.gas.energies(self._sample(length)))
        seconds = time.process_time() - begin
        R = period_means(R, samples_per_period(self.schedule))
        return Segment(R, seconds, self.gas.recorder.collisions - before)

    def _sample(self, length: float):
        every = self.schedule["sample_every"]
        return self.kind.sample(self.gas, every, round(length / every))


class Setup(NamedTuple):
    """What the tasks of a scene have in common."""

    settings: Mapping[str, Any]
    experiment: Mapping[str, Any]
    own: Mapping[str, Any]  # lengths of the scene's runs

    @property
    def sizes(self) -> list[int]:
        """Length of each level, in terms of the shortest; or the number of seeds."""
        return [2**level for level in range(self.settings["levels"])]

    def chain(self, stream: np.random.SeedSequence) -> Chain:
        """Return a chain with random numbers of its own."""
        r, beta = float(self.settings["r"]), float(self.settings["beta"])
        rng = np.random.default_rng(stream)
        return Chain(self.experiment, r, beta, self.own["equilibrate"], rng)

    def stretches(self, size: int) -> int:
        """Return how many groups of this size there are for each that there must be."""
        return max(1, self.sizes[-1] // size // GENEROSITY)


def run(task: str, settings, experiments, progress: Callable[[int, int], None]) -> xr.Dataset:
    """Return estimates of R and their costs.

    A reference has dimension (chain,), levels have (level, group), NaN where a level has fewer
    groups.
    """
    scene, part = task.split("-")
    setup = Setup(settings, experiments[scene], settings["scenes"][scene])
    setup.chain(np.random.SeedSequence(0)).measure(setup.own["shortest"])  # compiles
    where = (SCENES.index(scene), PARTS.index(part))
    streams = np.random.SeedSequence(settings["seed"], spawn_key=where)
    measured = {"reference": _reference, "length": _lengths, "seeds": _seeds}[part]
    return xr.Dataset(measured(setup, streams, progress))


def time_from_blocks(series: np.ndarray, length: int) -> float:
    """Return the integrated autocorrelation time in samples, from means over `length` samples.

    Unlike an estimate with a window it misses no slow tail; known to (2 length/samples)^(1/2)
    only; too small by half of itself over `length`, relatively. NaN for fewer than two blocks.
    """
    blocks = len(series) // length
    if blocks < 2:
        return math.nan
    means = series[: blocks * length].reshape(blocks, length).mean(axis=1)
    return float(length * means.var(ddof=1) / series.var())


def _reference(setup, streams, progress) -> dict[str, tuple]:
    """Chains that are together `reference` times as long as the longest level."""
    count, shortest = setup.settings["chains"], setup.own["shortest"]
    total = setup.settings["reference"] * setup.sizes[-1] * shortest
    length = math.ceil(total / count / shortest) * shortest
    rows = [_of_reference(chain, length) for chain in _chains(setup, streams, count, progress)]
    return {name: ("chain", [row[name] for row in rows]) for name in rows[0]}


def _of_reference(chain, length) -> dict[str, float]:
    R, seconds, contacts = chain.measure(length)
    unit, windowed = length / len(R), autocorrelation_time(R)
    return {
        "equilibration": chain.equilibration,
        "R": R.mean(),
        "variance": R.var(),
        "autocorrelation_time": time_from_blocks(R, math.ceil(BLOCK * windowed)) * unit,
        "windowed_time": windowed * unit,
        "time": length,
        "seconds": seconds,
        "contacts": contacts,
    }


def _lengths(setup, streams, progress) -> dict[str, tuple]:
    """Estimates from one run each, of each length."""
    found, equilibration = [[] for _ in setup.sizes], []
    for chain in _chains(setup, streams, setup.settings["groups"], progress):
        equilibration.append(chain.equilibration)
        for level, size in zip(found, setup.sizes, strict=True):
            for _ in range(setup.stretches(size)):
                segment = chain.measure(size * setup.own["shortest"])
                level.append((segment.R.mean(), segment.seconds))
    return _levels([np.transpose(level) for level in found], equilibration)


def _seeds(setup, streams, progress) -> dict[str, tuple]:
    """Estimates from runs of the shortest length, each of another chain."""
    sizes, groups = setup.sizes, setup.settings["groups"]
    counts = [math.ceil(groups * setup.stretches(size) * size / sizes[-1]) for size in sizes]
    measured, equilibration = np.empty((2, sizes[-1], sum(counts))), []
    for k, chain in enumerate(_chains(setup, streams, sizes[-1], progress)):
        equilibration.append(chain.equilibration)
        for stretch in range(sum(counts)):
            segment = chain.measure(setup.own["shortest"])
            measured[:, k, stretch] = segment.R.mean(), segment.seconds
    found = []
    for part, size in zip(np.split(measured, np.cumsum(counts)[:-1], axis=2), sizes, strict=True):
        R, seconds = part.swapaxes(1, 2).reshape(2, -1, size)
        found.append((R.mean(axis=1), seconds.sum(axis=1)))
    return _levels(found, equilibration)


def _levels(found, equilibration) -> dict[str, tuple]:
    """Return R and CPU seconds of the groups of all levels, NaN where a level has no more."""
    filled = np.full((2, len(found), max(len(R) for R, _ in found)), np.nan)
    for level, values in enumerate(found):
        filled[:, level, : len(values[0])] = values
    R, seconds = ((("level", "group"), values) for values in filled)
    return {"R": R, "seconds": seconds, "equilibration": ("chain", equilibration)}


def _chains(setup, streams, count, progress) -> Iterator[Chain]:
    for done, stream in enumerate(streams.spawn(count)):
        progress(done, count)
        yield setup.chain(stream)
    progress(count, count)
