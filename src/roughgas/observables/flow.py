"""Energies over the local flow: what a gas has besides the mean flow that R leaves out.

A sheared gas is described without its mean flow, a straight line. A large one has flows of its own
besides, and their energy would pass for temperature. The local flow is the mean velocity, weighted
with the masses, of the particles in a cell; what remains of their velocities has D (n - 1) degrees
of freedom in a cell of n particles, so that the energy per degree of freedom is that of any other
gas in equilibrium, however small cells are. This is the idea of profile-unbiased thermostats (D. J.
Evans & G. P. Morriss, Phys. Rev. Lett. 56, 2172 (1986)).
"""

import math
from collections.abc import Mapping
from typing import ClassVar

import numpy as np

from roughgas.data.variables import ENERGY, SPIN, Variable
from roughgas.observables.plugin import Frame, Observable, Setting, System, Values, Whole

E_TRANS, RATIO, SHIFT = "E_trans_local", "R_local", "shift"
IN_CELL = 40
"""Particles in a cell: their mean velocity is a flow, and hardly the motion of single particles."""
IN_LAYER, LAYERS = 10, 16
"""Particles in a layer between walls at least, and the largest number of layers."""


class LocalFlow(Observable):
    """Energies over the local flow, which they leave out as well as the mean flow."""

    settings: ClassVar[Mapping[str, Setting]] = {
        "particles": Whole("Particles in a cell, on average.", 2, 1_000_000, IN_CELL)
    }
    variables: Mapping[str, Variable] = {
        E_TRANS: Variable("translational energy per degree of freedom over the local flow", ENERGY),
        RATIO: Variable("share of rotation in the energy over the local flow", when=(SPIN,)),
    }

    def __init__(self, system: System, particles: int = IN_CELL) -> None:
        super().__init__(system)
        self.cells = cells_of(system, particles)

    def look(self, frame: Frame) -> Values:
        """Return E_trans and R over the local flow, and by how much R exceeds that over the mean
        flow, `shift`: 0 on average in equilibrium, where no particle knows of its neighbours."""
        velocity = _without_gradient(frame)
        local = local_energy(frame, velocity, self.cells)
        if frame.spin is None:
            return {E_TRANS: np.array(local)}
        spin = frame.spin - _mean_spin(frame)
        rotational = 0.5 * np.sum(frame.mass * frame.inertia * (spin**2).sum(axis=1))
        rotational /= (self.system.particles - 1) * spin.shape[1]
        overall = local_energy(frame, velocity, (1,) * len(self.cells))
        ratio, over_mean = (rotational / (rotational + E_trans) for E_trans in (local, overall))
        values = {E_TRANS: local, RATIO: ratio, SHIFT: ratio - over_mean}
        return {name: np.array(value) for name, value in values.items()}

    def combine(self, means: Values) -> Values:
        """Return the energy, and R where particles spin."""
        return {name: means[name] for name in self.variables if name in means}


def cells_of(system: System, particles: int) -> tuple[int, ...]:
    """Return the number of cells along each axis, cubes with so many particles on average.

    Between walls across the second axis there are layers along it: their flow varies across.
    """
    if system.dimension == 2 and not system.periodic[1]:
        return 1, max(1, min(LAYERS, system.particles // min(IN_LAYER, particles)))
    sides = np.array([math.nan if side is None else side for side in system.box])
    if np.isnan(sides).any():
        return (1,) * system.dimension
    width = (np.prod(sides) * particles / system.particles) ** (1.0 / system.dimension)
    return tuple(int(max(1, round(cells))) for cells in sides / width)


def local_energy(frame: Frame, velocity: np.ndarray, cells: tuple[int, ...]) -> float:
    """Return the translational energy per degree of freedom over the flow in cells.

    `velocity` (N, D) is that over the mean flow. NaN where no two particles share a cell.
    """
    number = _cell_numbers(frame, cells)
    counts = np.bincount(number, minlength=math.prod(cells))
    masses = np.bincount(number, frame.mass, minlength=len(counts))
    energy = 0.0
    for component in velocity.T:
        momenta = np.bincount(number, frame.mass * component, minlength=len(counts))
        flow = np.divide(momenta, masses, out=np.zeros(len(counts)), where=masses > 0.0)
        energy += 0.5 * np.sum(frame.mass * (component - flow[number]) ** 2)
    freedom = velocity.shape[1] * np.sum(np.maximum(counts - 1, 0))
    return float(energy / freedom) if freedom else math.nan


def _cell_numbers(frame, cells):
    """Return the number of the cell that each particle is in, (N,)."""
    number = np.zeros(len(frame.position), int)
    for axis, (side, count) in enumerate(zip(frame.system.box, cells, strict=True)):
        reach = frame.position[:, axis].max() + 1.0 if side is None else side
        at = (frame.position[:, axis] / reach * count).astype(int)
        number = number * count + np.clip(at, 0, count - 1)
    return number


def _without_gradient(frame):
    """Return velocities over the mean flow: between walls that close the second axis, over the
    straight line that fits v_x best, as E_trans is."""
    if frame.system.shear_rate or frame.system.periodic[1]:
        return frame.thermal_velocity
    velocity, height = frame.velocity.copy(), frame.position[:, 1]
    height = height - np.average(height, weights=frame.mass)
    spread = np.sum(frame.mass * height**2)
    if spread > 0.0:
        velocity[:, 0] -= np.sum(frame.mass * height * velocity[:, 0]) / spread * height
    return velocity


def _mean_spin(frame):
    """Return the mean spin, the surface velocity of a particle that turns with the others."""
    turning = frame.mass * frame.inertia * frame.radius
    rotation = (turning[:, None] * frame.spin).sum(axis=0) / np.sum(turning * frame.radius)
    return frame.radius[:, None] * rotation
