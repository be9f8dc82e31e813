"""Energies over the local flow of a gas, beside the mean flow that R leaves out.

A sheared gas is described without its mean flow, a straight line. A large gas has further
flows, whose energy passes for temperature. The local flow is the mean velocity, weighted
with the masses, of the particles in a cell; what remains of their velocities has D (n - 1) degrees
of freedom in a cell of n particles, so that the energy per degree of freedom does not depend on the
size of cells in equilibrium. This is the idea of profile-unbiased thermostats (D. J.
Evans & G. P. Morriss, Phys. Rev. Lett. 56, 2172 (1986)).
"""

import math
from collections.abc import Mapping
from typing import ClassVar, NamedTuple

import numpy as np

from roughgas.data.variables import ENERGY, SPIN, Variable
from roughgas.observables.plugin import Frame, Observable, Setting, System, Values, Whole

E_TRANS, RATIO = "E_trans_local", "R_local"
IN_CELL = 40
"""Particles in a cell: their mean velocity is a flow, and hardly the motion of single particles."""
IN_LAYER, LAYERS = 10, 16
"""Particles in a layer between walls at least, and the largest number of layers."""


class Motion(NamedTuple):
    """Particles at an instant, in any order, in units of a, m and T."""

    position: np.ndarray  # (N, D)
    velocity: np.ndarray  # (N, D)
    spin: np.ndarray | None  # (N, 2 D - 3)
    mass: np.ndarray  # (N,), as the next two
    inertia: np.ndarray  # q
    radius: np.ndarray


class OverFlow(NamedTuple):
    """Energies of a gas over its local flow."""

    E_trans: float  # NaN where no two particles share a cell
    R: float  # NaN without spin
    shift: float  # R, less R over the mean flow: 0 on average in equilibrium


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
        """Return E_trans and R over the local flow."""
        bodies = frame.mass, frame.inertia, frame.radius
        motion = Motion(frame.position, frame.velocity, frame.spin, *bodies)
        over = over_flow(motion, self.system, self.cells)
        return {E_TRANS: np.array(over.E_trans), RATIO: np.array(over.R)}

    def combine(self, means: Values) -> Values:
        """Return the energy, and R where particles spin."""
        return means if self.system.inertia is not None else {E_TRANS: means[E_TRANS]}


def cells_of(system: System, particles: int) -> tuple[int, ...]:
    """Return the number of cells along each axis: cubes with `particles` on average.

    Between walls across the second axis there are layers along it: their flow varies across.
    """
    if system.dimension == 2 and not system.periodic[1]:
        return 1, max(1, min(LAYERS, system.particles // min(IN_LAYER, particles)))
    sides = np.array([math.nan if side is None else side for side in system.box])
    if np.isnan(sides).any():
        return (1,) * system.dimension
    width = (np.prod(sides) * particles / system.particles) ** (1.0 / system.dimension)
    return tuple(int(max(1, round(cells))) for cells in sides / width)


def over_flow(motion: Motion, system: System, cells: tuple[int, ...]) -> OverFlow:
    """Return the energies over the flow in cells."""
    velocity = _over_mean_flow(motion, system)
    local, overall = local_energies(motion, velocity, _cell_numbers(motion, system, cells))
    if motion.spin is None:
        return OverFlow(local, math.nan, math.nan)
    rotational = _rotational_energy(motion, motion.spin)
    ratio, over_mean = (rotational / (rotational + E_trans) for E_trans in (local, overall))
    return OverFlow(local, ratio, ratio - over_mean)


def local_energies(motion: Motion, velocity: np.ndarray, cell: np.ndarray) -> tuple[float, float]:
    """Return the translational energy per degree of freedom over the flow in cells, and over the
    mean velocity of all particles.

    `velocity` (N, D) is that over the mean flow, `cell` (N,) the number of each particle's cell.
    The first energy is NaN where no two particles share a cell.
    """
    mass, (number, dimension) = motion.mass, velocity.shape
    total = mass @ (velocity * velocity).sum(axis=1)
    counts, masses = np.bincount(cell), np.bincount(cell, mass)
    shared = np.where(masses > 0.0, masses, 1.0)
    momenta = [np.bincount(cell, mass * component) for component in velocity.T]
    flows = sum(momentum @ (momentum / shared) for momentum in momenta)
    mean = sum(momentum.sum() ** 2 for momentum in momenta) / masses.sum()
    freedom = number - np.count_nonzero(counts)
    local = 0.5 * (total - flows) / (dimension * freedom) if freedom else math.nan
    return float(local), float(0.5 * (total - mean) / (dimension * (number - 1)))


def _cell_numbers(motion, system, cells):
    """Return the number of the cell that each particle is in, (N,)."""
    number = 0
    for axis, (side, count) in enumerate(zip(system.box, cells, strict=True)):
        if count > 1:
            position = motion.position[:, axis]
            reach = position.max() + 1.0 if side is None else side
            at = np.minimum((position * (count / reach)).astype(int), count - 1)
            number = number * count + np.maximum(at, 0)
    return np.zeros(len(motion.mass), int) if isinstance(number, int) else number


def _over_mean_flow(motion, system):
    """Return velocities over the mean flow: between walls that close the second axis, over the
    straight line that fits v_x best, as E_trans is."""
    height, rate = motion.position[:, 1], system.shear_rate
    if not rate and system.periodic[1]:
        return motion.velocity
    velocity = motion.velocity.copy()
    if rate:
        velocity[:, 0] -= rate * (height - system.box[1] / 2.0)
        return velocity
    height = height - motion.mass @ height / motion.mass.sum()
    spread = motion.mass @ height**2
    if spread > 0.0:
        velocity[:, 0] -= (motion.mass * height) @ velocity[:, 0] / spread * height
    return velocity


def _rotational_energy(motion, spin):
    """Return the rotational energy per degree of freedom over the mean spin, which is the surface
    velocity of a particle that turns with the others."""
    turning, radius = motion.mass * motion.inertia, motion.radius
    rotation = (turning * radius) @ spin / (turning @ radius**2)
    square = ((spin - radius[:, None] * rotation) ** 2).sum(axis=1)
    return float(0.5 * (turning @ square) / ((len(spin) - 1) * spin.shape[1]))
