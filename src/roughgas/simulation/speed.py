"""How fast this machine simulates the scenes of experiments."""

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from roughgas.scene import Scene
from roughgas.simulation import schedule

WARM_UP = 100  # collisions per particle, before anything is timed
SECONDS = 0.3  # of CPU time, about, that a run takes


def rates_of(
    scene: Scene, settings: Mapping[str, Any], runs: int, done: Callable[[], None]
) -> list[float]:
    """Return collisions per second of CPU time of each run, after WARM_UP collisions per particle.

    `done` is called after the warm-up and after each run. Raises InputError if the particles do not
    fit, CollapseError if contacts accumulate without end.
    """
    gas = schedule.of(settings).start(scene, settings, np.random.default_rng(0))
    recorder, each = gas.recorder, gas.count(1.0)

    def rate(samples):
        collisions, seconds = recorder.collisions, recorder.seconds
        gas.in_collisions(each, samples)
        done()
        return (recorder.collisions - collisions) / max(recorder.seconds - seconds, 1e-9)

    samples = max(1, round(rate(WARM_UP) * SECONDS / each))
    return [rate(samples) for _ in range(runs)]
