"""Frames of particles in files of other programs: LAMMPS, extended XYZ, GSD.

The format follows from the content of a file, not from its name.
"""

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

from roughgas.base import InputError
from roughgas.data.other_programs import extended_xyz, gsd, lammps
from roughgas.data.other_programs.particles import FileParticles, Units, in_gas_units

if TYPE_CHECKING:
    import xarray

__all__ = ["LAST_FRAME", "Units", "is_of_other_program", "read_frame"]

LAST_FRAME = -1
UNITS_OF_FIRST_SPECIES = Units()
RECOGNISED_BYTES = 100_000
Reader = Callable[[str | Path, int], FileParticles]


def is_of_other_program(path: str | Path) -> bool:
    """Return whether `read_frame` knows the format of a file; OSError if it cannot be read."""
    return _reader(path) is not None


def read_frame(
    path: str | Path, frame: int = LAST_FRAME, units: Units = UNITS_OF_FIRST_SPECIES
) -> "xarray.Dataset":
    """Return the particles in a frame of a file, in the units of a gas, as the start of a run.

    The frame counts from 0, or from the end if negative. Variables have the names and units of
    `roughgas.data.states`. Raises InputError for an unknown format, another
    content, and a unit that is needed; ImportError without the package gsd for its files; OSError.
    """
    reader = _reader(path)
    if reader is None:
        legal = "be a LAMMPS data or dump file, extended XYZ, or GSD: its content is of none"
        raise InputError("file", path, legal)
    return in_gas_units(reader(path, frame), units, f"{path}, frame {frame}")


def _reader(path: str | Path) -> Reader | None:
    """Return the function that reads the format of a file; None for an unknown format."""
    if not Path(path).is_file():
        return None
    with open(path, "rb") as file:
        content = file.read(RECOGNISED_BYTES)
    if gsd.is_gsd(content):
        return gsd.read_gsd
    if b"\0" in content:
        return None
    text = content.decode("utf-8", "replace").replace("\r\n", "\n")
    if lammps.is_dump(text):
        return lammps.read_dump
    if extended_xyz.is_extended_xyz(text):
        return extended_xyz.read_extended_xyz
    return lammps.read_data if lammps.is_data(text) else None
