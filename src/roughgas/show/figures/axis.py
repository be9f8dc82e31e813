"""The parameters that figures have along their horizontal axis."""

from typing import NamedTuple

import numpy as np
from matplotlib.axes import Axes
from matplotlib.ticker import MultipleLocator

SIDESTEP = 0.0066
"""Distance between the residuals of two series, as a share of the axis: none hides another."""


class Axis(NamedTuple):
    """A coordinate of reduced datasets, drawn horizontally."""

    name: str
    label: str
    limits: tuple[float, float]
    drawn: tuple[float, float]  # where theory is drawn from and to
    logarithmic: bool = False

    @property
    def grid(self) -> np.ndarray:
        """Close values at which theory is drawn, (801,)."""
        spaced = np.geomspace if self.logarithmic else np.linspace
        return spaced(*self.drawn, 801)

    def prepare(self, axes: Axes) -> None:
        """Label the axis of a plot, and set its scale and its limits."""
        axes.set_xlabel(self.label)
        if self.logarithmic:
            axes.set_xscale("log")
        axes.set_xlim(*self.limits)
        if not self.logarithmic:
            step = 0.5 if self.limits[1] - self.limits[0] > 2 else 0.2
            axes.xaxis.set_major_locator(MultipleLocator(step))
            axes.xaxis.set_minor_locator(MultipleLocator(step / 5))

    def aside(self, at: np.ndarray, steps: float) -> np.ndarray:
        """Return places that are `steps` steps beside those given."""
        low, high = self.limits
        if self.logarithmic:
            return at * (high / low) ** (SIDESTEP * steps)
        return at + SIDESTEP * (high - low) * steps


BETA = Axis("beta", r"tangential restitution $\beta$", (-1.06, 1.06), (-1, 1))
FRICTION = Axis("mu", r"coefficient of friction $\mu$", (0.007, 14), (0.007, 14), True)
INERTIA = Axis("inertia", r"moment of inertia $q = I/(ma^2)$", (0.008, 1.25), (0.008, 1), True)
SPIN_SHARE = Axis(
    "spin_share",
    "share $s$ of the drive's power\nthat goes into rotation",
    (-0.15, 1.03),
    (-0.12, 1),
)
ROUGHNESS = Axis("roughness", r"roughness of the boundary", (-1.06, 1.06), (-1, 1))
