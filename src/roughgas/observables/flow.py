"""Energies over the local flow of a gas, beside the mean flow that R leaves out.

A sheared gas is described without its mean flow, a straight line. A large gas has further
flows, whose energy passes for temperature. The local flow is the mean velocity, weighted
with the masses, of the particles in a cell; what remains of their velocities has D (n - 1) degrees
of freedom in a cell of n particles, so that the energy per degree of freedom does not depend on the
size of cells in equilibrium. This is the idea of profile-unbiased thermostats (D. J.
Evans & G. P. Morriss, Phys. Rev. Lett. 56, 2172 (1986)).
"""

import math
from collections.abc import Mapping, Sequence
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
    """Energies of a gas over its local flow, (instants,) each."""

    E_trans: np.ndarray  # NaN where no two particles share a cell
    R: np.ndarray  # NaN without spin
    shift: np.ndarray  # R, less R over the mean flow: 0 on average in equilibrium


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
        over = over_flow([motion], self.system, self.cells)
        return {E_TRANS: over.E_trans[0], RATIO: over.R[0]}

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


def over_flow(motions: Sequence[Motion], system: System, cells: tuple[int, ...]) -> OverFlow:
    """Return the energies over the flow in cells, at several instants: together they cost less."""
    together = _stacked(motions)
    velocity = _over_mean_flow(together, system)
    numbers = _cell_numbers(together.position, system, cells)
    local, overall = local_energies(together.mass, velocity, numbers, math.prod(cells))
    if together.spin is None:
        unknown = np.full(len(motions), math.nan)
        return OverFlow(local, unknown, unknown)
    rotational = _rotational_energy(together)
    ratio, over_mean = (rotational / (rotational + E_trans) for E_trans in (local, overall))
    return OverFlow(local, ratio, ratio - over_mean)


def _stacked(motions):
    """Return the motions of several instants as arrays (instants, N, ...)."""
    columns = zip(*motions, strict=True)
    return Motion(*(None if column[0] is None else np.stack(column) for column in columns))


def local_energies(
    mass: np.ndarray, velocity: np.ndarray, cell: np.ndarray, cells: int
) -> tuple[np.ndarray, np.ndarray]:
    """Return translational energies per degree of freedom, (instants,) each: over the flow in
    cells, and over the mean velocity of all particles.

    `mass` (instants, N), `velocity` (instants, N, D) over the mean flow; `cell` (instants, N) is
    the number of each particle's cell, below `cells`. The first energy is NaN where no two
    particles share a cell.
    """
    instants, number, dimension = velocity.shape
    bins = (cell + cells * np.arange(instants)[:, None]).ravel()

    def in_cells(values):
        sums = np.bincount(bins, values.ravel(), instants * cells)
        return sums.reshape(instants, cells)

    masses = in_cells(mass)
    shared = np.where(masses > 0.0, masses, 1.0)
    total, flows, mean = np.zeros((3, instants))
    for component in np.moveaxis(velocity, -1, 0):
        momentum = mass * component
        total += (momentum * component).sum(axis=1)
        in_each = in_cells(momentum)
        flows += (in_each**2 / shared).sum(axis=1)
        mean += in_each.sum(axis=1) ** 2 / mass.sum(axis=1)
    freedom = number - np.count_nonzero(masses, axis=1)
    local = np.where(freedom > 0, total - flows, math.nan) / np.maximum(freedom, 1)
    overall = (total - mean) / (number - 1)
    return 0.5 * local / dimension, 0.5 * overall / dimension


def _cell_numbers(position, system, cells):
    """Return the number of the cell that each particle is in, (instants, N)."""
    numbers = np.zeros(position.shape[:2], int)
    for axis, (side, count) in enumerate(zip(system.box, cells, strict=True)):
        if count > 1:
            along = position[..., axis]
            reach = along.max(axis=1, keepdims=True) + 1.0 if side is None else side
            at = np.minimum((along * (count / reach)).astype(int), count - 1)
            numbers = numbers * count + np.maximum(at, 0)
    return numbers


def _over_mean_flow(motion, system):
    """Return velocities over the mean flow: between walls that close the second axis, over the
    straight line that fits v_x best, as E_trans is."""
    height, rate = motion.position[..., 1], system.shear_rate
    if not rate and system.periodic[1]:
        return motion.velocity
    velocity = motion.velocity.copy()
    if rate:
        velocity[..., 0] -= rate * (height - system.box[1] / 2.0)
        return velocity
    mass = motion.mass
    height = height - _sum(mass * height) / _sum(mass)
    spread = _sum(mass * height**2)
    slope = _sum(mass * height * velocity[..., 0]) / np.where(spread > 0.0, spread, 1.0)
    velocity[..., 0] -= slope * height
    return velocity


def _sum(values):
    """Return sums over particles, (instants, 1)."""
    return values.sum(axis=1, keepdims=True)


def _rotational_energy(motion):
    """Return the rotational energy per degree of freedom over the mean spin, (instants,).

    The mean spin is the surface velocity of a particle that turns with the others.
    """
    turning, radius = motion.mass * motion.inertia, motion.radius
    number, axes = motion.spin.shape[1:]
    energy = np.zeros(len(motion.spin))
    for spin in np.moveaxis(motion.spin, -1, 0):
        rotation = _sum(turning * radius * spin) / _sum(turning * radius**2)
        energy += (turning * (spin - radius * rotation) ** 2).sum(axis=1)
    return 0.5 * energy / ((number - 1) * axes)
