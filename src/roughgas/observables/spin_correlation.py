"""Spin correlation: how velocities and spins depend on each other.

    a11 = <V^2 w^2>/(<V^2> <w^2>) - 1,    alignment = 3 <(V.w)^2>/<V^2 w^2> - 1  (spheres),

and the mean of cos^2 of the angle between V and w, which is 1/3 if spheres fly in no preferred
direction: N. V. Brilliantov, T. Pöschel, W. T. Kranz & A. Zippelius, Phys. Rev. Lett. 98, 128001
(2007). The spin of a disk is always across its velocity. V is without the mean flow of a sheared
gas.
"""

import numpy as np

from roughgas.data.variables import Variable
from roughgas.observables.frame import Frame
from roughgas.observables.plugin import Observable, Values

SPHERES = "spheres"

VARIABLES = {
    "a11": Variable("<V^2 w^2>/(<V^2> <w^2>) - 1 of velocities and spins"),
    "alignment": Variable("3 <(V.w)^2>/<V^2 w^2> - 1 of velocities and spins", when=(SPHERES,)),
    "cos2_angle": Variable("mean of cos^2 of the angle between V and w", when=(SPHERES,)),
}


class SpinCorrelation(Observable):
    """Correlation of velocities and spins, in magnitude and, for spheres, in direction."""

    spins = True
    alike = True
    variables = VARIABLES

    def look(self, frame: Frame) -> Values:
        """Return mixed moments."""
        V, w = frame.thermal_velocity, frame.thermal_spin
        V2, w2 = (V**2).sum(axis=1), (w**2).sum(axis=1)
        found = {"V2": V2.mean(), "w2": w2.mean(), "V2w2": (V2 * w2).mean()}
        if self.system.dimension == 3:
            square, both = (V * w).sum(axis=1) ** 2, V2 * w2
            angle = square[both > 0.0] / both[both > 0.0]
            found |= {"Vw": square.mean(), "angle": angle.mean() if angle.size else np.nan}
        return found

    def combine(self, means: Values) -> Values:
        """Return the correlations."""
        found = {"a11": means["V2w2"] / (means["V2"] * means["w2"]) - 1.0}
        if self.system.dimension == 3:
            found["alignment"] = 3.0 * means["Vw"] / means["V2w2"] - 1.0
            found["cos2_angle"] = means["angle"]
        return found
