"""The one place that says what a file is: of which kind, whole, and of a size that memory can hold.

A file is checked before anything is read from it: whatever program wrote it, and whatever a disk
has done to it since.
"""

import errno
import hashlib
import math
import os
from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from roughgas.base.errors import InputError, shown
from roughgas.base.layout import from_json

if TYPE_CHECKING:
    import netCDF4

SCHEMA_VERSION = 2
CHECKSUM = "checksum"
LARGEST = 4e9  # bytes that a file may say it holds
NUMBER, WHOLE, WORD, JSON = "a number", "a whole number", "text", "a JSON object"
ATTRIBUTES = {
    "schema_version": WHOLE,
    **dict.fromkeys(("seed", "dimension", "particles"), WHOLE),
    **dict.fromkeys(("r", "beta", "inertia", "spin_share", "mu", "packing"), NUMBER),
    **dict.fromkeys(("experiment", "scale", "r_label", "beta_label", "command", "swept"), WORD),
    **dict.fromkeys(("variant", "theory", "study", "task", CHECKSUM), WORD),
    **dict.fromkeys(("experiment_json", "settings_json"), JSON),
}
"""What the attributes that are read must be, where they are there."""


class Kind(NamedTuple):
    """What a file of a kind has at least."""

    attributes: frozenset[str]
    variables: frozenset[str]


POINT, REDUCED, FILM = "a point", "a reduced dataset", "a film of a cooling gas"
TASK, STUDIES = "a task of a study", "a dataset of studies"
KINDS = {
    TASK: Kind(frozenset({"study", "task"}), frozenset()),
    FILM: Kind(frozenset(), frozenset({"disks", "disk_spin", "R"})),
    REDUCED: Kind(
        frozenset({"experiment", "scale", "dimension", "particles"}),
        frozenset({"r", "beta", "n_seeds", "E_trans", "equilibrated"}),
    ),
    POINT: Kind(
        frozenset({"experiment", "scale", "r", "beta", "seed", "dimension", "particles"}),
        frozenset({"E_trans", "collisions", "kernel_seconds", "equilibrated"}),
    ),
}
"""The kinds of files without groups, the first one that fits being meant."""


class DamagedError(InputError):
    """A file that does not hold what was once written to it."""


@contextmanager
def opened(path: str | Path, *kinds: str) -> Iterator["netCDF4.Dataset"]:
    """Open the netCDF file at `path`, of one of `kinds` (by default any), to read.

    Raises InputError for files of other programs, of other kinds and of newer schemas, and for
    files that claim to be larger than LARGEST; DamagedError where the checksum is not that of the
    contents; OSError where there is no file.
    """
    import netCDF4

    if not Path(path).exists():
        raise FileNotFoundError(errno.ENOENT, os.strerror(errno.ENOENT), str(path))
    try:
        file = netCDF4.Dataset(path)
    except (OSError, RuntimeError, UnicodeError) as error:
        legal = "be a dataset of roughgas: it is of another program, or cut off, or damaged"
        raise DamagedError("file", shown(str(path)), legal) from error
    with file:
        _check_attributes(file, path)
        _check_size(file, path)
        _check_whole(file, path)
        if (found := kind_of(file)) not in (kinds or (*KINDS, STUDIES)):
            wanted = " or ".join(kinds) or "a dataset of roughgas"
            other = f", not {found}" if found else ""
            raise InputError("file", shown(str(path)), f"be {wanted}{other}")
        yield file


def kind_of(file: "netCDF4.Dataset") -> str | None:
    """Return the kind of an open file; None if it is of none."""
    if file.groups:
        return STUDIES
    attributes, variables = set(file.ncattrs()), set(file.variables)
    fits = (k for k, one in KINDS.items() if attributes >= one[0] and variables >= one[1])
    return next(fits, None)


def attributes_of(file: "netCDF4.Dataset") -> dict[str, Any]:
    """Return the global attributes of an open file, but for its checksum."""
    return {name: file.getncattr(name) for name in file.ncattrs() if name != CHECKSUM}


def checksum(file: "netCDF4.Dataset") -> str:
    """Return a checksum of all variables and attributes of an open file, its groups included."""
    found = hashlib.sha256()
    _add(found, file)
    return f"sha256:{found.hexdigest()}"


def require(attributes: Mapping[str, Any], names: Iterable[str], path: str | Path) -> None:
    """Raise InputError for the first of the attributes `names` that the file does not have."""
    for name in names:
        if name not in attributes:
            raise InputError(f"attribute {name} of {path}", "(nothing)", "be given")


def _add(found: Any, group: Any) -> None:
    found.update(_text(attributes_of(group)))
    for name in sorted(group.variables):
        variable = group[name]
        variable.set_auto_maskandscale(False)
        values = variable[...]
        words = values.dtype == object
        found.update(f"{name} {variable.dimensions} {values.shape} {values.dtype}".encode())
        found.update(_text({k: variable.getncattr(k) for k in variable.ncattrs()}))
        found.update("\0".join(map(str, values.flat)).encode() if words else values.tobytes())
    for name in sorted(group.groups):
        found.update(name.encode())
        _add(found, group[name])


def _text(attributes: Mapping[str, Any]) -> bytes:
    plain = {name: np.asarray(value).tolist() for name, value in attributes.items()}
    return repr(sorted(plain.items())).encode()


def _check_attributes(file: "netCDF4.Dataset", path: str | Path) -> None:
    for name, value in attributes_of(file).items():
        wanted = ATTRIBUTES.get(name)
        if wanted and not _fits(value, wanted):
            raise InputError(f"{name} of {path}", shown(value), f"be {wanted}")
        if wanted == JSON:
            from_json(value, f"{name} of {path}")
    version = getattr(file, "schema_version", SCHEMA_VERSION)
    if version > SCHEMA_VERSION:
        legal = f"be at most {SCHEMA_VERSION}: a newer roughgas has written the file"
        raise InputError(f"schema_version of {path}", version, legal)


def _fits(value: Any, wanted: str) -> bool:
    if wanted in (WORD, JSON):
        return isinstance(value, str)
    is_number = np.ndim(value) == 0 and np.asarray(value).dtype.kind in "iuf"
    return bool(is_number and math.isfinite(value) and (wanted == NUMBER or value == int(value)))


def _check_size(file: "netCDF4.Dataset", path: str | Path) -> None:
    groups = (file, *file.groups.values())
    size = sum(8.0 * math.prod(one.shape) for group in groups for one in group.variables.values())
    if size > LARGEST:
        raise InputError(f"size of {path}", f"{size:.3g} bytes", f"be at most {LARGEST:.0g}")


def _check_whole(file: "netCDF4.Dataset", path: str | Path) -> None:
    stated = getattr(file, CHECKSUM, None)
    try:
        whole = stated is None or stated == checksum(file)
    except (RuntimeError, OSError, UnicodeError):
        whole = False
    if not whole:
        legal = "be what was once written to it: it is damaged"
        raise DamagedError("file", shown(str(path)), legal)
