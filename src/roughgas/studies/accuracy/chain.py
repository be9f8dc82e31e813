"""A gas that is equilibrated once and then measured for as long, and as often, as is wanted."""

import time
from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np

from roughgas.scene import Scene, build
from roughgas.scene.initial import initial_state
from roughgas.simulation.cooling import SAMPLES_PER_REFRESH
from roughgas.simulation.energies import ratio
from roughgas.simulation.recorder import Recorder
from roughgas.simulation.steady import fluctuations, samples_per_period
from roughgas.statistics.averages import period_means


class Segment(NamedTuple):
    """A stretch of a chain: R of each period (or sample), the CPU seconds and the collisions."""

    R: np.ndarray
    seconds: float
    collisions: int


class Chain:
    """One gas of an experiment, advanced piece by piece.

    Lengths are in T, in a cooling gas in collisions per particle. `equilibration` are the CPU
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
        self.scene = build(experiment, r, beta)
        self.number, self.schedule = experiment["particles"], experiment["schedule"]
        self.recorder = Recorder()
        self.state = initial_state(self.scene, experiment, rng)
        if self.cooling:
            elastic = self.scene._replace(restitution=1.0, roughness=-1.0)
            self._rows(elastic, self.schedule["thermalise"], refresh=0)
        self._rows(self.scene, equilibrate)
        self.equilibration = time.process_time() - begin

    @property
    def cooling(self) -> bool:
        """Whether lengths are in collisions per particle, not in T."""
        return self.schedule["kind"] == "cooling"

    def measure(self, length: float) -> Segment:
        """The next `length` of the chain; R over whole periods of a floor, else of each sample."""
        begin, before = time.process_time(), self.recorder.collisions
        R = ratio(fluctuations(self.scene, self._rows(self.scene, length), self.number))
        seconds = time.process_time() - begin
        period = samples_per_period(self.schedule)
        return Segment(period_means(R, period), seconds, self.recorder.collisions - before)

    def _rows(self, scene: Scene, length: float, refresh: int = SAMPLES_PER_REFRESH):
        every = self.schedule["sample_every"]
        samples = round(length / every)
        if not self.cooling:
            return self.recorder.in_time(self.state, scene, every, samples)
        collisions = max(1, round(self.number / 2 * every))  # a collision has two partners
        return self.recorder.in_collisions(self.state, scene, collisions, samples, refresh)
