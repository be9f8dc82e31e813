"""Where a command writes: nothing is replaced but an earlier file of the same kind."""

import re
from argparse import Namespace
from collections.abc import Iterable
from pathlib import Path

from roughgas.base.errors import InputError
from roughgas.base.files import check_place

INPUTS = ("inputs", "input", "files", "start_from", "config")
FOLDER = "a folder"
DATASETS = ("POINT", "REDUCED")  # as roughgas.data.netcdf has them
BEGINNINGS = {
    "a crate": rb"PK",
    ".nc": rb"\x89HDF|CDF",
    ".xyz": rb"\d+\n",
    ".gsd": rb"[\s\S]",
    ".png": rb"\x89PNG",
    ".pdf": rb"%PDF",
    ".svg": rb"<(\?xml|svg)",
    ".gif": rb"GIF8",
    ".mp4": rb"....ftyp",
}
"""How files begin, by what a command writes, or by their ending."""
LONGEST = 100  # bytes of a beginning


def check_outputs(options: Namespace, more: Iterable[str | Path] = ()) -> None:
    """Raise InputError for an output that would replace another output, an input, or a file of
    another kind, and for one in a folder that is not there; OSError where it could not be written.

    `more` are outputs that the command line does not name.
    """
    named, inputs = (
        [path for option in those for path in _paths(getattr(options, option, None))]
        for those in (("output",), INPUTS)
    )
    seen: set[Path] = set()
    for path in [*named, *map(Path, more)]:
        if path.resolve() in seen:
            raise InputError("--output", path, "be named once")
        seen.add(path.resolve())
        if any(one.exists() and path.exists() and path.samefile(one) for one in inputs):
            raise InputError("--output", path, "be another file than those that are read")
        if not path.parent.is_dir():
            raise InputError("--output", path, "lie in a folder that exists")
        check_place(path)
        _check_kind(path, options.command.writes or path.suffix)


def _paths(given: object) -> list[Path]:
    """Return the paths that an option is given; a flag is none."""
    several = given if isinstance(given, list) else [given]
    return [Path(one) for one in several if isinstance(one, str | Path)]


def _check_kind(path: Path, kind: str) -> None:
    """Raise InputError where what is at `path` is not of this kind; an empty file is of any."""
    if path.is_dir() and kind != FOLDER:
        raise InputError("--output", path, "be a file, and is a folder")
    if not path.is_file() or not path.stat().st_size:
        return
    if kind in DATASETS:
        from roughgas.data import netcdf

        name = getattr(netcdf, kind)
        if not netcdf.is_of_kind(path, name):
            raise _another(path, name)
        return
    with path.open("rb") as file:
        fits = bool(re.match(BEGINNINGS.get(kind, b""), file.read(LONGEST)))
    if kind == FOLDER or not fits:
        raise _another(path, kind)


def _another(path: Path, kind: str) -> InputError:
    return InputError("--output", path, f"be new, or hold {kind}: it holds something else")
