"""Trajectories: positions, velocities and spins of all particles at chosen times.

They are datasets, and files for programs that look at particles. Files have no units: lengths are
in a, times in T, masses in m.

- `.xyz`, extended XYZ: text, which OVITO and ASE read;
- `.nc`, netCDF by the conventions of AMBER, for OVITO, VMD, MDAnalysis and ASE;
- `.gsd`, the format of HOOMD-blue, for OVITO and freud: needs the package gsd.

A sheared box is a triclinic cell, whose second vector leads to the image above: (shift, L_y). An
open axis is as long as the particles reach, and not periodic where the format can say so. Disks lie
in the plane z = 0 of a cell that is the largest diameter thick. Particles of several species have
their masses, and the number of the species from 0 (`kind`); in .gsd these are types with a name.
"""

from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from roughgas.base import InputError, __version__, required
from roughgas.base.files import whole_file
from roughgas.data.netcdf import Content, in_memory
from roughgas.data.variables import (
    ENERGY,
    LENGTH,
    MIXTURE,
    NAMES,
    SHEARED,
    SPEED,
    SPIN,
    TIME,
    Variable,
    described,
    register,
)

if TYPE_CHECKING:
    import netCDF4
    import xarray

SPECIES = "X"  # of no element
DEPTH = 2.0  # of the cell of disks, in radii of the largest
AMBER = {"Conventions": "AMBER", "ConventionVersion": "1.0", "program": "roughgas"}


PLACES = ("frame", "particle", "axis")
TRAJECTORY = register(
    "trajectory",
    {
        "axis": Variable("axis of the box, the last one vertical", "", ("axis",), "str"),
        "time": Variable("time since the start", TIME, ("frame",), of_settings=True),
        "collisions_per_particle": Variable(
            "collisions per particle since the start, of a cooling gas since it began to cool",
            dims=("frame",),
        ),
        "position": Variable("position of a particle, folded into the box", LENGTH, PLACES),
        "velocity": Variable("velocity of the image in the box", SPEED, PLACES),
        "spin": Variable(
            "spin as the velocity a w of the surface: of disks anticlockwise, of spheres a vector",
            SPEED,
            ("frame", "particle", "spin_axis"),
            when=(SPIN,),
        ),
        "angle": Variable(
            "angle by which a disk has turned since the first time",
            "rad",
            ("frame", "particle"),
            when=("disks that spin",),
        ),
        "radius": Variable("radius of a particle", LENGTH, ("particle",)),
        "mass": Variable("mass of a particle", "m", ("particle",), when=(MIXTURE,)),
        "inertia": Variable(
            "moment of inertia of a particle over its m a^2", "1", ("particle",), when=(MIXTURE,)
        ),
        "species_of": Variable(
            "number of a particle's species, from 0", "1", ("particle",), "i4", when=(MIXTURE,)
        ),
        **NAMES,
        "box": Variable("length of the box, NaN where it is open above", LENGTH, ("axis",)),
        "periodic": Variable(
            "whether the box repeats along the axis", "1", ("axis",), "i1", flags="bounded periodic"
        ),
        "image_shift": Variable(
            "displacement along the first axis of the image above along the second",
            LENGTH,
            ("frame",),
            when=(SHEARED,),
        ),
        "floor_height": Variable("height of the floor", LENGTH, ("frame",), when=("floor",)),
        "wall_displacement": Variable(
            "displacement of shaken walls from their middle",
            LENGTH,
            ("frame",),
            when=("shaken walls",),
        ),
        "E_trans": Variable(
            "translational energy per degree of freedom, of a sheared gas without the mean flow",
            ENERGY,
            ("frame",),
            of_settings=True,
        ),
        "E_rot": Variable(
            "rotational energy per degree of freedom, of a sheared gas without the mean spin",
            ENERGY,
            ("frame",),
            when=(SPIN,),
            of_settings=True,
        ),
        "R": Variable("share of rotation in the energy", "1", ("frame",), when=(SPIN,)),
    },
)


def as_trajectory(
    variables: Mapping[str, Any], attributes: Mapping[str, str | int | float]
) -> "xarray.Dataset":
    """Return the dataset of a trajectory from its variables (TRAJECTORY) and attributes."""
    return in_memory(Content(described("trajectory", variables), attributes))


class Frame(NamedTuple):
    """A frame as files have it: three-dimensional, the cell's corner at the origin."""

    time: float
    cell: np.ndarray  # (3, 3) its vectors, one a row
    position: np.ndarray  # (N, 3)
    velocity: np.ndarray  # (N, 3)
    spin: np.ndarray | None  # (N, 3)
    angle: np.ndarray | None  # (N,)


def check_format(path: str | Path) -> None:
    """Raise InputError if no trajectory can have this name, ImportError if a package lacks."""
    if Path(path).suffix not in FORMATS:
        raise InputError("--output", path, f"end in {', '.join(FORMATS)}")
    if Path(path).suffix == ".gsd":
        required("gsd.hoomd")


def write_trajectory(path: str | Path, trajectory: "xarray.Dataset") -> None:
    """Write a trajectory to a .xyz, .nc or .gsd file, whole or not at all.

    Raises InputError for another ending, ImportError if gsd is not installed, OSError.
    """
    check_format(path)
    with whole_file(path) as draft:
        FORMATS[Path(path).suffix](draft, trajectory)


def frames(trajectory: "xarray.Dataset") -> Iterator[Frame]:
    """Yield the frames of a trajectory as files have them: an open axis such that all fit."""
    reach = trajectory.position.values + trajectory.radius.values[:, None]
    lengths = trajectory.box.values
    heights = np.where(np.isnan(lengths), reach.max(axis=(0, 1)), lengths)
    depth, flat = DEPTH * float(trajectory.radius.max()), ((0, 0), (0, 3 - len(lengths)))
    for number in range(trajectory.sizes["frame"]):
        one = trajectory.isel(frame=number)
        cell = np.diag(np.append(heights, depth)[:3])
        cell[1, 0] = float(one.image_shift) if "image_shift" in one else 0.0
        spin = one.spin.values if "spin" in one else None
        yield Frame(
            time=float(one.time),
            cell=cell,
            position=np.pad(one.position.values, flat),
            velocity=np.pad(one.velocity.values, flat),
            # that of a disk points along z
            spin=spin if spin is None else np.pad(spin, ((0, 0), (3 - spin.shape[1], 0))),
            angle=one.angle.values if "angle" in one else None,
        )


def _write_xyz(path: Path, trajectory: "xarray.Dataset") -> None:
    radius = trajectory.radius.values[:, None]
    more = {name: values[:, None] for name, values in _differing(trajectory).items()}
    bounded = [*(trajectory.periodic.values == 0), True][:3]
    pbc = " ".join("F" if one else "T" for one in bounded)
    with open(path, "w", encoding="utf-8", newline="\n") as file:
        for frame in frames(trajectory):
            columns = {"pos": frame.position, "velo": frame.velocity, "radius": radius} | more
            if frame.spin is not None:
                columns["omega"] = frame.spin
            if frame.angle is not None:
                columns["angle"] = frame.angle[:, None]
            kinds = ":".join(f"{name}:R:{one.shape[1]}" for name, one in columns.items())
            cell = " ".join(map(repr, frame.cell.ravel().tolist()))
            file.write(
                f'{len(radius)}\nLattice="{cell}" Properties=species:S:1:{kinds} pbc="{pbc}" '
                f"Time={frame.time!r}\n"
            )
            for row in np.hstack(list(columns.values())).tolist():
                file.write(f"{SPECIES} {' '.join(map(repr, row))}\n")


def _write_amber(path: Path, trajectory: "xarray.Dataset") -> None:
    import netCDF4

    with netCDF4.Dataset(path, "w", format="NETCDF3_64BIT_OFFSET") as file:
        file.setncatts(AMBER | {"programVersion": __version__, "title": trajectory.title})
        file.createDimension("frame", None)
        sizes = {"atom": trajectory.sizes["particle"], "spatial": 3}
        for name, size in (sizes | {"cell_spatial": 3, "cell_angular": 3, "label": 5}).items():
            file.createDimension(name, size)
        _label(file, "spatial", ("spatial",), "xyz")
        _label(file, "cell_spatial", ("cell_spatial",), "abc")
        _label(file, "cell_angular", ("cell_angular", "label"), ["alpha", "beta ", "gamma"])
        file.createVariable("radius", "f8", ("atom",))[:] = trajectory.radius.values
        for name, values in _differing(trajectory).items():
            file.createVariable(name, "f8", ("atom",))[:] = values
        for number, frame in enumerate(frames(trajectory)):
            lengths, angles = lengths_and_angles(frame.cell)
            rows: dict[str, tuple[Any, tuple[str, ...]]] = {
                "time": (frame.time, ("frame",)),
                "coordinates": (frame.position, ("frame", "atom", "spatial")),
                "velocities": (frame.velocity, ("frame", "atom", "spatial")),
                "cell_lengths": (lengths, ("frame", "cell_spatial")),
                "cell_angles": (angles, ("frame", "cell_angular")),
                "omega": (frame.spin, ("frame", "atom", "spatial")),
                "angle": (frame.angle, ("frame", "atom")),
            }
            for name, (values, dims) in rows.items():
                if values is not None:
                    if name not in file.variables:
                        file.createVariable(name, "f8", dims)
                    file[name][number] = values
        file["cell_angles"].units = "degree"


def _differing(trajectory: "xarray.Dataset") -> dict[str, np.ndarray]:
    """Return mass and species of each particle, (N,), where they differ."""
    if "species_of" not in trajectory:
        return {}
    return {"mass": trajectory.mass.values, "kind": trajectory.species_of.values.astype(float)}


def _label(file: "netCDF4.Dataset", name: str, dims: tuple[str, ...], letters: Any) -> None:
    signs = np.array([list(one) for one in letters] if len(dims) == 2 else list(letters), "S1")
    file.createVariable(name, "S1", dims)[:] = signs


def lengths_and_angles(cell: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the lengths (3,) of a cell's vectors, and the angles (3,) between them in degrees."""
    lengths = np.linalg.norm(cell, axis=1)
    unit = cell / lengths[:, None]
    cosines = [unit[1] @ unit[2], unit[0] @ unit[2], unit[0] @ unit[1]]
    return lengths, np.degrees(np.arccos(cosines))


def _write_gsd(path: Path, trajectory: "xarray.Dataset") -> None:
    hoomd = required("gsd.hoomd")
    dimension, number = trajectory.sizes["axis"], trajectory.sizes["particle"]
    with hoomd.open(path, "w") as file:
        for step, frame in enumerate(frames(trajectory)):
            shot = hoomd.Frame()
            shot.configuration.step = step
            shot.configuration.dimensions = dimension
            lengths, tilt = np.diag(frame.cell), frame.cell[1, 0] / frame.cell[1, 1]
            depth = lengths[2] * (dimension == 3)  # 0 says that this is a plane
            shot.configuration.box = [*lengths[:2], depth, _least(tilt, lengths), 0.0, 0.0]
            shot.particles.N = number
            shot.particles.types = [SPECIES]
            if "species_of" in trajectory:
                shot.particles.types = trajectory.species.values.tolist()
                shot.particles.typeid = trajectory.species_of.values.astype(np.uint32)
                shot.particles.mass = trajectory.mass.values
            shot.particles.diameter = 2.0 * trajectory.radius.values
            shot.particles.position = _centred(frame, dimension)
            shot.particles.velocity = frame.velocity
            shot.log["time"] = np.array([frame.time])
            if frame.spin is not None:
                shot.log["particles/omega"] = frame.spin
            if frame.angle is not None:
                half = frame.angle / 2.0
                zero = np.zeros(number)
                turned = np.stack([np.cos(half), zero, zero, np.sin(half)], axis=1)
                shot.particles.orientation = turned
            file.append(shot)


def _least(tilt, lengths):
    """Return the tilt of the same lattice that is the least: within half a length."""
    whole = lengths[0] / lengths[1]
    return tilt - whole * round(tilt / whole)


def _centred(frame, dimension):
    """Return positions relative to the middle of the cell, inside of it: as HOOMD wants them."""
    lengths = np.diag(frame.cell)
    shift = lengths[1] * _least(frame.cell[1, 0] / lengths[1], lengths)
    position = frame.position - 0.5 * lengths
    position[:, 2] *= dimension == 3
    # across the sheared cell: x runs from one slanted face to the other
    slant = shift * position[:, 1] / lengths[1]
    across = position[:, 0] - slant
    position[:, 0] -= lengths[0] * np.floor(across / lengths[0] + 0.5)
    return position


FORMATS: dict[str, Callable[[Path, "xarray.Dataset"], None]] = {
    ".xyz": _write_xyz,
    ".nc": _write_amber,
    ".gsd": _write_gsd,
}
"""Writers by the endings of their files."""
