"""How fast this machine simulates the scenes of experiments."""

from collections.abc import Callable, Mapping, Sequence
from statistics import median
from typing import Any, NamedTuple

import numpy as np

from roughgas.scene import build, check_company
from roughgas.scene.initial import initial_state
from roughgas.simulation.cooling import SAMPLES_PER_REFRESH
from roughgas.simulation.recorder import Recorder

WARM_UP = 100  # collisions per particle, before anything is timed
SECONDS = 0.3  # of CPU time, about, that a run takes


class Speed(NamedTuple):
    """What was measured of an experiment: collisions a second of CPU time, in each run."""

    experiment: str
    r: float
    beta: float
    particles: int
    dimension: int
    rates: Sequence[float]

    @property
    def median(self) -> float:
        """Of the runs."""
        return median(self.rates)


def measure(
    name: str,
    settings: Mapping[str, Any],
    r: float,
    beta: float,
    runs: int,
    done: Callable[[], None],
) -> Speed:
    """The speed of an experiment, from a gas that has made WARM_UP collisions per particle;
    `done` is called after that, and after each run.

    Raises InputError for illegal values, CollapseError where contacts accumulate without end.
    """
    scene = build(settings, r, beta)
    check_company(scene, settings)
    state = initial_state(scene, settings, np.random.default_rng(0))
    refresh = SAMPLES_PER_REFRESH if settings["schedule"]["kind"] == "cooling" else 0
    each = max(1, settings["particles"] // 2)  # a collision has two partners

    def rate(samples):
        recorder = Recorder()
        recorder.in_collisions(state, scene, each, samples, refresh)
        done()
        return recorder.collisions / max(recorder.seconds, 1e-9)

    samples = max(1, round(rate(WARM_UP) * SECONDS / each))
    rates = [rate(samples) for _ in range(runs)]
    return Speed(name, r, beta, settings["particles"], len(scene.box), rates)
