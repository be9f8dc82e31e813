"""What an observable looks at: the particles of a gas at an instant, as plain numpy arrays.

Units: particle radius a = particle mass m = time unit T = 1. A freely cooling gas has no lasting
energy: its velocities and spins are in units in which the present E_trans is 1.
"""

import math
from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

AXES = "xyz"


class System(NamedTuple):
    """What stays the same during a run."""

    particles: int  # N
    box: tuple[float | None, ...]  # lengths in a, D of them; None is open above
    periodic: tuple[bool, ...]  # of each axis
    inertia: float | None  # q = I/(m a^2); None where particles do not spin
    shear_rate: float  # 1/T: the mean flow is v_x = shear_rate (y - L/2)
    interval: float  # between looks, in T or in collisions per particle
    cooling: bool
    alike: bool = True  # all particles have radius a and mass m

    @property
    def dimension(self) -> int:
        """D, 2 of disks and 3 of spheres."""
        return len(self.box)

    @property
    def volume(self) -> float:
        """Area or volume of the box in a^D; infinite if it is open."""
        return math.prod(math.inf if length is None else length for length in self.box)

    @property
    def across(self) -> int:
        """The axis that layers are across, the vertical one; of a sheared gas that of the shear."""
        return 1 if self.shear_rate else self.dimension - 1

    @property
    def axes(self) -> list[str]:
        """The names of the axes, `x`, `y`, `z`."""
        return list(AXES[: self.dimension])


class Frame(NamedTuple):
    """The particles at an instant, in the order of the start."""

    system: System
    time: float  # T since the start
    collisions: float  # per particle, since the start or since the gas began to cool
    position: np.ndarray  # (N, D) in a, folded into the box
    velocity: np.ndarray  # (N, D) in a/T, of the images in the box
    spin: np.ndarray | None  # (N, 2 D - 3) surface velocities in a/T; None without spin
    radius: np.ndarray  # (N,) in a
    mass: np.ndarray  # (N,) in m
    inertia: np.ndarray  # (N,) q, I over mass and radius^2
    image_shift: float  # displacement along x of the image above, of a sheared gas; else 0
    rates: Mapping[str, float]  # what effects have summed up since the look before, per T
    species_of: np.ndarray | None = None  # (N,) index of each one's species; None: all are alike
    speed_unit: float = 1.0  # of the velocities, in a/T: not 1 in a cooling gas

    @property
    def thermal_velocity(self) -> np.ndarray:
        """Velocities (N, D) without the mean flow of a sheared gas."""
        rate, velocity = self.system.shear_rate, self.velocity
        if rate:
            velocity = velocity.copy()
            middle = (self.system.box[1] or 0.0) / 2.0
            velocity[:, 0] -= rate * (self.position[:, 1] - middle)
        return velocity

    @property
    def thermal_spin(self) -> np.ndarray:
        """Spins (N, 2 D - 3) without their mean in a sheared gas; zeros where nothing spins."""
        if self.spin is None:
            return np.zeros((self.system.particles, 2 * self.system.dimension - 3))
        if not self.system.shear_rate:
            return self.spin
        turning = (self.mass * self.inertia * self.radius)[:, None]
        rotation = (turning * self.spin).sum(axis=0) / (turning[:, 0] @ self.radius)
        return self.spin - self.radius[:, None] * rotation
