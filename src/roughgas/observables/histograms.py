"""Histograms: the distributions of the components of velocities and of spins.

Each component is divided by the root of its mean square over all particles and components at the
same look, so that a Gaussian is exp(-c^2/2)/sqrt(2 pi), whatever the energy. Values are densities:
summed over the bins, times their width, they give 1 less the share beyond the last bin. In a
sheared gas the mean flow and the mean spin are subtracted. Of stretched tails: T. P. C. van Noije &
M. H. Ernst, Granular Matter 1, 57 (1998).
"""

import numpy as np

from roughgas.data.variables import SPIN, Variable
from roughgas.effects.settings import Number
from roughgas.observables.frame import Frame, System
from roughgas.observables.plugin import Observable, Setting, Values, Whole

ALONG = "reduced_velocity"

SETTINGS: dict[str, Setting] = {
    "bins": Whole("Number of bins.", 2, 10_000, 60),
    "reach": Number("End of the last bin, in root mean squares.", "(0, 1000]", 6.0),
}
VARIABLES = {
    ALONG: Variable("middle of a bin, in root mean squares", "1", (ALONG,)),
    "component": Variable("component of a vector", "", ("component",), "str"),
    "velocity_histogram": Variable("distribution of velocities", "1", (ALONG, "component")),
    "spin_histogram": Variable("distribution of spins", "1", (ALONG,), when=(SPIN,)),
}


class Histograms(Observable):
    """Distributions of the components of velocities and of spins."""

    alike = True
    settings = SETTINGS
    variables = VARIABLES

    def __init__(self, system: System, bins: int, reach: float) -> None:
        super().__init__(system)
        self._edges = np.linspace(-reach, reach, bins + 1)
        middle = (self._edges[1:] + self._edges[:-1]) / 2.0
        self.coordinates = {ALONG: middle, "component": system.axes}

    def look(self, frame: Frame) -> Values:
        """Return the histograms of a frame."""
        velocity = _reduced(frame.thermal_velocity)
        columns = [self._histogram(column) for column in velocity.T]
        found = {"velocity_histogram": np.array(columns).T}
        if self.system.inertia is not None:
            found["spin_histogram"] = self._histogram(_reduced(frame.thermal_spin))
        return found

    def _histogram(self, values: np.ndarray) -> np.ndarray:
        counts, edges = np.histogram(values, self._edges)
        return counts / (values.size * np.diff(edges))


def _reduced(values):
    """Return components in terms of their root mean square; 0 where all are 0."""
    scale = np.sqrt(np.mean(values**2))
    return values / scale if scale > 0.0 else values
