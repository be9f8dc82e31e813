"""A watch on the flow that R assumes: between images or walls that slide, a straight line.

The energy of any other flow counts as temperature in R. A run therefore looks at its local flow now
and then, and says by how much R is larger over that.
"""

import math
from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from roughgas.observables import System
from roughgas.observables.flow import IN_CELL, Motion, cells_of, over_flow
from roughgas.scene import Scene, assumes_flow
from roughgas.statistics.errors import Estimate, stderr_over_seeds

if TYPE_CHECKING:
    from roughgas.simulation.gas import Gas

LOOKS = 10
"""At the flow in a measurement as long as its schedule plans."""
TOGETHER = 20_000
"""Particles whose motions are kept until several looks are reduced at once."""


class FlowWatch:
    """Looks at the local flow of a gas every now and then."""

    def __init__(self, system: System, every: int) -> None:
        self.every, self._system = every, system
        self._cells = cells_of(system, IN_CELL)
        unity = np.ones(system.particles)
        self._alike = unity, (system.inertia or 0.0) * unity, unity
        self._motions: list[tuple[int, Motion]] = []  # samples before, and what is not reduced yet
        self._shifts: list[tuple[int, float]] = []  # samples before, and by how much R is larger

    def look(self, gas: "Gas", taken: int) -> None:
        """Look at a gas from which `taken` samples have been taken."""
        state, bodies = gas.state, self._alike
        if state.bodies is not None:
            bodies = state.bodies.mass, state.bodies.inertia, state.bodies.radius
        spin = None if state.spin is None else state.spin.copy()
        motion = Motion(*gas.positions_and_velocities(), spin, *bodies)
        self._motions.append((taken, motion))
        if len(self._motions) * self._system.particles >= TOGETHER:
            self._reduce()

    def _reduce(self):
        if not self._motions:
            return
        taken, motions = zip(*self._motions, strict=True)
        values = over_flow(motions, self._system, self._cells).shift
        self._shifts += zip(taken, values.tolist(), strict=True)
        self._motions.clear()

    def shifts(self) -> list[tuple[int, float]]:
        """Return the shift of R at each look so far, after the samples taken before it."""
        self._reduce()
        return self._shifts

    def restore(self, shifts: Iterable[tuple[int, float]]) -> None:
        """Go on from the `shifts` of another watch on the same gas."""
        self._motions.clear()
        self._shifts = list(shifts)

    def shift(self, first: int) -> Estimate:
        """Return by how much R is larger over the local flow, after `first` samples.

        Looks are far apart, and count as independent.
        """
        shifts = np.array([shift for taken, shift in self.shifts() if taken > first])
        if not len(shifts):
            return Estimate(math.nan, math.nan, 0.0)
        return Estimate(float(shifts.mean()), stderr_over_seeds(shifts), len(shifts) - 1.0)


def has_flow(scene: Scene, system: System, experiment: Mapping[str, Any]) -> bool:
    """Return whether R assumes a flow, and there are two cells with particles enough for another.

    Only a measurement that is planned beforehand has looks.
    """
    assumed = assumes_flow(scene.effects) and scene.effects.spin is not None
    planned = experiment["schedule"]["kind"] == "steady"
    return assumed and planned and math.prod(cells_of(system, IN_CELL)) > 1


def watch_of(scene: Scene, system: System, experiment: Mapping[str, Any]) -> FlowWatch | None:
    """Return a new watch on a gas that `has_flow`; None for any other."""
    if not has_flow(scene, system, experiment):
        return None
    timing = experiment["schedule"]
    return FlowWatch(system, max(1, int(timing["measure"] / timing["sample_every"] / LOOKS)))
