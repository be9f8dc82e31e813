"""GSD, the format of HOOMD-blue, by the package gsd.

Its schema hoomd defines the fields. The angular momentum is the quaternion P = 2 q (0, L) with the
orientation q and the angular momentum L in the frame of the body, so that P q* / 2 has L in space.
"""

from pathlib import Path
from typing import Any

import numpy as np

from roughgas.base import InputError, import_extra, on_one_line, short_repr
from roughgas.data.other_programs.particles import FileParticles
from roughgas.data.other_programs.text import MAX_PARTICLES, check_frame

MAGIC = bytes.fromhex("df65df65df65df65")
BOX, ORIGIN = "box", "origin"
"""Entries of the log of roughgas: the box in double precision, and the corner of the gas."""

WIDTHS: dict[str, tuple[int, ...]] = {
    **{"position": (3,), "velocity": (3,), "angmom": (4,), "orientation": (4,)},
    **{"moment_inertia": (3,), "diameter": (), "mass": (), "typeid": ()},
}
"""Fields of particles, and the shapes of a particle's values."""


def is_gsd(content: bytes) -> bool:
    """Return whether a file that begins with `content` is GSD."""
    return content.startswith(MAGIC)


def read_gsd(path: str | Path, frame: int) -> FileParticles:
    """Return the particles in a frame of a GSD file.

    Raises InputError for a damaged file, for a tilted box, and for numbers that are not finite;
    ImportError without the package gsd.
    """
    shot = _frame(path, frame)
    dimension, particles = int(shot.configuration.dimensions), shot.particles
    box = _logged(path, shot, BOX, shot.configuration.box)
    lengths = box[:3]
    if box[3:].any() or np.any(lengths[:dimension] <= 0.0):
        legal = "be positive sides, without tilt"
        raise InputError(f"{path}, box", short_repr(box.tolist()), legal)
    if not 1 <= particles.N <= MAX_PARTICLES:
        legal = f"be a number in [1, {MAX_PARTICLES}]"
        raise InputError(f"{path}, number of particles", particles.N, legal)
    values = {name: _field(path, particles, name, width) for name, width in WIDTHS.items()}
    for row in np.flatnonzero(values["typeid"] >= len(particles.types)):
        legal = f"be below {len(particles.types)}, the number of types"
        raise InputError(f"{path}, typeid of particle {row}", particles.typeid[row], legal)
    for name in ("diameter", "mass"):
        for row in np.flatnonzero(values[name] <= 0.0):
            raise InputError(f"{path}, {name} of particle {row}", values[name][row], "be positive")
    angular_velocity, inertia = _rotation(path, values, dimension)
    return FileParticles(
        position=values["position"],
        velocity=values["velocity"],
        angular_velocity=angular_velocity,
        radius=values["diameter"] / 2.0,
        mass=values["mass"],
        species=values["typeid"].astype(np.int64),
        names=tuple(particles.types),
        origin=_logged(path, shot, ORIGIN, -0.5 * lengths),
        lengths=lengths,
        dimension=dimension,
        inertia=inertia,
    )


def _frame(path: str | Path, number: int) -> Any:
    """Return a frame of a file as the package gsd has it; raise InputError for a damaged file."""
    hoomd = import_extra("gsd.hoomd")
    try:
        with hoomd.open(path, "r") as file:
            check_frame(number, len(file), path)
            shot = file[number]
            shot.validate()
    except (InputError, FileNotFoundError, PermissionError):
        raise
    except Exception as error:  # the package raises many types for a damaged file
        legal = f"be GSD that the package gsd reads: {type(error).__name__}: {error}"
        raise InputError("file", path, on_one_line(legal)) from error
    return shot


def _logged(path: str | Path, shot: Any, name: str, default: Any) -> np.ndarray:
    """Return the array `name` in the log of a frame, or the default; raise InputError for another
    shape and for numbers that are not finite."""
    values = np.array(shot.log.get(name, default), float)
    if values.shape != np.shape(default) or not np.isfinite(values).all():
        legal = f"be {len(default)} finite numbers"
        raise InputError(f"{path}, {name}", short_repr(values.tolist()), legal)
    return values


def _field(path: str | Path, particles: Any, name: str, width: tuple[int, ...]) -> np.ndarray:
    """Return a field of all particles, (N, *width); raise InputError for another shape and for
    numbers that are not finite."""
    values, shape = np.array(getattr(particles, name), float), (particles.N, *width)
    if values.shape != shape:
        raise InputError(f"{path}, {name}", f"of shape {values.shape}", f"have the shape {shape}")
    for row in np.flatnonzero(~np.isfinite(values.reshape(len(values), -1)).all(axis=1)):
        value = short_repr(values[row].tolist())
        raise InputError(f"{path}, {name} of particle {row}", value, "be finite numbers")
    return values


def _rotation(
    path: str | Path, values: dict[str, np.ndarray], dimension: int
) -> tuple[np.ndarray | None, np.ndarray | None]:
    """Return angular velocities (N, 3) in space, and moments of inertia (N,); None if no particle
    has a moment.

    Disks turn around z. Raises InputError for moments of spheres that differ by axis.
    """
    moments = values["moment_inertia"]
    if not moments.any():
        return None, None
    inertia = moments[:, 2]
    axes = moments if dimension == 3 else moments[:, 2:]
    uneven = (axes <= 0.0).any(axis=1) | (np.ptp(axes, axis=1) > 0.0)
    for row in np.flatnonzero(uneven):
        key = f"{path}, moment_inertia of particle {row}"
        raise InputError(key, short_repr(moments[row].tolist()), "be positive and that of a sphere")
    angular_momentum = _vector_part_with_conjugate(values["angmom"], values["orientation"]) / 2.0
    return angular_momentum / inertia[:, None], inertia


def _vector_part_with_conjugate(first: np.ndarray, second: np.ndarray) -> np.ndarray:
    """Return the vector parts (N, 3) of the products of quaternions and conjugate quaternions.

    Both arguments are (N, 4).
    """
    real, vector = first[:, :1], first[:, 1:]
    other_real, other_vector = second[:, :1], second[:, 1:]
    return vector * other_real - real * other_vector - np.cross(vector, other_vector)
