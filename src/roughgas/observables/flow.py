"""Energies relative to the local flow of a gas; R is relative to its mean flow only.

R = E_rot/(E_rot + E_trans) is the share of rotational energy per degree of freedom. The mean flow
of a sheared gas, a linear profile, is subtracted from velocities. A large gas has further flows,
whose energy counts as temperature. The local flow is the mean velocity, weighted with the masses,
of the particles in a cell. Velocities relative to it have D (n - 1) degrees of freedom in a cell of
n particles, so that the energy per degree of freedom does not depend on the size of cells in
equilibrium. This is the idea of profile-unbiased thermostats (D. J. Evans & G. P. Morriss, Phys.
Rev. Lett. 56, 2172 (1986)).

Arrays (k, ...) are of the k instants of a FrameSeries.
"""

import math
from collections.abc import Mapping, Sequence
from typing import Annotated, NamedTuple

import numpy as np

from roughgas.base.fields import whole
from roughgas.data.variables import ENERGY, SPIN, Variable
from roughgas.observables.averages import NamedArrays
from roughgas.observables.frames import FrameSeries, System
from roughgas.observables.plugin import Observable, ObservableSettings, columnwise

E_TRANS, RATIO = "E_trans_local", "R_local"
PARTICLES_PER_CELL = 40
"""Mean number of particles in a cell, which averages out most of their thermal motion."""
MINIMUM_PER_LAYER, MAXIMUM_LAYERS = 10, 16
"""Smallest number of particles in a layer between walls, and largest number of layers."""


class ParticleMotion(NamedTuple):
    """Particles of a gas at an instant, in any order, in units of a, m and T.

    At several instants each array has a further first axis (instants,).
    """

    position: np.ndarray  # (N, D)
    velocity: np.ndarray  # (N, D)
    spin: np.ndarray | None  # (N, 2 D - 3)
    mass: np.ndarray  # (N,), as inertia and radius
    inertia: np.ndarray  # q
    radius: np.ndarray


class FlowCorrectedEnergies(NamedTuple):
    """Energies of a gas per degree of freedom relative to its local flow, (instants,) each."""

    E_trans: np.ndarray  # NaN where no two particles share a cell
    R: np.ndarray  # NaN without spin
    shift: np.ndarray  # R less R relative to the mean flow: 0 on average in equilibrium


class LocalFlowSettings(ObservableSettings, frozen=True, kw_only=True):
    """Settings of `local_flow`."""

    particles: Annotated[int, whole(2, 1_000_000, "Particles in a cell, on average.")] = (
        PARTICLES_PER_CELL
    )


class LocalFlow(Observable):
    """Energies over the local flow, which they leave out as well as the mean flow."""

    settings = LocalFlowSettings
    variables: Mapping[str, Variable] = {
        E_TRANS: Variable("translational energy per degree of freedom over the local flow", ENERGY),
        RATIO: Variable("share of rotation in the energy over the local flow", when=(SPIN,)),
    }

    def __init__(self, system: System, particles: int = PARTICLES_PER_CELL) -> None:
        """Divide the box into cells of `particles` on average."""
        super().__init__(system)
        self.cells = cell_counts(system, particles)

    def observe_series(self, frames: FrameSeries) -> NamedArrays:
        """Return E_trans and the share R of rotation relative to the local flow, (k,) each."""
        shape = frames.instants, 1
        properties = (
            np.tile(values, shape) for values in (frames.mass, frames.inertia, frames.radius)
        )
        spin = frames.thermal_spin if self.system.rotates else frames.spin
        motion = ParticleMotion(frames.position, frames.velocity, spin, *properties)
        energies = flow_corrected_energies_of(motion, self.system, self.cells)
        return {E_TRANS: energies.E_trans, RATIO: energies.R}

    @columnwise
    def combine(self, means: NamedArrays) -> NamedArrays:
        """Return the mean energy, and the mean of R where particles spin."""
        return means if self.system.inertia is not None else {E_TRANS: means[E_TRANS]}


def cell_counts(system: System, particles: int) -> tuple[int, ...]:
    """Return the number of cells along each axis, for cubes with `particles` particles on average.

    Between walls at the ends of the second axis, cells are layers, as the flow varies along it.
    """
    if system.dimension == 2 and not system.periodic[1]:
        return 1, max(1, min(MAXIMUM_LAYERS, system.particles // min(MINIMUM_PER_LAYER, particles)))
    sides = np.array([math.nan if side is None else side for side in system.box])
    if np.isnan(sides).any():
        return (1,) * system.dimension
    width = (np.prod(sides) * particles / system.particles) ** (1.0 / system.dimension)
    return tuple(int(max(1, round(cells))) for cells in sides / width)


def flow_corrected_energies(
    motions: Sequence[ParticleMotion], system: System, cells: tuple[int, ...]
) -> FlowCorrectedEnergies:
    """Return the energies relative to the flow in cells, at several instants at once (faster).

    `motions` has the particles at each instant; other arguments as in `flow_corrected_energies_of`.
    """
    return flow_corrected_energies_of(_stacked(motions), system, cells)


def flow_corrected_energies_of(
    motion: ParticleMotion, system: System, cells: tuple[int, ...]
) -> FlowCorrectedEnergies:
    """Return energies per degree of freedom relative to the local flow in cells, (instants,) each.

    `motion` has arrays (instants, N, ...), `system` the box and the shear rate, `cells` the number
    of cells along each axis. E_trans is in m a^2/T^2; R is the rotational share of E_rot + E_trans.
    Spins are relative to their mean.
    """
    velocity = _without_mean_flow(motion, system)
    numbers = _cell_indices(motion.position, system, cells)
    local, overall = local_energies(motion.mass, velocity, numbers, math.prod(cells))
    if motion.spin is None:
        undefined = np.full(len(velocity), math.nan)
        return FlowCorrectedEnergies(local, undefined, undefined)
    rotational = _rotational_energy(motion)
    ratio, mean_flow_ratio = (rotational / (rotational + E_trans) for E_trans in (local, overall))
    return FlowCorrectedEnergies(local, ratio, ratio - mean_flow_ratio)


def _stacked(motions):
    """Return the motions of several instants as a motion of arrays (instants, N, ...)."""
    columns = zip(*motions, strict=True)
    return ParticleMotion(*(None if column[0] is None else np.stack(column) for column in columns))


def local_energies(
    mass: np.ndarray, velocity: np.ndarray, cell: np.ndarray, cells: int
) -> tuple[np.ndarray, np.ndarray]:
    """Return two translational energies per degree of freedom, (instants,) each, in m a^2/T^2.

    The first energy is relative to the flow in cells, the second to the mean velocity of all
    particles. `mass` (instants, N), `velocity` (instants, N, D) relative to the mean flow; `cell`
    (instants, N) is the index of the cell of each particle, below the number of cells `cells`. The
    first energy is NaN where no two particles share a cell.
    """
    instants, number, dimension = velocity.shape
    bins = (cell + cells * np.arange(instants)[:, None]).ravel()

    def cell_sums(values):
        """Return sums of `values` (instants, N) over each cell, (instants, cells)."""
        sums = np.bincount(bins, values.ravel(), instants * cells)
        return sums.reshape(instants, cells)

    masses = cell_sums(mass)
    shared = np.where(masses > 0.0, masses, 1.0)
    total_energy, flow_energy, mean_flow_energy = np.zeros((3, instants))
    for component in np.moveaxis(velocity, -1, 0):
        momentum = mass * component
        total_energy += (momentum * component).sum(axis=1)
        cell_momenta = cell_sums(momentum)
        flow_energy += (cell_momenta**2 / shared).sum(axis=1)
        mean_flow_energy += cell_momenta.sum(axis=1) ** 2 / mass.sum(axis=1)
    degrees_of_freedom = number - np.count_nonzero(masses, axis=1)
    local = np.where(degrees_of_freedom > 0, total_energy - flow_energy, math.nan) / np.maximum(
        degrees_of_freedom, 1
    )
    overall = (total_energy - mean_flow_energy) / (number - 1)
    return 0.5 * local / dimension, 0.5 * overall / dimension


def _cell_indices(position, system, cells):
    """Return the index of the cell of each particle, (instants, N).

    `position` (instants, N, D) is in particle radii a, `cells` has the number of cells along each
    axis.
    """
    numbers = np.zeros(position.shape[:2], int)
    for axis, (side, count) in enumerate(zip(system.box, cells, strict=True)):
        if count > 1:
            coordinate = position[..., axis]
            length = coordinate.max(axis=1, keepdims=True) + 1.0 if side is None else side
            index = np.minimum((coordinate * (count / length)).astype(int), count - 1)
            numbers = numbers * count + np.maximum(index, 0)
    return numbers


def _without_mean_flow(motion, system):
    """Return velocities of a `motion` relative to the mean flow, (instants, N, D).

    Between walls at the ends of the second axis, the mean flow is a linear fit to v_x, as for
    E_trans.
    """
    height, rate = motion.position[..., 1], system.shear_rate
    if not rate and system.periodic[1]:
        return motion.velocity
    velocity = motion.velocity.copy()
    if rate:
        velocity[..., 0] -= rate * (height - system.box[1] / 2.0)
        return velocity
    mass = motion.mass
    height = height - _particle_sum(mass * height) / _particle_sum(mass)
    spread = _particle_sum(mass * height**2)
    slope = _particle_sum(mass * height * velocity[..., 0]) / np.where(spread > 0.0, spread, 1.0)
    velocity[..., 0] -= slope * height
    return velocity


def _particle_sum(values):
    """Return sums of `values` (instants, N) over particles, (instants, 1)."""
    return values.sum(axis=1, keepdims=True)


def _rotational_energy(motion):
    """Return the rotational energy per degree of freedom relative to the mean spin, (instants,).

    The mean spin is the surface velocity of a particle with the mean angular velocity.
    """
    spin_mass, radius = motion.mass * motion.inertia, motion.radius
    number, axes = motion.spin.shape[1:]
    energy = np.zeros(len(motion.spin))
    for spin in np.moveaxis(motion.spin, -1, 0):
        rotation = _particle_sum(spin_mass * radius * spin) / _particle_sum(spin_mass * radius**2)
        energy += (spin_mass * (spin - radius * rotation) ** 2).sum(axis=1)
    return 0.5 * energy / ((number - 1) * axes)
