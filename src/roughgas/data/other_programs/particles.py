"""Particles in a frame of a file, in the units and in the box of the program that wrote them, and
the same particles in the units of a gas, as a dataset.

N is the number of particles; vectors have three components, also of disks.
"""

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from roughgas.base import InputError, Interval
from roughgas.data.states import AXES, QUANTITIES, READ_FROM

if TYPE_CHECKING:
    import xarray

UNIT = Interval("(0, inf)")
LARGEST_SPECIES = 1000
FARTHEST = 1e6  # of particles from the box, in its sides
FASTEST = 1e9  # of particles and of their surfaces, in a/T


class Units(NamedTuple):
    """The units a, m and T of a gas in the units of a file; None: of its first species."""

    length: float | None = None
    mass: float | None = None
    time: float = 1.0


class FileParticles(NamedTuple):
    """Particles in a frame of a file, in the units of the file."""

    position: np.ndarray  # (N, 3)
    velocity: np.ndarray  # (N, 3)
    angular_velocity: np.ndarray | None  # (N, 3); None: not in the file
    radius: np.ndarray | None  # (N,); None: not in the file
    mass: np.ndarray | None  # (N,); None: not in the file
    species: np.ndarray  # (N,) from 0
    names: tuple[str, ...]  # of the species; empty: the file numbers them
    origin: np.ndarray  # (3,) corner of the box
    lengths: np.ndarray  # (3,) of the box
    dimension: int  # 2 or 3
    surface_velocity: np.ndarray | None = None  # (N, 3) in place of the angular velocity
    inertia: np.ndarray | None = None  # (N,) moments of inertia


def dimension_of(
    position: np.ndarray, velocity: np.ndarray, angular_velocity: np.ndarray | None
) -> int:
    """Return 2 if particles (N, 3) stay in a plane of constant z and turn around z, else 3."""
    turns = angular_velocity is not None and angular_velocity[:, :2].any()
    stays = np.ptp(position[:, 2]) == 0.0 and not velocity[:, 2].any()
    return 2 if stays and not turns else 3


def in_gas_units(particles: FileParticles, units: Units, frame: str) -> "xarray.Dataset":
    """Return the particles as a dataset that a run can begin with (`roughgas.data.states`).

    `frame` names the file and the number of the frame, in messages. The corner of the box is the
    origin. Spins are velocities of surfaces, radius times angular velocity. Particles that are
    all alike have no species. Raises InputError if a unit is needed and not given.
    """
    import xarray

    length = _unit("length", units.length, particles.radius, particles.species, frame)
    time = UNIT.check("unit_time", units.time)
    axes, number = particles.dimension, len(particles.position)
    radius = np.full(number, length) if particles.radius is None else particles.radius
    _check_distance(particles, frame)
    values = {
        "position": (particles.position - particles.origin)[:, :axes] / length,
        "velocity": particles.velocity[:, :axes] * (time / length),
        "radius": radius / length,
        "box": particles.lengths[:axes] / length,
    }
    surface_velocity = particles.surface_velocity
    if particles.angular_velocity is not None:
        surface_velocity = particles.angular_velocity * radius[:, None]
    if surface_velocity is not None:
        values["spin"] = surface_velocity[:, slice(2, 3) if axes == 2 else slice(3)] * (
            time / length
        )
    for name in ("velocity", "spin"):
        _check_speed(name, values.get(name, np.empty((0, axes))), frame)
    if particles.mass is not None:
        mass = _unit("mass", units.mass, particles.mass, particles.species, frame)
        values["mass"] = particles.mass / mass
        if particles.inertia is not None and np.any(surface_velocity):
            values["inertia"] = particles.inertia / (particles.mass * radius**2)
    coordinates = {}
    if np.ptp(particles.species) > 0:
        values["species_of"] = particles.species
        if particles.names:
            coordinates["species"] = list(particles.names)
    elif np.ptp(radius) > 0.0:
        values["species_of"] = np.zeros(number, np.int64)
    variables = {
        name: (QUANTITIES[name].dims, array, {"units": QUANTITIES[name].unit})
        for name, array in values.items()
    }
    return xarray.Dataset(variables, coordinates, {READ_FROM: frame})


def _check_distance(particles: FileParticles, frame: str) -> None:
    """Raise InputError for a particle at a distance from the box that makes its image inexact."""
    sides = (particles.position - particles.origin)[:, : particles.dimension]
    sides = np.abs(sides) / particles.lengths[: particles.dimension]
    for row, axis in np.argwhere(sides > FARTHEST):
        key = f"{frame}: {AXES[3][axis]} of particle {row}"
        legal = f"lie within {FARTHEST:g} sides of the box"
        raise InputError(key, particles.position[row, axis], legal)


def _check_speed(name: str, values: np.ndarray, frame: str) -> None:
    """Raise InputError for velocities (N, axes) in a/T so fast that the units must be others."""
    for row, axis in np.argwhere(np.abs(values) > FASTEST):
        legal = f"be at most {FASTEST:g} a/T: state unit_time and unit_length"
        raise InputError(f"{frame}: {name} of particle {row}", values[row, axis], legal)


def _unit(
    name: str, unit: float | None, values: np.ndarray | None, species: np.ndarray, frame: str
) -> float:
    """Return the unit of length or of mass, by default the value (N,) of the first species.

    Raises InputError for a unit that is not positive, and where the file lacks the values or the
    species has several.
    """
    key = f"unit_{name}"
    if unit is not None:
        return UNIT.check(key, unit)
    if values is None:
        raise InputError(key, "(nothing)", f"be given: {frame} has no radii")
    first = values[species == species.min()]
    if np.ptp(first) > 0.0:
        legal = f"be given: values of the first species differ in {frame}"
        raise InputError(key, "(nothing)", legal)
    return float(first[0])
