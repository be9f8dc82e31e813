"""The cost of simulations: calls the kernel, keeps its time, and tells how far it is."""

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


class Recorder:
    """Sums up what gases have cost together.

    CPU seconds in the kernel, collisions, and contacts that the contact-time model touched.
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

        Raises CollapseError if contacts accumulate without end.
        """
        names = columns(len(scene.box), scene.effects.spin is not None)
        rows = np.empty((samples, len(names)))
        record(state, scene, sampling, rows[:0])  # compiles, or fetches the kernel from its cache
        begin, before = time.process_time(), state.counts.copy()
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


def now(state: State) -> float:
    """Return the present instant, in T since the start."""
    clock, unit = state.clock, 2.0 ** -int(state.counts[EXPONENT])
    return float(clock[ORIGIN] + (clock[BASE] + clock[NOW]) * unit)


def _collapse(state: State, scene: Scene) -> CollapseError:
    names = [str(label) for label in _collapsing(state)]
    others = f" and {len(names) - NAMED} more" if len(names) > NAMED else ""
    effects, remedy = scene.effects, "raise r, or the duration of contact_time"
    if effects.contact_time is None:
        remedy = "add the contact_time effect to the experiment, or raise r"
    elif effects.floor is not None or effects.walls is not None:
        remedy = "raise r, or make floor or walls smoother, between which a particle may be held"
    return CollapseError(
        f"inelastic collapse at t = {now(state):.6g} T of particles "
        f"{', '.join(names[:NAMED])}{others}: {remedy}"
    )


def _collapsing(state):
    """Return the numbers of particles whose last contact is simultaneous with the present instant.

    A refresh brings all particles to the present: just after it, those of the last contact.
    """
    last = state.clock[NOW] - INSTANT * state.clock[SPAN]
    found = state.label[state.trajectory[:, -1] >= last]
    refreshed = len(found) == len(state.label)
    return np.sort(state.counts[[LAST_FIRST, LAST_SECOND]] if refreshed else found)
