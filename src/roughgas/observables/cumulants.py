"""Cumulants: how far the distributions of velocities and of spins are from Gaussian ones.

    a20 = D <V^4>/[(D + 2) <V^2>^2] - 1,    a02 = n <w^4>/[(n + 2) <w^2>^2] - 1,  n = 2 D - 3,

the coefficients of the first Sonine polynomials; V is the velocity without the mean flow of a
sheared gas, w the spin. They vanish in equilibrium. A. Santos, G. M. Kremer & M. dos Santos, Phys.
Fluids 23, 030604 (2011). Averages are over all particles and looks. In a cooling gas, whose E_trans
each look takes for 1, a20 is too small by 2/(D N).
"""

from roughgas.data.variables import SPIN, Variable
from roughgas.observables.frame import Frame
from roughgas.observables.plugin import Observable, Values

VARIABLES = {
    "a20": Variable("cumulant D <V^4>/[(D + 2) <V^2>^2] - 1 of velocities"),
    "a02": Variable("cumulant n <w^4>/[(n + 2) <w^2>^2] - 1 of spins", when=(SPIN,)),
}


class Cumulants(Observable):
    """Fourth cumulants of velocities and of spins."""

    alike = True
    variables = VARIABLES

    def look(self, frame: Frame) -> Values:
        """Return second and fourth moments."""
        V2 = (frame.thermal_velocity**2).sum(axis=1)
        w2 = (frame.thermal_spin**2).sum(axis=1)
        moments = {"V2": V2, "V4": V2**2, "w2": w2, "w4": w2**2}
        return {name: values.mean() for name, values in moments.items()}

    def combine(self, means: Values) -> Values:
        """Return the cumulants."""
        D = self.system.dimension
        found = {"a20": _cumulant(means["V2"], means["V4"], D)}
        if self.system.inertia is not None:
            found["a02"] = _cumulant(means["w2"], means["w4"], 2 * D - 3)
        return found


def _cumulant(second, fourth, components):
    return components * fourth / ((components + 2) * second**2) - 1.0
