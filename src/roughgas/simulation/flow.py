"""A watch on the flow that R assumes: between images or walls that slide, a straight line.

The energy of any other flow counts as temperature in R. A run therefore looks at its local flow now
and then, and says by how much R is larger over that.
"""

import math
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from roughgas.observables import System
from roughgas.observables.flow import IN_CELL, Motion, cells_of, over_flow
from roughgas.scene import Scene, assumes_flow
from roughgas.simulation import schedule
from roughgas.simulation.restart import positions_and_velocities
from roughgas.statistics.errors import Estimate, stderr_over_seeds

if TYPE_CHECKING:
    from roughgas.simulation.gas import Gas

LOOKS = 10
"""At the flow in a measurement as long as its schedule plans."""


class FlowWatch:
    """Looks at the local flow of a gas every now and then."""

    def __init__(self, system: System, every: int) -> None:
        self.every, self._system = every, system
        self._cells = cells_of(system, IN_CELL)
        unity = np.ones(system.particles)
        self._alike = unity, (system.inertia or 0.0) * unity, unity
        self.shifts: list[tuple[int, float]] = []  # samples that had been taken, and the shift of R

    def look(self, gas: "Gas", taken: int) -> None:
        """Look at a gas from which `taken` samples have been taken."""
        state, bodies = gas.state, self._alike
        if state.bodies is not None:
            bodies = state.bodies.mass, state.bodies.inertia, state.bodies.radius
        where = positions_and_velocities(state, gas.scene, gas.time)
        motion = Motion(*where, state.spin, *bodies)
        self.shifts.append((taken, over_flow(motion, self._system, self._cells).shift))

    def shift(self, first: int) -> Estimate:
        """Return by how much R is larger over the local flow, after `first` samples.

        Looks are far apart, and count as independent.
        """
        shifts = np.array([shift for taken, shift in self.shifts if taken > first])
        if not len(shifts):
            return Estimate(math.nan, math.nan, 0.0)
        return Estimate(float(shifts.mean()), stderr_over_seeds(shifts), len(shifts) - 1.0)


def watch_of(scene: Scene, experiment: Mapping[str, Any]) -> FlowWatch | None:
    """Return a watch on a gas whose R assumes a flow, new for each; None for any other, and where
    there are no two cells with particles enough for a flow."""
    timing, effects = experiment["schedule"], scene.effects
    if not assumes_flow(effects) or effects.spin is None or timing["kind"] != "steady":
        return None
    system = schedule.system_of(scene, experiment)
    if math.prod(cells_of(system, IN_CELL)) < 2:
        return None
    return FlowWatch(system, max(1, int(timing["measure"] / timing["sample_every"] / LOOKS)))
