"""A simulation under way: advances the kernel, keeps its time, and tells how far it is."""

import time
from collections.abc import Callable

import numpy as np

from roughgas.base.errors import CollapseError
from roughgas.kernel.clock import INSTANT
from roughgas.kernel.record import Sampling, columns, record
from roughgas.kernel.state import (
    BASE,
    COLLISIONS,
    EXPONENT,
    LAST_FIRST,
    LAST_SECOND,
    NOW,
    ORIGIN,
    SPAN,
    TOUCHED,
    State,
)
from roughgas.scene import Scene

REPORTS = 50
NAMED = 8  # of the particles in a collapse
UNLIMITED = 2**62


class Recorder:
    """Sums up what gases have cost together: CPU seconds in the kernel, collisions, and contacts
    that the contact-time model touched.

    `tell(time, collisions)` is called some fifty times a run.
    """

    def __init__(self, tell: Callable[[float, int], None] | None = None):
        self.seconds = 0.0
        self.collisions = 0
        self.touched = 0
        self._tell = tell

    def run(
        self, state: State, scene: Scene, sampling: Sampling, samples: int
    ) -> dict[str, np.ndarray]:
        """Advance `state`; return columns (name -> array of length `samples`).

        Raises CollapseError where contacts accumulate without end.
        """
        names = columns(len(scene.box), scene.effects.spin is not None)
        rows = np.empty((samples, len(names)))
        record(state, scene, sampling, rows[:0])  # compiles, or fetches the kernel from its cache
        begin = time.process_time()
        before = state.counts.copy()
        length = max(1, -(-samples // REPORTS))
        if sampling.refresh > 0:  # which the kernel counts from the start of each call
            length = -(-length // sampling.refresh) * sampling.refresh
        for first in range(0, samples, length):
            part = rows[first : first + length]
            if record(state, scene, sampling, part) < len(part):
                raise _collapse(state, scene)
            if self._tell:
                self._tell(float(part[-1, 0]), int(part[-1, 1]))
        self.seconds += time.process_time() - begin
        self.collisions += state.counts[COLLISIONS] - before[COLLISIONS]
        self.touched += state.counts[TOUCHED] - before[TOUCHED]
        return dict(zip(names, rows.T, strict=True))

    # for callers that do not drive a Gas yet
    def in_time(self, state: State, scene: Scene, interval: float, samples: int):
        return self.run(state, scene, Sampling(float(interval), UNLIMITED, 0), samples)

    def in_collisions(self, state: State, scene: Scene, collisions: int, samples: int, refresh=0):
        return self.run(state, scene, Sampling(np.inf, collisions, refresh), samples)

    def once(self, state: State, scene: Scene, interval: float, collisions: int):
        return self.run(state, scene, Sampling(float(interval), collisions, 0), 1)


def _collapse(state, scene):
    clock = state.clock
    time = clock[ORIGIN] + (clock[BASE] + clock[NOW]) * 2.0 ** -state.counts[EXPONENT]
    names = [str(label) for label in _collapsing(state)]
    others = f" and {len(names) - NAMED} more" if len(names) > NAMED else ""
    return CollapseError(
        f"inelastic collapse at t = {time:.6g} T of particles {', '.join(names[:NAMED])}{others}: "
        + _remedy(scene.effects)
    )


def _remedy(effects):
    if effects.contact_time is None:
        return "add the contact_time effect to the experiment, or raise r"
    if effects.floor is None and effects.walls is None:
        return "raise r, or the duration of contact_time"
    return "raise r, or make floor or walls smoother, between which a particle may be held"


def _collapsing(state):
    """Numbers of the particles whose last contact is simultaneous with the present instant.

    Where the gas has just been refreshed all are brought to it: then those of the last contact.
    """
    last = state.clock[NOW] - INSTANT * state.clock[SPAN]
    found = state.label[state.trajectory[:, -1] >= last]
    refreshed = len(found) == len(state.label)
    return np.sort(state.counts[[LAST_FIRST, LAST_SECOND]] if refreshed else found)
