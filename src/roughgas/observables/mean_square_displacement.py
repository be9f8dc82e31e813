"""Mean square displacement: how far particles get in a given time.

    MSD_k(t) = <(x_k(t0 + t) - x_k(t0))^2>, by component,

over all particles and all looks t0. It is <v_k^2> t^2 where t is short against the time between
contacts, and 2 D t in a fluid at long times: A. Einstein, Ann. Phys. 322, 549 (1905). In a sheared
gas the component along the flow is left out. Displacements through periodic boundaries are put
together from look to look, each taken for the one that is nearest to the velocity's.
"""

from collections import deque

import numpy as np

from roughgas.data.variables import LENGTH, TIME, Variable
from roughgas.observables.frame import Frame, System
from roughgas.observables.plugin import Observable, Setting, Values, Whole

NAME = "mean_square_displacement"

SETTINGS: dict[str, Setting] = {
    "lags": Whole("Number of times, each twice the one before.", 1, 20, 8),
}
VARIABLES = {
    "lag": Variable("time between two observations", TIME, ("lag",)),
    "moving": Variable("component of the displacement", "", ("moving",), "str"),
    NAME: Variable("mean square displacement", f"{LENGTH}^2", ("lag", "moving")),
}


class MeanSquareDisplacement(Observable):
    """Mean square displacement after 1, 2, 4, 8, ... observations."""

    settings = SETTINGS
    variables = VARIABLES

    def __init__(self, system: System, lags: int) -> None:
        super().__init__(system)
        self._looks = 2 ** np.arange(lags)
        self._axes = slice(1 if system.shear_rate else 0, None)
        self._path: deque[np.ndarray] = deque(maxlen=2 ** (lags - 1) + 1)
        self._last: Frame | None = None
        self.coordinates = {
            "lag": self._looks * system.interval,
            "moving": system.axes[self._axes],
        }

    def look(self, frame: Frame) -> Values:
        """Return the mean square displacement since earlier looks, NaN where there was none."""
        step = 0.0 if self._last is None else self._step(self._last, frame)
        here = frame.position[:, self._axes] if self._last is None else self._path[-1] + step
        self._last = frame
        self._path.append(here)
        found = np.full((len(self._looks), here.shape[1]), np.nan)
        for row, looks in zip(found, self._looks, strict=True):
            if looks < len(self._path):
                row[:] = ((here - self._path[-1 - looks]) ** 2).mean(axis=0)
        return {NAME: found}

    def _step(self, before: Frame, now: Frame) -> np.ndarray:
        """Return displacements since the look before, (N, components)."""
        speed = before.velocity * before.speed_unit + now.velocity * now.speed_unit
        likely = 0.5 * speed * (now.time - before.time)
        step = now.position - before.position
        for axis, (length, periodic) in enumerate(
            zip(self.system.box, self.system.periodic, strict=True)
        ):
            if periodic:
                step[:, axis] -= length * np.rint((step - likely)[:, axis] / length)
        return step[:, self._axes]
