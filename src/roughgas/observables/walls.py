"""Forces of the particles on floor and walls: momentum that they pass to a wall per time.

    F = (1/t) sum_contacts J,    p = -n.F/A,    tau = F/A - (n.F/A) n,    M = (1/t) sum_contacts L

for a wall with the normal n into the gas. In a contact the wall receives the momentum J, and the
spin of the particle loses the angular momentum L (effects/wall_impulses.py). A is the area, in the
plane the length, of the side of the box; below an open top, side walls have forces but no pressure.
All contacts of a measurement count.

In a steady state without a bath the mean forces on all walls add up to the weight of the gas.
Centres of particles stay at a distance a from walls: between walls at a distance H the pressure
tensor of the box (observable `stress`) is (H - 2 a)/H times pressure and shear stress on them.

Arrays (k, ...) are of the k instants of a FrameSeries.
"""

import math
from collections.abc import Mapping

import numpy as np

from roughgas.base import NeedsError
from roughgas.data.variables import ENERGY, SPIN, Variable
from roughgas.effects.wall_impulses import columns_of_walls
from roughgas.effects.walls import LOW, closed_sides
from roughgas.observables.averages import NamedArrays
from roughgas.observables.fields import PRESSURE
from roughgas.observables.frames import AXES, FrameSeries, System
from roughgas.observables.plugin import Observable, columnwise

FORCE, TORQUE = "wall_force", "wall_torque"
COMPONENTS = ("wall", "component")


class WallForces(Observable):
    """Force, pressure, shear stress and torque of the particles on floor and walls."""

    effects = ("wall_impulses",)
    variables: Mapping[str, Variable] = {
        "wall": Variable("floor or wall", "", ("wall",), "str"),
        "component": Variable("component of a vector", "", ("component",), "str"),
        "rotation_axis": Variable("axis of a rotation", "", ("rotation_axis",), "str"),
        FORCE: Variable("force on a wall", f"{ENERGY} a^-1", COMPONENTS),
        "wall_pressure": Variable(
            "force on a wall along its outer normal, over its area", PRESSURE, ("wall",)
        ),
        "wall_shear_stress": Variable(
            "force along a wall over its area, NaN along its normal", PRESSURE, COMPONENTS
        ),
        TORQUE: Variable(
            "angular momentum that spins lose to a wall per time",
            ENERGY,
            ("wall", "rotation_axis"),
            when=(SPIN,),
        ),
    }

    def __init__(self, system: System) -> None:
        """Store the walls of the system; raise NeedsError without any."""
        super().__init__(system)
        if not system.walls:
            raise NeedsError("observables.wall_forces", "a floor or walls")
        dimension, spinning = system.dimension, system.inertia is not None
        sides = closed_sides(system.walls, dimension).values()
        self._columns = columns_of_walls(system.walls, dimension, spinning)
        self._outer_normal = np.zeros((len(sides), dimension))
        for row, (axis, end) in enumerate(sides):
            self._outer_normal[row, axis] = -1.0 if end == LOW else 1.0
        self._area = np.array([_area(system, axis) for axis, _ in sides])
        self.coordinates = {"wall": [*system.walls], "component": system.axes}
        if spinning:
            self.coordinates["rotation_axis"] = [*AXES[6 - 2 * dimension :]]

    def observe_series(self, frames: FrameSeries) -> NamedArrays:
        """Return force and torque on each wall, means since the previous observation.

        Forces are in m a/T^2, (k, walls, D); torques in m a^2/T^2, (k, walls, 2 D - 3), where
        particles spin.
        """
        rates = np.stack([frames.rates[name] for name in self._columns], axis=-1)
        by_wall = rates.reshape(frames.instants, len(self._area), -1)
        force, torque = np.split(by_wall, [self.system.dimension], axis=-1)
        return {FORCE: force} if self.system.inertia is None else {FORCE: force, TORQUE: torque}

    @columnwise
    def combine(self, means: NamedArrays) -> NamedArrays:
        """Return mean forces and torques, and pressures (walls,) and shear stresses (walls, D)."""
        walls_last = np.moveaxis(means[FORCE], (0, 1), (-2, -1))
        stress = walls_last / self._area[:, None]
        pressure = (stress * self._outer_normal).sum(axis=-1)
        shear_stress = np.where(self._outer_normal == 0.0, stress, math.nan)
        return dict(means) | {
            "wall_pressure": np.moveaxis(pressure, -1, 0),
            "wall_shear_stress": np.moveaxis(shear_stress, (-2, -1), (0, 1)),
        }


def _area(system: System, axis: int) -> float:
    """Return the area of a side of the box normal to an axis, in a^(D-1); NaN if it is open."""
    lengths = [length for k, length in enumerate(system.box) if k != axis]
    return math.prod(math.nan if length is None else length for length in lengths)
