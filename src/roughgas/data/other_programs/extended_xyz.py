"""Extended XYZ: a number of particles, a line of KEY=VALUE with the names of columns, the columns.

OVITO's page on XYZ files and its exporter define the format and the names of columns. ASE writes
momenta in place of velocities.
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
from roughgas.data.other_programs.text import AXES, Rows, Table, TextFile, chosen_frame, text_file

HEADER = re.compile(r"\s*\d+\s*\n.*\bProperties=")
PAIR = re.compile(r'(\w+)=(?:"([^"]*)"|(\S+))')
PROPERTIES = re.compile(r"(\w+):([SRIL]):(\d{1,3})")
VECTORS = ("pos", "velo", "vel", "velocity", "velocities", "momenta", "omega", "angular_velocity")
OWN_SOURCE = "roughgas"
"""Value of `source` in files of roughgas, whose column omega has velocities of the surface."""


def is_extended_xyz(text: str) -> bool:
    """Return whether a file that begins with `text` is extended XYZ."""
    return HEADER.match(text) is not None


class XyzFrame(NamedTuple):
    """A frame of a file, as text."""

    path: str | Path
    line: int  # number of the line of keys
    keys: dict[str, str]
    rows: Rows

    def box(self) -> tuple[np.ndarray, np.ndarray]:
        """Return the corner and the sides of the box, (3,) each; raise InputError for a tilt."""
        vectors = self._numbers("Lattice", 9, None).reshape(3, 3)
        lengths = np.diag(vectors)
        if np.any(vectors != np.diag(lengths)) or np.any(lengths <= 0.0):
            raise self._error("Lattice", "be a rectangular box, without tilt")
        return self._numbers("Origin", 3, "0 0 0"), lengths

    def _numbers(self, key: str, count: int, default: str | None) -> np.ndarray:
        """Return the `count` numbers of a key; raise InputError for others, or without the key."""
        text = self.keys.get(key, default)
        try:
            numbers = np.array((text or "").split(), float)
        except ValueError:
            numbers = np.empty(0)
        if len(numbers) != count or not np.isfinite(numbers).all():
            raise self._error(key, f"be {count} finite numbers")
        return numbers

    def _error(self, key: str, legal: str) -> InputError:
        """Return the error of an illegal value of a key."""
        value = short_repr(self.keys[key]) if key in self.keys else "(nothing)"
        return InputError(f"{self.path}, line {self.line}, {key}", value, legal)


def read_extended_xyz(path: str | Path, frame: int) -> FileParticles:
    """Return the particles in a frame of extended XYZ. Raises InputError for another content."""
    with text_file(path) as file:
        chosen = chosen_frame(_frames(file), frame, path)
    origin, lengths = chosen.box()
    table = chosen.rows.table()
    table.require("posx")
    position = table.vectors("pos*")
    mass = table.positive("masses", "mass")
    velocity = table.vectors("velo*", "vel*", "velocity*", "velocities*")
    if velocity is None and mass is not None:
        momenta = table.vectors("momenta*")
        velocity = None if momenta is None else momenta / mass[:, None]
    if velocity is None:
        table.require("velox")
    omega = table.vectors("omega*", "angular_velocity*")
    is_own = chosen.keys.get("source") == OWN_SOURCE
    species, names = _species(table)
    assert position is not None and velocity is not None
    return FileParticles(
        position=position,
        velocity=velocity,
        angular_velocity=None if is_own else omega,
        surface_velocity=omega if is_own else None,
        radius=table.radius(),
        mass=mass,
        species=species,
        names=names,
        origin=origin,
        lengths=lengths,
        dimension=dimension_of(position, velocity, omega),
    )


def _frames(file: TextFile) -> Iterator[XyzFrame]:
    """Yield the frames of a file; raise InputError for a file that is cut off, and for another
    content."""
    for line in file:
        if not line:
            continue
        count = file.count(line)
        header = file.line("keys such as Properties")
        keys = {key: quoted or bare for key, quoted, bare in PAIR.findall(header)}
        number, columns = file.number, _columns(file, keys.get("Properties", ""))
        yield XyzFrame(file.path, number, keys, file.rows(count, columns))


def _columns(file: TextFile, properties: str) -> list[str]:
    """Return the names of the columns that the value of the key Properties lists.

    The components of a vector have the letter of an axis at their ends. Raises InputError for a
    value of another form.
    """
    listed = PROPERTIES.findall(properties)
    if not listed or ":".join(":".join(entry) for entry in listed) != properties:
        file.refuse(properties, "have Properties=NAME:TYPE:COLUMNS:...")
    columns = []
    for name, _, width in listed:
        if int(width) == 1:
            columns.append(name)
        elif name in VECTORS and int(width) <= len(AXES):
            columns += [f"{name}{axis}" for axis in AXES[: int(width)]]
        else:
            columns += [f"{name}[{k}]" for k in range(int(width))]
    return columns


def _species(table: Table) -> tuple[np.ndarray, tuple[str, ...]]:
    """Return the species (N,) of particles, from 0, and their names in the order of the numbers.

    The column `kind` of roughgas has numbers; names are numbered as they appear first.
    """
    if "kind" in table.columns:
        return table.integers("kind", 0, LARGEST_SPECIES), ()
    column = next((name for name in ("species", "type") if name in table.columns), None)
    words = [""] * len(table.words) if column is None else table.texts(column)
    names = list(dict.fromkeys(words))
    numbers = {name: number for number, name in enumerate(names)}
    return np.array([numbers[word] for word in words]), tuple(names)
