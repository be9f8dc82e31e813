"""The values of options: numbers, lists, and output files, which may replace only earlier files of
the same type.

`key` is the name of an option in messages, such as --frames.
"""

import re
from collections.abc import Iterable
from decimal import Decimal
from pathlib import Path

from roughgas.base import InputError, Interval, Record
from roughgas.base.files import check_writable

RANGE = re.compile(r"([^:]+):([^:]+):([^:]+)")
MAX_LABELS = 100_000  # written as START:STOP:STEP


def whole_number(key: str, text: str, low: int, high: int) -> int:
    """Return the whole number in `text`, the value of the option `key`. Raises InputError outside
    [low, high]."""
    if text.isdecimal() and low <= int(text) <= high:
        return int(text)
    raise InputError(key, text, f"be a whole number in [{low}, {high}]")


def number(key: str, text: str, legal: Interval | None = None) -> float:
    """Return the number in `text`, the value of the option `key`. Raises InputError if it is no
    number, or outside `legal`."""
    try:
        value = float(text)
    except ValueError:
        raise InputError(key, text, "be a number") from None
    return legal.check(key, value) if legal else value


def labels(key: str, texts: str | Iterable[str]) -> list[str]:
    """Return the labels in `texts`, the value of the option `key`, as a list: a single label, or a
    list with its ranges START:STOP:STEP expanded.

    Raises InputError for an illegal range.
    """
    if isinstance(texts, str):
        return [texts]
    return [label for text in texts for label in _range_labels(key, text)]


def _range_labels(key: str, text: str) -> list[str]:
    """Return the labels from START to STOP (included) of a range in exact decimals; [text] if it is
    no range. Raises InputError for an illegal range."""
    ends = RANGE.fullmatch(text)
    if ends is None:
        return [text]
    try:
        start, stop, step = (Decimal(end) for end in ends.groups())
        count = int((stop - start) / step) + 1
    except (ArithmeticError, ValueError):
        raise InputError(key, text, "be START:STOP:STEP, such as -1:1:0.1") from None
    if not 0 < count <= MAX_LABELS or stop < start:
        raise InputError(key, text, f"go up from START to STOP in at most {MAX_LABELS:,} steps")
    return [str(start + k * step) for k in range(count)]


INPUTS = ("inputs", "input", "files", "start_from", "config")
"""Parameters of commands that name input files."""
DATASETS = ("POINT", "REDUCED")  # as roughgas.data.netcdf has them
MAGIC_BYTES = {
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
"""Patterns of the first bytes of files, by type: as in Command.writes, or the suffix."""
MAGIC_LENGTH = 100  # bytes read to recognise the type of a file


def paths_of(options: Record, names: Iterable[str]) -> list[Path]:
    """Return the paths in the arguments of a command (`options`, by parameter) called `names`: each
    is a path, a list of paths, None, or absent."""
    values = (options.get(name) for name in names)
    lists = (value if isinstance(value, list) else [value] for value in values)
    return [Path(path) for paths in lists for path in paths if isinstance(path, str | Path)]


def check_outputs(outputs: Iterable[str | Path], inputs: Iterable[str | Path], writes: str) -> None:
    """Raise InputError for an output that would replace another output, a path in `inputs`, or a
    file of another type, or whose folder does not exist; OSError if it could not be written.

    `writes` is the type of all outputs: a key of MAGIC_BYTES, or a name in DATASETS; "" if their
    suffixes tell it.
    """
    resolved: set[Path] = set()
    sources = list(map(Path, inputs))
    for path in map(Path, outputs):
        if path.resolve() in resolved:
            raise InputError("--output", path, "be named once")
        resolved.add(path.resolve())
        if any(source.exists() and path.exists() and path.samefile(source) for source in sources):
            raise InputError("--output", path, "be another file than those that are read")
        if not path.parent.is_dir():
            raise InputError("--output", path, "lie in a folder that exists")
        check_writable(path)
        _check_kind(path, writes or path.suffix)


def _check_kind(path: Path, kind: str) -> None:
    """Raise InputError if `path` is a folder, or a file that has content, but not of the type
    `kind`.

    `kind` is a key of MAGIC_BYTES or a name in DATASETS; for an unknown suffix any content is
    legal.
    """
    if path.is_dir():
        raise InputError("--output", path, "be a file, and is a folder")
    if not path.is_file() or not path.stat().st_size:
        return
    if kind in DATASETS:
        from roughgas.data import netcdf

        kind = getattr(netcdf, kind)
        fits = netcdf.is_of_type(path, kind)
    else:
        with path.open("rb") as file:
            fits = bool(re.match(MAGIC_BYTES.get(kind, b""), file.read(MAGIC_LENGTH)))
    if not fits:
        raise InputError("--output", path, f"be new, or hold {kind}: it holds something else")
