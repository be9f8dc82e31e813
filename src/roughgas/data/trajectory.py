"""Trajectories: positions, velocities and spins of all particles at chosen times.

They are datasets, and files for programs that display or analyse particles. In files lengths are in
a, times in T, masses in m; where a convention demands units, its units stand for a, T and m.

- `.xyz`, extended XYZ: text, which OVITO and ASE read;
- `.nc`, netCDF by the conventions of AMBER, for OVITO, VMD, MDAnalysis and ASE;
- `.gsd`, the format of HOOMD-blue, for OVITO and freud: needs the package gsd. Its numbers are in
  single precision, or optionally in double precision.

A sheared box is a triclinic cell, whose second vector leads to the image above: (shift, L_y). The
length of an open axis is the greatest height of particles up to the frame, and the axis is not
periodic if the format allows that. Each frame is flushed to the disk when it is written. Disks
lie in the plane z = 0 of a cell whose thickness is the largest diameter. Particles of several
species have their masses, and the number of the species from 0 (`kind`); in .xyz each species has
the symbol of an element, in .gsd its name as type.
"""

from collections.abc import Callable, Iterator, Mapping
from contextlib import AbstractContextManager, contextmanager
from functools import partial
from inspect import signature
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from roughgas.base import InputError, Record, __version__, import_extra
from roughgas.base.files import atomic_write
from roughgas.data.formats import DATASET
from roughgas.data.netcdf import Content, in_memory
from roughgas.data.variables import (
    ENERGY,
    LENGTH,
    MIXTURE,
    SHEARED,
    SPECIES_VARIABLES,
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

NO_ELEMENT = "X"  # of no element
ELEMENTS = "H He Li Be B C N O F Ne Na Mg Al Si P S Cl Ar K Ca".split()  # of species in .xyz
PRECISION = "precision"  # an argument of gsd.hoomd.open since gsd 5
DISK_CELL_DEPTH = 2.0  # of the cell of disks, in radii of the largest
AMBER = {
    **{"Conventions": "AMBER", "ConventionVersion": "1.0", "program": "roughgas"},
    "schema_version": np.int32(DATASET.newest),
}
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
"""Units that AMBER's conventions demand for each variable, and the true units."""
SCALED = ("time", "coordinates", "velocities", "cell_lengths", "cell_angles")
"""Variables of AMBER's conventions that get a scale_factor; MDAnalysis refuses others with one."""

PARTICLE_DIMS = ("frame", "particle", "axis")
TRAJECTORY = register(
    "trajectory",
    {
        "axis": Variable("axis of the box, the last one vertical", "", ("axis",), "str"),
        "time": Variable("time since the start", TIME, ("frame",), of_settings=True),
        "collisions_per_particle": Variable(
            "collisions per particle since the start, of a cooling gas since it began to cool",
            dims=("frame",),
        ),
        "position": Variable("position of a particle, folded into the box", LENGTH, PARTICLE_DIMS),
        "unwrapped_position": Variable(
            "position of a particle along its continuous path, NaN along the flow of a sheared gas",
            LENGTH,
            PARTICLE_DIMS,
        ),
        "velocity": Variable("velocity of the image in the box", SPEED, PARTICLE_DIMS),
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
        **SPECIES_VARIABLES,
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
            "rotational energy per degree of freedom, without the mean spin of shear or of a bath",
            ENERGY,
            ("frame",),
            when=(SPIN,),
            of_settings=True,
        ),
        "R": Variable("share of rotation in the energy", "1", ("frame",), when=(SPIN,)),
    },
)


def as_trajectory(
    variables: Record, attributes: Mapping[str, str | int | float]
) -> "xarray.Dataset":
    """Return the dataset of a trajectory from the values of its variables and its attributes.

    Names and dimensions of the variables are as in TRAJECTORY. Raises ValueError for others.
    """
    return in_memory(Content(described("trajectory", variables), attributes))


Variables = Mapping[str, np.ndarray]
"""Variables of TRAJECTORY, with one frame or more."""


class FileFrame(NamedTuple):
    """The particles at an instant as stored in files: in three dimensions, a corner at the origin.

    Lengths are in particle radii a, times in T; the spin is the velocity a w of the surface, the
    angle in radians.
    """

    time: float
    cell: np.ndarray  # (3, 3) its vectors, as rows
    position: np.ndarray  # (N, 3)
    velocity: np.ndarray  # (N, 3)
    spin: np.ndarray | None  # (N, 3)
    angle: np.ndarray | None  # (N,)
    image: np.ndarray | None  # (N, 3) periods from folded to unwrapped position; None if sheared


def check_format(path: str | Path, double: bool = False) -> None:
    """Raise InputError if a trajectory at `path` has an unknown suffix.

    `double` requests double precision in a .gsd file. Raises ImportError for a missing package,
    InputError for a gsd too old for double precision.
    """
    if Path(path).suffix not in FORMATS:
        raise InputError("--output", path, f"end in {', '.join(FORMATS)}")
    if Path(path).suffix == ".gsd":
        opener = import_extra("gsd.hoomd").open
        if double and PRECISION not in signature(opener).parameters:
            version = import_extra("gsd.version").version
            raise InputError("gsd", version, "be 5 or newer, to write in double precision")


def write_trajectory(
    path: str | Path, trajectory: "xarray.Dataset", *, double: bool = False
) -> None:
    """Write a trajectory, a dataset like `roughgas.trajectory`'s, to a .xyz, .nc or .gsd file.

    The file appears whole or not at all. A .gsd file is in single or in `double` precision, other
    files always in double precision. Raises InputError for another suffix, and for a gsd too old
    for `double`; ImportError if gsd is not installed; OSError if the file cannot be written.
    """
    check_format(path, double)
    values = {str(name): variable.values for name, variable in trajectory.variables.items()}
    opened = _format(path, double)
    with atomic_write(path) as draft, opened(draft, trajectory.title) as append:
        for frame in file_frames(values):
            append(frame, values)


@contextmanager
def growing_trajectory(
    path: str | Path, title: str, double: bool = False
) -> Iterator[Callable[[Variables], None]]:
    """Open a .xyz, .nc or .gsd file, and yield a function that appends frames to it.

    The function takes the variables of one frame or more (TRAJECTORY). `title` goes into the file,
    where its format allows that. Each frame is flushed to the disk: if the program is killed, the
    file holds all earlier frames. A complete file has the same bytes as `write_trajectory` would
    write. Raises InputError, ImportError and OSError as `write_trajectory` does.
    """
    check_format(path, double)
    Path(path).parent.mkdir(parents=True, exist_ok=True)
    greatest_height = 0.0
    with _format(path, double)(Path(path), title) as append:

        def write(values: Variables) -> None:
            nonlocal greatest_height
            for frame in file_frames(values, greatest_height):
                append(frame, values)
            greatest_height = max(greatest_height, _greatest_heights(values).max())

        yield write


def file_frames(values: Variables, minimum_height: float = 0.0) -> Iterator[FileFrame]:
    """Yield the frames of a trajectory, given by its variables, as stored in files.

    An open axis is as long as the greatest height of particles up to the frame, or longer: at least
    `minimum_height` (a), which earlier frames have reached.
    """
    lengths = values["box"]
    heights = np.maximum.accumulate(np.maximum(_greatest_heights(values), minimum_height))
    depth, padding = (
        DISK_CELL_DEPTH * float(values["radius"].max()),
        ((0, 0), (0, 3 - len(lengths))),
    )
    for number, height in enumerate(heights):
        cell = np.diag(np.append(np.where(np.isnan(lengths), height, lengths), depth)[:3])
        cell[1, 0] = values["image_shift"][number] if "image_shift" in values else 0.0
        spin = values["spin"][number] if "spin" in values else None
        yield FileFrame(
            time=float(values["time"][number]),
            cell=cell,
            position=np.pad(values["position"][number], padding),
            velocity=np.pad(values["velocity"][number], padding),
            # the spin of a disk points along z
            spin=spin if spin is None else np.pad(spin, ((0, 0), (3 - spin.shape[1], 0))),
            angle=values["angle"][number] if "angle" in values else None,
            image=_images(values, number),
        )


def _images(values: Variables, number: int) -> np.ndarray | None:
    """Return the periods (N, 3) of the box from folded to unwrapped positions in frame `number`.

    They are whole numbers; None for a sheared gas, whose crossings along the flow are unknown.
    """
    if "image_shift" in values:
        return None
    periods = np.where(values["periodic"] == 1, values["box"], np.inf)
    apart = values["unwrapped_position"][number] - values["position"][number]
    return np.pad(np.rint(apart / periods).astype(int), ((0, 0), (0, 3 - len(periods))))


def _greatest_heights(values: Variables) -> np.ndarray:
    """Return the highest point (a) of all particles along the last axis, by frame: (frames,)."""
    return (values["position"][..., -1] + values["radius"]).max(axis=1)


@contextmanager
def _xyz(path: Path, title: str) -> Iterator["Append"]:
    """Open a new file of extended XYZ at `path`, and yield a function that appends a frame to it.

    The format has no place for the `title`.
    """
    with open(path, "w", encoding="utf-8", newline="\n") as file:

        def append(frame: FileFrame, values: Variables) -> None:
            columns = _columns(frame, values)
            kinds = ":".join(f"{name}:R:{column.shape[1]}" for name, column in columns.items())
            cell = " ".join(map(repr, frame.cell.ravel().tolist()))
            bounded = [*(values["periodic"] == 0), True][:3]
            pbc = " ".join("F" if is_bounded else "T" for is_bounded in bounded)
            file.write(
                f'{len(frame.position)}\nLattice="{cell}" Properties=species:S:1:{kinds} '
                f'pbc="{pbc}" Time={frame.time!r} source=roughgas\n'
            )
            rows = np.hstack(list(columns.values())).tolist()
            for symbol, row in zip(_symbols(values), rows, strict=True):
                file.write(f"{symbol} {' '.join(map(repr, row))}\n")
            file.flush()

        yield append


def _columns(frame: FileFrame, values: Variables) -> dict[str, np.ndarray]:
    """Return the columns (N, width) of a frame of extended XYZ, by the names that programs read."""
    mass = _masses(values)[:, None]
    columns = {"pos": frame.position, "velo": frame.velocity, "radius": values["radius"][:, None]}
    if "species_of" in values:
        columns["kind"] = values["species_of"].astype(float)[:, None]
    if frame.spin is not None:
        columns["omega"] = frame.spin
    if frame.angle is not None:
        columns["angle"] = frame.angle[:, None]
    # ASE derives velocities from momenta and masses
    return columns | {"masses": mass, "momenta": mass * frame.velocity}


def _symbols(values: Variables) -> list[str]:
    """Return a symbol for each particle: X, or in a mixture the element for its species."""
    if "species_of" not in values:
        return [NO_ELEMENT] * len(values["radius"])
    return [ELEMENTS[kind % len(ELEMENTS)] for kind in values["species_of"].tolist()]


def _masses(values: Variables) -> np.ndarray:
    """Return the mass of each particle in units of m, (N,)."""
    return values["mass"] if "mass" in values else np.ones(len(values["radius"]))


@contextmanager
def _amber(path: Path, title: str) -> Iterator["Append"]:
    """Open a new netCDF file by AMBER's conventions, and yield a function that appends a frame.

    `title` is a global attribute of the file.
    """
    import netCDF4

    with netCDF4.Dataset(path, "w", format="NETCDF3_64BIT_OFFSET") as file:
        file.setncatts(AMBER | {"programVersion": __version__, "title": title})

        def append(frame: FileFrame, values: Variables) -> None:
            if not file.dimensions:
                _describe(file, frame, values)
            number = len(file.dimensions["frame"])
            for name, (present, _) in _rows(frame).items():
                if present is not None:
                    file[name][number] = present
            file.sync()

        yield append


def _describe(file: "netCDF4.Dataset", frame: FileFrame, values: Variables) -> None:
    """Create the dimensions and variables of an open AMBER file, for frames such as `frame`.

    Variables that are the same in all frames, such as radii, are written from the trajectory's
    variables `values`; the others are left without frames.
    """
    file.createDimension("frame", None)
    sizes = {"atom": len(values["radius"]), "spatial": 3}
    for name, size in (sizes | {"cell_spatial": 3, "cell_angular": 3, "label": 5}).items():
        file.createDimension(name, size)
    _write_labels(file, "spatial", ("spatial",), "xyz")
    _write_labels(file, "cell_spatial", ("cell_spatial",), "abc")
    _write_labels(file, "cell_angular", ("cell_angular", "label"), ["alpha", "beta ", "gamma"])
    for name, per_particle in ({"radius": values["radius"]} | _differing(values)).items():
        _quantity(file, name, ("atom",))[:] = per_particle
    for name, (present, dims) in _rows(frame).items():
        if present is not None:
            _quantity(file, name, ("frame", *dims))


def _quantity(file: "netCDF4.Dataset", name: str, dims: tuple[str, ...]) -> "netCDF4.Variable":
    """Create the variable `name` of UNITS in an AMBER file, with its units, and return it."""
    variable = file.createVariable(name, "f8", dims)
    variable.units, variable.true_units = UNITS[name]
    if name in SCALED:
        variable.scale_factor = 1.0
    return variable


def _rows(frame: FileFrame) -> dict[str, tuple[Any, tuple[str, ...]]]:
    """Return the values of AMBER's variables in a frame, each with its dimensions, by name.

    The value of a missing quantity is None.
    """
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


def _differing(values: Variables) -> dict[str, np.ndarray]:
    """Return mass and species number of each particle, (N,), by AMBER's names, of a mixture.

    Without species there are none.
    """
    if "species_of" not in values:
        return {}
    return {"mass": values["mass"], "kind": values["species_of"].astype(float)}


def _write_labels(file: "netCDF4.Dataset", name: str, dims: tuple[str, ...], letters: Any) -> None:
    """Create a variable of characters in an AMBER file, and write its labels, such as "xyz"."""
    characters = np.array(
        [list(word) for word in letters] if len(dims) == 2 else list(letters), "S1"
    )
    file.createVariable(name, "S1", dims)[:] = characters


def lengths_and_angles(cell: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the lengths (3,) of a cell's vectors, and the angles (3,) between them in degrees.

    `cell` (3, 3) has the vectors as rows. The angles are alpha (second and third vector), beta and
    gamma.
    """
    lengths = np.linalg.norm(cell, axis=1)
    unit = cell / lengths[:, None]
    cosines = [unit[1] @ unit[2], unit[0] @ unit[2], unit[0] @ unit[1]]
    return lengths, np.degrees(np.arccos(cosines))


@contextmanager
def _gsd(path: Path, title: str, double: bool = False) -> Iterator["Append"]:
    """Open a new file of HOOMD at `path`, and yield a function that appends a frame to it.

    The format has no place for the `title`.
    """
    hoomd = import_extra("gsd.hoomd")
    with hoomd.open(path, "w", **({PRECISION: "double"} if double else {})) as file:

        def append(frame: FileFrame, values: Variables) -> None:
            shot = _shot(hoomd.Frame(), len(file), frame, values)
            if double:  # gsd rounds the box to single precision in any case
                shot.log["box"] = np.array(shot.configuration.box)
            file.append(shot)
            file.file.flush()

        yield append


def _shot(shot: Any, step: int, frame: FileFrame, values: Variables) -> Any:
    """Fill in and return `shot`, an empty frame of HOOMD, as number `step` of the file.

    `values` are the variables of the trajectory.
    """
    dimension, number = len(values["box"]), len(values["radius"])
    shot.configuration.step = step
    shot.configuration.dimensions = dimension
    # an open axis extends as far below zero, so that the floor keeps its position
    upward = np.append(np.isnan(values["box"]), False)[:3]
    cell = frame.cell * np.where(upward, 2.0, 1.0)[:, None]
    lengths, tilt = np.diag(cell), cell[1, 0] / cell[1, 1]
    depth = lengths[2] * (dimension == 3)  # 0 marks a two-dimensional box
    shot.configuration.box = [*lengths[:2], depth, _reduced_tilt(tilt, lengths), 0.0, 0.0]
    shot.particles.N = number
    shot.particles.types = [NO_ELEMENT]
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
    shot.log["origin"] = np.where(upward, 0.0, -0.5 * np.diag(cell)) * [1.0, 1.0, dimension == 3]
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


def _orientation(frame: FileFrame) -> np.ndarray:
    """Return the unit quaternions (N, 4) of disks; identity for spheres, which have no angle."""
    half = np.zeros(len(frame.position)) if frame.angle is None else frame.angle / 2.0
    zero = np.zeros_like(half)
    return np.stack([np.cos(half), zero, zero, np.sin(half)], axis=1)


def _rotation(frame: FileFrame, values: Variables) -> tuple[np.ndarray, np.ndarray]:
    """Return moments of inertia (N, 3) in m a^2, and angular momenta (N, 3) in m a^2/T.

    Disks turn around z alone: in HOOMD the moments along the other axes are 0.
    """
    axes = [1.0, 1.0, 1.0] if len(values["box"]) == 3 else [0.0, 0.0, 1.0]
    assert frame.spin is not None
    moment = values["moment_of_inertia"][:, None]
    # the spin is the velocity of the surface
    return moment * axes, moment * frame.spin / values["radius"][:, None]


def _doubled_product(orientation: np.ndarray, momentum: np.ndarray) -> np.ndarray:
    """Return HOOMD's angular momentum, the quaternions 2 q (0, L), (N, 4).

    `orientation` are the quaternions q (N, 4), `momentum` the angular momenta L (N, 3) in the frame
    of the body.
    """
    real, imaginary = orientation[:, :1], orientation[:, 1:]
    scalar = -np.sum(imaginary * momentum, axis=1, keepdims=True)
    vector = real * momentum + np.cross(imaginary, momentum)
    return 2.0 * np.hstack([scalar, vector])


def _reduced_tilt(tilt, lengths):
    """Return the tilt of the same lattice whose shift is within half of the first side.

    `tilt` is the shift of the second vector along the first axis over its height, `lengths` the
    sides of the cell in a.
    """
    period = lengths[0] / lengths[1]
    return tilt - period * round(tilt / period)


def _centred(position, cell, upward, dimension):
    """Return positions (N, 3) relative to the middle of a cell and folded into it, for HOOMD.

    `cell` (3, 3) has its vectors as rows; axes in the mask `upward` (3,) keep their origin, and in
    two dimensions z is 0.
    """
    lengths = np.diag(cell)
    shift = lengths[1] * _reduced_tilt(cell[1, 0] / lengths[1], lengths)
    position = position - np.where(upward, 0.0, 0.5 * lengths)
    position[:, 2] *= dimension == 3
    # fold x between the slanted faces of the sheared cell
    slant = shift * position[:, 1] / lengths[1]
    across = position[:, 0] - slant
    position[:, 0] -= lengths[0] * np.floor(across / lengths[0] + 0.5)
    return position


Append = Callable[[FileFrame, Variables], None]
FORMATS: dict[str, Callable[[Path, str], AbstractContextManager[Append]]] = {
    ".xyz": _xyz,
    ".nc": _amber,
    ".gsd": _gsd,
}
"""Opens a file for appending frames, with a title, by its suffix."""


def _format(
    path: str | Path, double: bool
) -> Callable[[Path, str], AbstractContextManager[Append]]:
    """Return the function that opens a file with the suffix of `path`, in some precision."""
    suffix = Path(path).suffix
    return partial(_gsd, double=True) if double and suffix == ".gsd" else FORMATS[suffix]
