"""Trajectories: positions, velocities and spins of all particles at chosen times.

They are datasets, and files for programs that look at particles. In files lengths are in a, times
in T, masses in m; where a convention demands units, a, T and m stand for them.

- `.xyz`, extended XYZ: text, which OVITO and ASE read;
- `.nc`, netCDF by the conventions of AMBER, for OVITO, VMD, MDAnalysis and ASE;
- `.gsd`, the format of HOOMD-blue, for OVITO and freud: needs the package gsd.

A sheared box is a triclinic cell, whose second vector leads to the image above: (shift, L_y). An
open axis is as long as the particles have reached so far, and not periodic where the format can say
so. Frames are written one by one, and are on the disk as soon as they are. Disks lie
in the plane z = 0 of a cell that is the largest diameter thick. Particles of several species have
their masses, and the number of the species from 0 (`kind`); in .xyz each species has the symbol of
an element, in .gsd its name as type.
"""

from collections.abc import Callable, Iterator, Mapping
from contextlib import AbstractContextManager, contextmanager
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
ELEMENTS = "H He Li Be B C N O F Ne Na Mg Al Si P S Cl Ar K Ca".split()  # of species in .xyz
DEPTH = 2.0  # of the cell of disks, in radii of the largest
AMBER = {"Conventions": "AMBER", "ConventionVersion": "1.0", "program": "roughgas"}
UNITS = {
    "time": ("picosecond", TIME),
    "coordinates": ("angstrom", LENGTH),
    "velocities": ("angstrom/picosecond", SPEED),
    "cell_lengths": ("angstrom", LENGTH),
    "cell_angles": ("degree", "degree"),
    "omega": ("angstrom/picosecond", SPEED),
    "angle": ("radian", "radian"),
    "radius": ("angstrom", LENGTH),
    "mass": ("dalton", "m"),
    "kind": ("1", "1"),
}
"""Of each variable of a file of AMBER the units that the conventions demand, and the true ones."""
SCALED = ("time", "coordinates", "velocities", "cell_lengths", "cell_angles")
"""Variables of the conventions, which may have a scale_factor; MDAnalysis refuses it elsewhere."""

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
        "unwrapped_position": Variable(
            "position of a particle along its continuous path, NaN along the flow of a sheared gas",
            LENGTH,
            PLACES,
        ),
        "velocity": Variable("velocity of the image in the box", SPEED, PLACES),
        "spin": Variable(
            "spin as the velocity a w of the surface: of disks anticlockwise, of spheres a vector",
            SPEED,
            ("frame", "particle", "spin_axis"),
            when=(SPIN,),
        ),
        "angle": Variable(
            "angle by which a disk has turned since the trajectory starts",
            "rad",
            ("frame", "particle"),
            when=("disks that spin",),
        ),
        "radius": Variable("radius of a particle", LENGTH, ("particle",)),
        "mass": Variable("mass of a particle", "m", ("particle",), when=(MIXTURE,)),
        "inertia": Variable(
            "moment of inertia of a particle over its m a^2", "1", ("particle",), when=(MIXTURE,)
        ),
        "moment_of_inertia": Variable(
            "moment of inertia of a particle", "m a^2", ("particle",), when=(SPIN,)
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


Values = Mapping[str, np.ndarray]
"""The variables of TRAJECTORY, with one frame or more."""


class Frame(NamedTuple):
    """A frame as files have it: three-dimensional, the cell's corner at the origin."""

    time: float
    cell: np.ndarray  # (3, 3) its vectors, one a row
    position: np.ndarray  # (N, 3)
    velocity: np.ndarray  # (N, 3)
    spin: np.ndarray | None  # (N, 3)
    angle: np.ndarray | None  # (N,)
    image: np.ndarray | None  # (N, 3) periods from the position to the path; None of a sheared gas


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
    values = {str(name): one.values for name, one in trajectory.variables.items()}
    with whole_file(path) as draft, FORMATS[Path(path).suffix](draft, trajectory.title) as append:
        for frame in frames(values):
            append(frame, values)


@contextmanager
def growing_trajectory(path: str | Path, title: str) -> Iterator[Callable[[Values], None]]:
    """Open a .xyz, .nc or .gsd file, and yield what appends frames to it.

    Each frame is handed to the disk at once: what interrupts the program, or kills it, leaves a
    file of the frames before. It has the bytes that `write_trajectory` writes of all together.
    Raises InputError for another ending, ImportError if gsd is not installed, OSError.
    """
    check_format(path)
    Path(path).parent.mkdir(parents=True, exist_ok=True)
    reached = 0.0
    with FORMATS[Path(path).suffix](Path(path), title) as append:

        def write(values: Values) -> None:
            nonlocal reached
            for frame in frames(values, reached):
                append(frame, values)
            reached = max(reached, _tallest(values).max())

        yield write


def frames(values: Values, reached: float = 0.0) -> Iterator[Frame]:
    """Yield the frames of variables as files have them; an open axis is as long as the particles
    have reached so far, or in frames before these."""
    lengths = values["box"]
    tallest = np.maximum.accumulate(np.maximum(_tallest(values), reached))
    depth, flat = DEPTH * float(values["radius"].max()), ((0, 0), (0, 3 - len(lengths)))
    for number, tall in enumerate(tallest):
        cell = np.diag(np.append(np.where(np.isnan(lengths), tall, lengths), depth)[:3])
        cell[1, 0] = values["image_shift"][number] if "image_shift" in values else 0.0
        spin = values["spin"][number] if "spin" in values else None
        yield Frame(
            time=float(values["time"][number]),
            cell=cell,
            position=np.pad(values["position"][number], flat),
            velocity=np.pad(values["velocity"][number], flat),
            # that of a disk points along z
            spin=spin if spin is None else np.pad(spin, ((0, 0), (3 - spin.shape[1], 0))),
            angle=values["angle"][number] if "angle" in values else None,
            image=_images(values, number),
        )


def _images(values: Values, number: int) -> np.ndarray | None:
    """Return the periods (N, 3) of the box between folded and unwrapped positions of a frame.

    None for a sheared gas, whose crossings along the flow are not known.
    """
    if "image_shift" in values:
        return None
    periods = np.where(values["periodic"] == 1, values["box"], np.inf)
    apart = values["unwrapped_position"][number] - values["position"][number]
    return np.pad(np.rint(apart / periods).astype(int), ((0, 0), (0, 3 - len(periods))))


def _tallest(values: Values) -> np.ndarray:
    """Return how far up particles reach in each frame, (F,); the last axis is the open one."""
    return (values["position"][..., -1] + values["radius"]).max(axis=1)


@contextmanager
def _xyz(path: Path, title: str) -> Iterator["Append"]:
    with open(path, "w", encoding="utf-8", newline="\n") as file:

        def append(frame: Frame, values: Values) -> None:
            columns = _columns(frame, values)
            kinds = ":".join(f"{name}:R:{one.shape[1]}" for name, one in columns.items())
            cell = " ".join(map(repr, frame.cell.ravel().tolist()))
            bounded = [*(values["periodic"] == 0), True][:3]
            pbc = " ".join("F" if one else "T" for one in bounded)
            file.write(
                f'{len(frame.position)}\nLattice="{cell}" Properties=species:S:1:{kinds} '
                f'pbc="{pbc}" Time={frame.time!r}\n'
            )
            rows = np.hstack(list(columns.values())).tolist()
            for symbol, row in zip(_symbols(values), rows, strict=True):
                file.write(f"{symbol} {' '.join(map(repr, row))}\n")
            file.flush()

        yield append


def _columns(frame: Frame, values: Values) -> dict[str, np.ndarray]:
    """Return the columns (N, ...) of a frame of extended XYZ, by the names that programs know."""
    mass = _masses(values)[:, None]
    columns = {"pos": frame.position, "velo": frame.velocity, "radius": values["radius"][:, None]}
    if "species_of" in values:
        columns["kind"] = values["species_of"].astype(float)[:, None]
    if frame.spin is not None:
        columns["omega"] = frame.spin
    if frame.angle is not None:
        columns["angle"] = frame.angle[:, None]
    # ASE has velocities only as momenta over masses
    return columns | {"masses": mass, "momenta": mass * frame.velocity}


def _symbols(values: Values) -> list[str]:
    """Return the symbol of each particle: X, or in a mixture the element of its species."""
    if "species_of" not in values:
        return [SPECIES] * len(values["radius"])
    return [ELEMENTS[kind % len(ELEMENTS)] for kind in values["species_of"].tolist()]


def _masses(values: Values) -> np.ndarray:
    """Return the mass of each particle in m, (N,)."""
    return values["mass"] if "mass" in values else np.ones(len(values["radius"]))


@contextmanager
def _amber(path: Path, title: str) -> Iterator["Append"]:
    import netCDF4

    with netCDF4.Dataset(path, "w", format="NETCDF3_64BIT_OFFSET") as file:
        file.setncatts(AMBER | {"programVersion": __version__, "title": title})

        def append(frame: Frame, values: Values) -> None:
            if not file.dimensions:
                _describe(file, frame, values)
            number = len(file.dimensions["frame"])
            for name, (present, _) in _rows(frame).items():
                if present is not None:
                    file[name][number] = present
            file.sync()

        yield append


def _describe(file: "netCDF4.Dataset", frame: Frame, values: Values) -> None:
    """Give a file of AMBER its dimensions and variables, those of no frame with their values."""
    file.createDimension("frame", None)
    sizes = {"atom": len(values["radius"]), "spatial": 3}
    for name, size in (sizes | {"cell_spatial": 3, "cell_angular": 3, "label": 5}).items():
        file.createDimension(name, size)
    _label(file, "spatial", ("spatial",), "xyz")
    _label(file, "cell_spatial", ("cell_spatial",), "abc")
    _label(file, "cell_angular", ("cell_angular", "label"), ["alpha", "beta ", "gamma"])
    for name, one in ({"radius": values["radius"]} | _differing(values)).items():
        _quantity(file, name, ("atom",))[:] = one
    for name, (present, dims) in _rows(frame).items():
        if present is not None:
            _quantity(file, name, ("frame", *dims))


def _quantity(file: "netCDF4.Dataset", name: str, dims: tuple[str, ...]) -> "netCDF4.Variable":
    """Create a variable of UNITS, with units, and return it."""
    variable = file.createVariable(name, "f8", dims)
    variable.units, variable.true_units = UNITS[name]
    if name in SCALED:
        variable.scale_factor = 1.0
    return variable


def _rows(frame: Frame) -> dict[str, tuple[Any, tuple[str, ...]]]:
    """Return what AMBER has of a frame, with its dimensions; None is what the frame lacks."""
    lengths, angles = lengths_and_angles(frame.cell)
    return {
        "time": (frame.time, ()),
        "coordinates": (frame.position, ("atom", "spatial")),
        "velocities": (frame.velocity, ("atom", "spatial")),
        "cell_lengths": (lengths, ("cell_spatial",)),
        "cell_angles": (angles, ("cell_angular",)),
        "omega": (frame.spin, ("atom", "spatial")),
        "angle": (frame.angle, ("atom",)),
    }


def _differing(values: Values) -> dict[str, np.ndarray]:
    """Return mass and species of each particle, (N,), where they differ."""
    if "species_of" not in values:
        return {}
    return {"mass": values["mass"], "kind": values["species_of"].astype(float)}


def _label(file: "netCDF4.Dataset", name: str, dims: tuple[str, ...], letters: Any) -> None:
    signs = np.array([list(one) for one in letters] if len(dims) == 2 else list(letters), "S1")
    file.createVariable(name, "S1", dims)[:] = signs


def lengths_and_angles(cell: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the lengths (3,) of a cell's vectors, and the angles (3,) between them in degrees."""
    lengths = np.linalg.norm(cell, axis=1)
    unit = cell / lengths[:, None]
    cosines = [unit[1] @ unit[2], unit[0] @ unit[2], unit[0] @ unit[1]]
    return lengths, np.degrees(np.arccos(cosines))


@contextmanager
def _gsd(path: Path, title: str) -> Iterator["Append"]:
    hoomd = required("gsd.hoomd")
    with hoomd.open(path, "w") as file:

        def append(frame: Frame, values: Values) -> None:
            file.append(_shot(hoomd.Frame(), len(file), frame, values))
            file.file.flush()

        yield append


def _shot(shot: Any, step: int, frame: Frame, values: Values) -> Any:
    """Return an empty frame of HOOMD with all there is to a frame."""
    dimension, number = len(values["box"]), len(values["radius"])
    shot.configuration.step = step
    shot.configuration.dimensions = dimension
    # an open axis is as long below zero, so that the floor stays where it is
    upward = np.append(np.isnan(values["box"]), False)[:3]
    cell = frame.cell * np.where(upward, 2.0, 1.0)[:, None]
    lengths, tilt = np.diag(cell), cell[1, 0] / cell[1, 1]
    depth = lengths[2] * (dimension == 3)  # 0 says that this is a plane
    shot.configuration.box = [*lengths[:2], depth, _least(tilt, lengths), 0.0, 0.0]
    shot.particles.N = number
    shot.particles.types = [SPECIES]
    if "species_of" in values:
        shot.particles.types = values["species"].tolist()
        shot.particles.typeid = values["species_of"].astype(np.uint32)
        shot.particles.mass = values["mass"]
    shot.particles.diameter = 2.0 * values["radius"]
    shot.particles.position = _centred(frame.position, cell, upward, dimension)
    shot.particles.velocity = frame.velocity
    if frame.image is not None:
        shot.particles.image = frame.image
    shot.log["time"] = np.array([frame.time])
    if frame.spin is not None:
        shot.log["particles/omega"] = frame.spin
    orientation = _orientation(frame)
    if frame.angle is not None:
        shot.particles.orientation = orientation
    if frame.spin is not None and "moment_of_inertia" in values:
        moments, momentum = _rotation(frame, values)
        shot.particles.moment_inertia = moments
        shot.particles.angmom = _doubled_product(orientation, momentum)
    return shot


def _orientation(frame: Frame) -> np.ndarray:
    """Return the quaternions (N, 4) of disks; of spheres, whose axes are not followed, identity."""
    half = np.zeros(len(frame.position)) if frame.angle is None else frame.angle / 2.0
    zero = np.zeros_like(half)
    return np.stack([np.cos(half), zero, zero, np.sin(half)], axis=1)


def _rotation(frame: Frame, values: Values) -> tuple[np.ndarray, np.ndarray]:
    """Return moments of inertia (N, 3) in m a^2, and angular momenta (N, 3) in m a^2/T.

    Disks turn around z alone: HOOMD has 0 where there is no such motion.
    """
    axes = [1.0, 1.0, 1.0] if len(values["box"]) == 3 else [0.0, 0.0, 1.0]
    assert frame.spin is not None
    moment = values["moment_of_inertia"][:, None]
    # the spin is the velocity of the surface
    return moment * axes, moment * frame.spin / values["radius"][:, None]


def _doubled_product(orientation: np.ndarray, momentum: np.ndarray) -> np.ndarray:
    """Return 2 q (0, L) as quaternions (N, 4): what HOOMD has of an angular momentum L in the
    frame of the body, here (N, 3), and its orientation q, (N, 4)."""
    real, imaginary = orientation[:, :1], orientation[:, 1:]
    scalar = -np.sum(imaginary * momentum, axis=1, keepdims=True)
    vector = real * momentum + np.cross(imaginary, momentum)
    return 2.0 * np.hstack([scalar, vector])


def _least(tilt, lengths):
    """Return the tilt of the same lattice that is the least: within half a length."""
    whole = lengths[0] / lengths[1]
    return tilt - whole * round(tilt / whole)


def _centred(position, cell, upward, dimension):
    """Return positions relative to the middle of the cell, inside of it: as HOOMD wants them."""
    lengths = np.diag(cell)
    shift = lengths[1] * _least(cell[1, 0] / lengths[1], lengths)
    position = position - np.where(upward, 0.0, 0.5 * lengths)
    position[:, 2] *= dimension == 3
    # across the sheared cell: x runs from one slanted face to the other
    slant = shift * position[:, 1] / lengths[1]
    across = position[:, 0] - slant
    position[:, 0] -= lengths[0] * np.floor(across / lengths[0] + 0.5)
    return position


Append = Callable[[Frame, Values], None]
FORMATS: dict[str, Callable[[Path, str], AbstractContextManager[Append]]] = {
    ".xyz": _xyz,
    ".nc": _amber,
    ".gsd": _gsd,
}
"""What opens a file of each ending, with a title, for frames to come."""
