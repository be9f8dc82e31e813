"""A simulation under way: advances the kernel, keeps its time, and tells how far it is."""

import time
from collections.abc import Callable

import numpy as np

from roughgas.errors import CollapseError
from roughgas.kernel.record import Plan, columns, record
from roughgas.kernel.state import BASE, COLLISIONS, LAST_FIRST, LAST_SECOND, NOW, TOUCHED, State
from roughgas.scene import Scene

REPORTS = 50
UNLIMITED = 2**62

Progress = Callable[[float, int], None]


class Recorder:
    """Runs scenes and sums up, over all its runs, the kernel's seconds, collisions, and contacts
    that the contact-time model touched.

    `progress(time, collisions)` is called some fifty times a run.
    """

    def __init__(self, progress: Progress | None = None):
        self.seconds = 0.0
        self.collisions = 0
        self.touched = 0
        self.progress = progress

    def in_time(self, state: State, scene: Scene, interval: float, samples: int):
        """Columns (name -> array of length `samples`), sampled every `interval` T."""
        return self._run(state, scene, Plan(float(interval), UNLIMITED, 0), samples)

    def in_collisions(self, state: State, scene: Scene, collisions: int, samples: int, refresh=0):
        """The same, sampled every so many collisions; the gas is refreshed every `refresh` samples.

        The kernel's energies are in units that a refreshed gas changes: here they are restored.
        """
        rows = self._run(state, scene, Plan(np.inf, collisions, refresh), samples)
        unit = np.ldexp(1.0, rows.pop("exponent").astype(int))
        for name in rows:
            power = 2 if name.startswith(("vv", "ww")) else name.startswith(("p_", "w", "yv"))
            rows[name] *= unit**power
        return rows

    def _run(self, state, scene, plan, samples):
        names = columns(len(scene.box), scene.effects.spin is not None)
        rows = np.empty((samples, len(names)))
        record(state, scene, plan, rows[:0])  # compiles, or fetches the kernel from its cache
        begin = time.perf_counter()
        before = state.counts.copy()
        length = max(1, -(-samples // REPORTS))
        if plan.refresh > 0:  # which the kernel counts from the start of each call
            length = -(-length // plan.refresh) * plan.refresh
        for first in range(0, samples, length):
            part = rows[first : first + length]
            filled = record(state, scene, plan, part)
            if filled < len(part):
                raise _collapse(state)
            if self.progress:
                self.progress(float(part[-1, 0]), int(part[-1, 1]))
        self.seconds += time.perf_counter() - begin
        self.collisions += state.counts[COLLISIONS] - before[COLLISIONS]
        self.touched += state.counts[TOUCHED] - before[TOUCHED]
        return dict(zip(names, rows.T, strict=True))


def _collapse(state):
    now = state.clock[BASE] + state.clock[NOW]
    first, second = state.counts[LAST_FIRST], state.counts[LAST_SECOND]
    return CollapseError(
        f"inelastic collapse at t = {now:.6g} T after {state.counts[COLLISIONS]} collisions, "
        f"the last between particles {first} and {second}: add the contact_time effect to the "
        "experiment, or raise r"
    )
