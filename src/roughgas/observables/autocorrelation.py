"""How long velocities and spins are remembered.

    C_v(t) = <V(t0) . V(t0 + t)>/D,    C_w(t) = <w(t0) . w(t0 + t)>/(2 D - 3),

over all particles and all looks t0. The coefficient of self-diffusion is the integral of C_v over
time, that of the angle the integral of C_w/a^2: M. S. Green, J. Chem. Phys. 22, 398 (1954); R.
Kubo, J. Phys. Soc. Jpn. 12, 570 (1957). In a cooling gas velocities are in units of the present
E_trans at either time, which is 1, and time counts in collisions per particle.
"""

from collections import deque
from collections.abc import Mapping
from typing import ClassVar

import numpy as np

from roughgas.data.variables import SPIN, TIME, Variable
from roughgas.observables.plugin import Frame, Observable, Setting, System, Values, Whole

SQUARED = "a^2 T^-2"
VELOCITY, OF_SPIN = "velocity_autocorrelation", "spin_autocorrelation"


class Autocorrelation(Observable):
    """Autocorrelation of velocities and of spins, after 0, 1, 2, ... observations."""

    alike = True

    settings: ClassVar[Mapping[str, Setting]] = {
        "delays": Whole("Number of times, the first one 0.", 2, 10_000, 50)
    }
    variables: Mapping[str, Variable] = {
        "delay": Variable("time from one observation to another", TIME, ("delay",)),
        VELOCITY: Variable("autocorrelation of a velocity component", SQUARED, ("delay",)),
        OF_SPIN: Variable("autocorrelation of a spin component", SQUARED, ("delay",), when=(SPIN,)),
    }

    def __init__(self, system: System, delays: int) -> None:
        super().__init__(system)
        self._path: deque[tuple[np.ndarray, np.ndarray]] = deque(maxlen=delays)
        self.coordinates = {"delay": np.arange(delays) * system.interval}

    def look(self, frame: Frame) -> Values:
        """Return both since earlier looks, NaN where there was none."""
        self._path.appendleft((frame.thermal_velocity.copy(), frame.thermal_spin.copy()))
        found = np.full((2, self._path.maxlen or 0), np.nan)
        for k, before in enumerate(self._path):
            for row, then, now in zip(found, before, self._path[0], strict=True):
                row[k] = np.mean(then * now)
        return {VELOCITY: found[0], OF_SPIN: found[1]}

    def combine(self, means: Values) -> Values:
        """Return both; that of spins where there are any."""
        if self.system.inertia is not None:
            return means
        return {VELOCITY: means[VELOCITY]}
