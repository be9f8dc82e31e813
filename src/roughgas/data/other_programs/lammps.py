"""LAMMPS: data files of atom_style sphere, as write_data makes them, and text files of dump custom.

The pages read_data, write_data and dump of the LAMMPS documentation define the formats. ASE reads
both files, but neither diameters nor angular velocities (ase.io.lammpsdata has no style
sphere, ase.io.lammpsrun leaves out columns such as radius and omegax).
"""

import re
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

import numpy as np

from roughgas.base import InputError, short_repr
from roughgas.data.other_programs.particles import (
    LARGEST_SPECIES,
    FileParticles,
    dimension_of,
)
from roughgas.data.other_programs.text import (
    AXES,
    Rows,
    Table,
    TextFile,
    check_frame,
    chosen_frame,
    text_file,
)

ITEM = "ITEM: "
ATOMS_LINE = re.compile(r"^\s*\d+\s+atoms\s*(#.*)?$", re.MULTILINE)
NO_TILT = "be a rectangular box, without tilt"
SPHERE_COLUMNS = ("id", "type", "diameter", "density", "x", "y", "z")
IMAGE_COLUMNS = ("ix", "iy", "iz")
VELOCITY_COLUMNS = ("id", "vx", "vy", "vz", "omegax", "omegay", "omegaz")
STYLES = ("sphere", "granular")  # granular: before 2009
DEFAULT_BOUNDS = (-0.5, 0.5)


def is_dump(text: str) -> bool:
    """Return whether a file that begins with `text` is a dump."""
    return text.startswith(ITEM)


def is_data(text: str) -> bool:
    """Return whether a file that begins with `text` is a data file."""
    return ATOMS_LINE.search(text) is not None


class DumpFrame(NamedTuple):
    """A frame of a dump, as text."""

    path: str | Path
    bounds_line: int  # number of the line of the box
    bounds_header: str
    bounds: list[list[float]]
    rows: Rows

    def origin_and_lengths(self) -> tuple[np.ndarray, np.ndarray]:
        """Return the corner and the sides of the box, (3,) each; raise InputError for a tilt."""
        bounds = np.array(self.bounds)
        if "abc" in self.bounds_header or bounds[:, 2:].any():
            key = f"{self.path}, line {self.bounds_line}"
            raise InputError(key, short_repr(self.bounds_header), NO_TILT)
        lengths = bounds[:, 1] - bounds[:, 0]
        for axis in np.flatnonzero(lengths <= 0.0):
            key = f"{self.path}, line {self.bounds_line + 1 + axis}"
            raise InputError(key, short_repr(self.bounds[axis]), "be two rising numbers")
        return bounds[:, 0], lengths


def read_dump(path: str | Path, frame: int) -> FileParticles:
    """Return the particles in a frame of a dump. Raises InputError for another content."""
    with text_file(path) as file:
        chosen = chosen_frame(_dump_frames(file), frame, path)
    origin, lengths = chosen.origin_and_lengths()
    table = chosen.rows.table()
    table.require("x or xu or xs or xsu")
    position = table.vectors("*", "*u")
    if position is None:
        scaled = table.vectors("*s", "*su")
        assert scaled is not None
        position = origin + lengths * scaled
    table.require("vx")
    velocity, omega = table.vectors("v*"), table.vectors("omega*")
    assert velocity is not None
    return FileParticles(
        position=position,
        velocity=velocity,
        angular_velocity=omega,
        radius=table.radius(),
        mass=table.positive("mass"),
        species=_species(table),
        names=(),
        origin=origin,
        lengths=lengths,
        dimension=dimension_of(position, velocity, omega),
    )


def _dump_frames(file: TextFile) -> Iterator[DumpFrame]:
    """Yield the frames of a dump; raise InputError for a dump that is cut off, and for another
    content."""
    count, box = None, None
    for line in file:
        name = line.removeprefix(ITEM)
        if name == line:
            file.refuse(line, f"begin with {ITEM.strip()}")
        if name == "NUMBER OF ATOMS":
            count = file.count(file.line("the number of atoms"))
        elif name.startswith("BOX BOUNDS"):
            width = 4 if "abc" in name else 3 if "xy" in name else 2
            box = file.number, name, [_bounds(file, axis, width) for axis in AXES]
        elif name.startswith("ATOMS"):
            if count is None or box is None:
                file.refuse(line, "follow the items NUMBER OF ATOMS and BOX BOUNDS")
            yield DumpFrame(file.path, *box, file.rows(count, name.split()[1:]))
            count, box = None, None
        else:  # TIMESTEP, TIME, UNITS
            file.line(f"the value of {name}")
    if count is not None:
        file.line("the item ATOMS")


def _bounds(file: TextFile, axis: str, width: int) -> list[float]:
    """Return the numbers in the next line: the bounds of the box along an axis, and a tilt."""
    return file.numbers(file.line(f"the bounds along {axis}"), width)


def _species(table: Table) -> np.ndarray:
    """Return the species (N,) of particles, from 0: the types of LAMMPS count from 1."""
    if "type" not in table.columns:
        return np.zeros(len(table.words), np.int64)
    return table.integers("type", 1, LARGEST_SPECIES) - 1


def read_data(path: str | Path, frame: int) -> FileParticles:
    """Return the particles in a data file. Raises InputError for another content.

    The file has one frame. Also disks have the masses of spheres, as LAMMPS computes them.
    """
    check_frame(frame, 1, path)
    with text_file(path) as file:
        count, bounds, sections = _header_and_sections(file)
    atoms = _section(path, sections, "Atoms", count).table()
    velocities = _section(path, sections, "Velocities", count).table()
    for row in np.flatnonzero(velocities.values("id") != atoms.values("id")):
        legal = "be the number of a particle in the section Atoms"
        velocities.refuse(row, "id", velocities.texts("id")[row], legal)
    position, velocity = atoms.vectors("*"), velocities.vectors("v*")
    omega = velocities.vectors("omega*")
    diameter, density = atoms.positive("diameter"), atoms.positive("density")
    assert position is not None and velocity is not None
    assert diameter is not None and density is not None
    low, high = np.array(bounds).T
    return FileParticles(
        position=position,
        velocity=velocity,
        angular_velocity=omega,
        radius=diameter / 2.0,
        mass=np.pi / 6.0 * diameter**3 * density,
        species=_species(atoms),
        names=(),
        origin=low,
        lengths=high - low,
        dimension=dimension_of(position, velocity, omega),
    )


class Section(NamedTuple):
    """A section of a data file: its heading and its lines, with their numbers in the file."""

    heading: str
    number: int
    numbers: list[int]
    lines: list[str]


def _header_and_sections(
    file: TextFile,
) -> tuple[int, list[tuple[float, float]], dict[str, Section]]:
    """Return the number of atoms, the bounds of the box along each axis, and the sections by name.

    Raises InputError for a tilted box, for illegal numbers, and for a section twice.
    """
    count, bounds = 0, dict.fromkeys(AXES, DEFAULT_BOUNDS)
    sections: dict[str, Section] = {}
    section = None
    file.line("a title")
    for line in file:
        text, _, comment = (words.strip() for words in line.partition("#"))
        if text[:1].isalpha():
            if text in sections:
                file.refuse(line, "begin a section for the first time")
            section = sections[text] = Section(comment, file.number, [], [])
        elif text and section is not None:
            section.numbers.append(file.number)
            section.lines.append(text)
        elif text.endswith(" atoms"):
            count = file.count(text.split()[0])
        elif text.endswith(("xy xz yz", "avec", "bvec", "cvec", "abc origin")):
            if text.endswith("xy xz yz") and not any(file.numbers(text[: -len("xy xz yz")], 3)):
                continue
            file.refuse(line, NO_TILT)
        elif text.endswith("hi") and text[-3:-2] in AXES:
            low, high = file.numbers(" ".join(text.split()[:2]), 2)
            if not low < high:
                file.refuse(line, "be two rising numbers")
            bounds[text[-3]] = low, high
    if not count:
        raise InputError(f"{file.path}: header", "(end)", "have a number of atoms")
    return count, [*bounds.values()], sections


def _section(path: str | Path, sections: dict[str, Section], name: str, count: int) -> Rows:
    """Return the lines of the section `name`, one a particle, with their columns.

    Raises InputError for a section that is missing or cut off, and for another style of atoms.
    """
    if name not in sections:
        raise InputError(f"{path}: sections", ", ".join(sections) or "(none)", f"have {name}")
    section = sections[name]
    if len(section.lines) != count:
        key = f"{path}, line {section.number}: lines of {name}"
        raise InputError(key, len(section.lines), f"be {count}, the number of atoms")
    columns: tuple[str, ...] = VELOCITY_COLUMNS
    if name == "Atoms":
        if section.heading and section.heading not in STYLES:
            key = f"{path}, line {section.number}: atom_style"
            raise InputError(key, short_repr(section.heading), f"be {STYLES[0]}")
        columns = SPHERE_COLUMNS
        if len(section.lines[0].split()) > len(columns):
            columns += IMAGE_COLUMNS
    return Rows(path, section.numbers, section.lines, columns)
