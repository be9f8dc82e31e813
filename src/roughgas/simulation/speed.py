"""How fast this machine simulates the scenes of experiments."""

from collections.abc import Callable, Mapping, Sequence
from statistics import median
from typing import Any, NamedTuple

import numpy as np

from roughgas.scene import build
from roughgas.simulation import schedule

WARM_UP = 100  # collisions per particle, before anything is timed
SECONDS = 0.3  # of CPU time, about, that a run takes


class Speed(NamedTuple):
    """Collisions per second of CPU time of an experiment, in each run."""

    experiment: str
    r: float
    beta: float
    particles: int
    dimension: int
    rates: Sequence[float]

    @property
    def median(self) -> float:
        """Median over the runs."""
        return median(self.rates)


def speed_of(
    name: str,
    settings: Mapping[str, Any],
    r: float,
    beta: float,
    runs: int,
    done: Callable[[], None],
) -> Speed:
    """Return the speed of an experiment, from a gas that has made WARM_UP collisions per particle.

    `done` is called after that, and after each run. Raises InputError for illegal values,
    CollapseError if contacts accumulate without end.
    """
    scene = build(settings, r, beta)
    gas = schedule.of(settings).start(scene, settings, np.random.default_rng(0))
    recorder, each = gas.recorder, gas.count(1.0)

    def rate(samples):
        collisions, seconds = recorder.collisions, recorder.seconds
        gas.in_collisions(each, samples)
        done()
        return (recorder.collisions - collisions) / max(recorder.seconds - seconds, 1e-9)

    samples = max(1, round(rate(WARM_UP) * SECONDS / each))
    return Speed(name, r, beta, gas.particles, len(scene.box), [rate(samples) for _ in range(runs)])
