"""Frames: the particles of a gas at an instant, or at several, as plain numpy arrays.

Units: particle radius a = particle mass m = time unit T = 1. As a freely cooling gas has no
constant energy, its velocities and spins have units that make the present E_trans 1.
"""

import math
from collections.abc import Iterable, Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np

from roughgas.base import NeedsError
from roughgas.effects.contacts import columns_of_pairs

AXES = "xyz"


class SpeciesGroup(NamedTuple):
    """Number of particles of a species, and their radius."""

    particles: int
    radius: float  # in a; NaN where their radii differ


class System(NamedTuple):
    """Constants of a run: particles, box, shear, and sampling."""

    particles: int  # N
    box: tuple[float | None, ...]  # lengths in a, D of them; None is open above
    periodic: tuple[bool, ...]  # of each axis
    inertia: float | None  # q = I/(m a^2); None where particles do not spin
    shear_rate: float  # 1/T: the mean flow is v_x = shear_rate (y - L/2)
    interval: float  # between observations, in T or in collisions per particle
    cooling: bool
    species: tuple[SpeciesGroup, ...] = ()  # empty if all particles have radius a and mass m
    period: float | None = None  # of the schedule, in T: a multiple of the period of the drive
    walls: tuple[str, ...] = ()  # names, as in effects.walls.closed_sides
    rotates: bool = False  # whether a bath leads spins to the angular velocity of its medium

    def only(self, *species: int) -> "System":
        """Return the system with the particles of some `species` only, given by index."""
        groups = tuple(self.species[k] for k in sorted({*species}))
        return self._replace(particles=sum(group.particles for group in groups), species=groups)

    @property
    def dimension(self) -> int:
        """Number of dimensions D: 2 for disks, 3 for spheres."""
        return len(self.box)

    @property
    def volume(self) -> float:
        """Area or volume of the box in units of a^D; infinite if the box is open."""
        return math.prod(math.inf if length is None else length for length in self.box)

    @property
    def layer_axis(self) -> int:
        """Index of the axis normal to layers: vertical, or along the gradient of a sheared gas."""
        return 1 if self.shear_rate else self.dimension - 1

    @property
    def axes(self) -> list[str]:
        """Names of the axes, `x`, `y`, `z`."""
        return list(AXES[: self.dimension])


CHANGING_PARTICLE_FIELDS = ("position", "velocity", "spin", "unwrapped_position", "angle")
"""Fields of a frame with an entry for each particle that changes with time."""
PARTICLE_FIELDS = (*CHANGING_PARTICLE_FIELDS, "radius", "mass", "inertia", "species_of")
"""Fields of a frame with an entry for each particle."""
SCALAR_FIELDS = ("time", "collisions", "image_shift", "speed_unit", "floor")
"""Fields of a frame that are a single number."""


class Frame(NamedTuple):
    """The particles of a gas at an instant, in their initial order."""

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
    rates: Mapping[str, float]  # sums by effects since the previous observation, per T
    species_of: np.ndarray | None = None  # (N,) index of the species; None: all particles are alike
    speed_unit: float = 1.0  # of the velocities, in a/T: not 1 in a cooling gas
    floor: float = 0.0  # height of a shaken floor, in a
    unwrapped_position: np.ndarray | None = None  # (N, D) in a, along continuous paths, NaN along
    # the flow of a sheared gas; None without the effect `paths`
    angle: np.ndarray | None = None  # (N,) angle of disks in rad; None without `paths`

    def only(self, *species: int) -> "Frame":
        """Return the frame of the particles of some `species`, given by index, without `rates`.

        Raises NeedsError where all particles are alike.
        """
        return _selected_species(self, species)

    def by_species(self) -> list["Frame"]:
        """Return the frame of each species, without `rates`."""
        return [self.only(index) for index in range(len(self.system.species))]

    def pair_rates(self, names: Iterable[str]) -> np.ndarray:
        """Return sums over contacts of each pair of species, per T: (species, species, names).

        `names` are names of sums by effects, keys of `rates`. A contact of different species counts
        half for (k, l) and half for (l, k), so that the sum over all pairs is the total. Shape (1,
        1, names) without species.
        """
        return _pair_rates(self, names)

    @property
    def energy(self) -> np.ndarray:
        """Kinetic energies (N,) in m a^2/T^2: m v^2/2 plus m q a^2 w^2/2 without the mean spin.

        In a cooling gas the unit of velocities is `speed_unit`.
        """
        return _kinetic_energies(self)

    @property
    def thermal_velocity(self) -> np.ndarray:
        """Velocities (N, D) in a/T without the mean flow of a sheared gas."""
        return _thermal_velocity(self)

    @property
    def thermal_spin(self) -> np.ndarray:
        """Surface velocities (N, 2 D - 3) without the mean spin of shear or of a bath.

        They are in a/T; zeros where nothing spins.
        """
        return _thermal_spin(self)


class FrameSeries(NamedTuple):
    """The particles of a gas at k instants, in their initial order: k frames as arrays."""

    system: System
    time: np.ndarray  # (k,)
    collisions: np.ndarray  # (k,)
    position: np.ndarray  # (k, N, D)
    velocity: np.ndarray  # (k, N, D)
    spin: np.ndarray | None  # (k, N, 2 D - 3)
    radius: np.ndarray  # (N,), as mass and inertia: they are constant
    mass: np.ndarray
    inertia: np.ndarray
    image_shift: np.ndarray  # (k,)
    rates: Mapping[str, np.ndarray]  # (k,) each
    species_of: np.ndarray | None  # (N,)
    speed_unit: np.ndarray  # (k,)
    floor: np.ndarray  # (k,)
    unwrapped_position: np.ndarray | None  # (k, N, D)
    angle: np.ndarray | None  # (k, N)

    @classmethod
    def of(cls, frames: Sequence[Frame]) -> "FrameSeries":
        """Return the series of `frames`, one or more, of a gas."""
        first, columns = frames[0], dict(zip(Frame._fields, zip(*frames, strict=True), strict=True))
        arrays = {
            name: np.array(columns[name])
            for name in (*SCALAR_FIELDS, *CHANGING_PARTICLE_FIELDS)
            if getattr(first, name) is not None
        }
        rates = {name: np.array([frame.rates[name] for frame in frames]) for name in first.rates}
        return cls(**first._asdict() | arrays | {"rates": rates})

    @property
    def instants(self) -> int:
        """Number k of instants."""
        return len(self.time)

    def frame(self, number: int) -> Frame:
        """Return the frame of an instant, whose `number` counts from 0; its arrays are views."""
        fields = self._asdict()
        scalars = {name: float(fields[name][number]) for name in SCALAR_FIELDS}
        rates = {name: float(rate[number]) for name, rate in self.rates.items()}
        arrays = {
            name: fields[name][number]
            for name in CHANGING_PARTICLE_FIELDS
            if fields[name] is not None
        }
        return Frame(**fields | scalars | arrays | {"rates": rates})

    def only(self, *species: int) -> "FrameSeries":
        """Return the frames of the particles of some `species`, given by index, without `rates`.

        Raises NeedsError where all particles are alike.
        """
        return _selected_species(self, species)

    def by_species(self) -> list["FrameSeries"]:
        """Return the frames of each species, without `rates`."""
        return [self.only(index) for index in range(len(self.system.species))]

    def pair_rates(self, names: Iterable[str]) -> np.ndarray:
        """Return sums over contacts per T, (k, species, species, names): see Frame.pair_rates."""
        return _pair_rates(self, names)

    @property
    def energy(self) -> np.ndarray:
        """Kinetic energies (k, N) at each instant, as in Frame.energy."""
        return _kinetic_energies(self)

    @property
    def thermal_velocity(self) -> np.ndarray:
        """Velocities (k, N, D) in a/T without the mean flow of a sheared gas."""
        return _thermal_velocity(self)

    @property
    def thermal_spin(self) -> np.ndarray:
        """Surface velocities (k, N, 2 D - 3) without the mean spin of shear or of a bath.

        They are in a/T; zeros where nothing spins.
        """
        return _thermal_spin(self)


def _selected_species(frames: Any, species: Sequence[int]) -> Any:
    """Return `frames` with the particles of some `species`, given by index, without `rates`.

    `frames` is a Frame or a FrameSeries. Raises NeedsError where all particles are alike.
    """
    if frames.species_of is None:
        raise NeedsError("Frame.only", "species")
    selected, fields = np.isin(frames.species_of, species), frames._asdict()
    axis = {name: fields["position"].ndim - 2 for name in CHANGING_PARTICLE_FIELDS}
    particle_fields = {
        name: np.compress(selected, fields[name], axis.get(name, 0))  # preserves the order of axes
        for name in PARTICLE_FIELDS
        if fields[name] is not None
    }
    return frames._replace(system=frames.system.only(*species), rates={}, **particle_fields)


def _pair_rates(frames: Frame | FrameSeries, names: Iterable[str]) -> np.ndarray:
    """Return sums over contacts per T of each pair of species, see Frame.pair_rates."""
    species, names = max(1, len(frames.system.species)), [*names]
    sums = np.stack([frames.rates[name] for name in columns_of_pairs(names, species)], axis=-1)
    ordered = sums.reshape(*sums.shape[:-1], species, species, len(names))
    return (ordered + ordered.swapaxes(-3, -2)) / 2.0


def _kinetic_energies(frames: Frame | FrameSeries) -> np.ndarray:
    """Return the kinetic energy of each particle, (N,) or (k, N), see Frame.energy."""
    square = (frames.velocity**2).sum(axis=-1)
    spin_square = (frames.thermal_spin**2).sum(axis=-1)
    return 0.5 * (frames.mass * square + frames.mass * frames.inertia * spin_square)


def _thermal_velocity(frames: Frame | FrameSeries) -> np.ndarray:
    """Return velocities without the mean flow of a sheared gas, (N, D) or (k, N, D)."""
    rate, velocity = frames.system.shear_rate, frames.velocity
    if rate:
        velocity = velocity.copy()
        middle = (frames.system.box[1] or 0.0) / 2.0
        velocity[..., 0] -= rate * (frames.position[..., 1] - middle)
    return velocity


def _thermal_spin(frames: Frame | FrameSeries) -> np.ndarray:
    """Return spins without their mean, as `frames` has them; zeros without spin.

    The mean is over a sheared gas, or over each species in a bath whose medium rotates; other spins
    are returned as they are.
    """
    if frames.spin is None:
        return np.zeros((*frames.position.shape[:-1], 2 * frames.system.dimension - 3))
    if frames.system.rotates and frames.species_of is not None:
        thermal = np.empty_like(frames.spin)
        for index in np.unique(frames.species_of):
            members = frames.species_of == index
            thermal[..., members, :] = _without_mean_spin(frames, frames.spin, members)
        return thermal
    if frames.system.shear_rate or frames.system.rotates:
        return _without_mean_spin(frames, frames.spin, slice(None))
    return frames.spin


def _without_mean_spin(frames: Frame | FrameSeries, spin: np.ndarray, members: Any) -> np.ndarray:
    """Return the spins of some particles without their mean, (..., particles, 2 D - 3).

    The mean is the surface velocity of a particle with the mean angular velocity. `spin` are the
    spins of `frames`; `members` is an index of particles: a mask (N,) or a slice.
    """
    spin, radius = spin[..., members, :], frames.radius[members]
    turning = (frames.mass[members] * frames.inertia[members] * radius)[:, None]
    momenta = (turning * spin).sum(axis=-2, keepdims=True)
    return spin - radius[:, None] * (momenta / (turning[:, 0] @ radius))
