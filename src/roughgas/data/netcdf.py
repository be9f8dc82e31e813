"""The one writer and the one reader of netCDF files, which follow the CF conventions.

A file is checked before anything is read from it: its kind, that it is whole, and that memory can
hold it, whatever program wrote it, and whatever a disk has done to it since.

Files are written with netCDF4 alone: importing xarray would double the start-up of a point's job.

UDUNITS, whose units CF asks for, reads T as tesla and a as a year. A quantity in a gas's own units
has no dimension there: its `units` are 1, and `reduced_units` says what it is a multiple of.
"""

import errno
import hashlib
import math
import os
import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from roughgas.base import (
    RESTITUTION,
    ROUGHNESS,
    InputError,
    Interval,
    __version__,
    from_json,
    shown,
)
from roughgas.base.files import whole_file
from roughgas.data.variables import CLOCKS, Array

if TYPE_CHECKING:
    import netCDF4
    import xarray

SCHEMA_VERSION = 2
COMMON_ATTRIBUTES = {
    "Conventions": "CF-1.11",
    "schema_version": SCHEMA_VERSION,
    "source": f"roughgas {__version__}, event-driven simulation of rough, inelastic particles",
    "history": f"written by roughgas {__version__}; undated: the same run gives the same bytes",
    "references": "S. McNamara and S. Luding, Phys. Rev. E 58, 2247 (1998), "
    "doi:10.1103/PhysRevE.58.2247",
    "comment": "Particle radius a = particle mass m = time unit T = 1; reduced_units of a variable "
    "are in terms of these, of collisions per particle, or of an energy at the start.",
}
UDUNITS = ("1", "s", "1/s")
FIRST = [0], [1], [1]
"""Start, count and stride of a single number, for what netCDF4 itself gets and puts values with:
to find them takes its indexing ten times as long."""
QUALITIES = ("stderr", "dof", "trusted", "ci95", "ci95_trusted")
"""Suffixes of the ancillary variables of <name>, which say how sure it is (<name>_stderr, ...)."""


class Content(NamedTuple):
    """What a file, or a group of it, holds.

    `clocks` are coordinates whose dimension has another name, as a time along `sample`.
    """

    variables: Mapping[str, "Array | xarray.Variable"]
    attributes: Mapping[str, Any]
    clocks: Sequence[str] = CLOCKS


def content_of(dataset: "xarray.Dataset") -> Content:
    """Return what `dataset` holds, whose variables have attributes as those of `described`."""
    clocks = sorted(str(name) for name in dataset.coords if name not in dataset.dims)
    return Content({str(k): one for k, one in dataset.variables.items()}, dataset.attrs, clocks)


def write_netcdf(
    path: str | Path,
    content: Content,
    groups: Mapping[str, Content] | None = None,
) -> None:
    """Write a netCDF4 file with these contents, whole or not at all; parent folders are created.

    The root gets the attributes that all files have. Nothing is compressed: series are noise, which
    a fourth smaller would take a fifth longer to write.
    Raises OSError if the file cannot be written, as on a full disk.
    """
    import netCDF4

    try:
        with whole_file(path) as draft:
            with netCDF4.Dataset(draft, "w") as file:
                _fill(file, content, COMMON_ATTRIBUTES)
                for name, one in (groups or {}).items():
                    _fill(file.createGroup(name), one, {})
            seal(draft)
    except (RuntimeError, PermissionError) as error:  # as netCDF4 says that a disk is full
        reason = f"{error}; is the disk full or the folder read-only?"
        raise OSError(f"cannot write {path}: {reason}") from error


def in_memory(content: Content) -> "xarray.Dataset":
    """Return what `read_netcdf` gives of the file that `write_netcdf` makes, without that file."""
    import netCDF4

    file = netCDF4.Dataset("memory.nc", "w", memory=1)  # never gets to a disk
    _fill(file, content, COMMON_ATTRIBUTES)
    with netCDF4.Dataset("memory.nc", memory=file.close()) as written:
        return _loaded(written)


def read_netcdf(path: str | Path, *kinds: str, group: str | None = None) -> "xarray.Dataset":
    """Return the dataset at `path`, or a group of it, in memory; the file is closed.

    Raises InputError and OSError as `opened` does, which checks that the file is of one of `kinds`.
    """
    with opened(path, *kinds) as file:
        return _loaded(file if group is None else file.groups[group])


def read_groups(path: str | Path) -> "dict[str, xarray.Dataset]":
    """Return all groups of a dataset of studies in memory, by name: the file is checked once.

    Raises InputError and OSError as `opened` does.
    """
    with opened(path, STUDIES) as file:
        return {name: _loaded(group) for name, group in file.groups.items()}


def _loaded(group: "netCDF4.Dataset") -> "xarray.Dataset":
    """Return an open file, or a group of it, in memory; it stays open."""
    import xarray

    return xarray.open_dataset(xarray.backends.NetCDF4DataStore(group)).load()


def _fill(group: "netCDF4.Dataset", content: Content, common: Mapping[str, Any]) -> None:
    group.setncatts({**common, **content.attributes})
    for variable in content.variables.values():
        for dim, length in zip(variable.dims, variable.values.shape, strict=True):
            if dim not in group.dimensions:
                group.createDimension(str(dim), length)
    # Each is defined before any is written to: after a new one netCDF goes over all of them.
    targets = [_defined(group, name, content) for name in content.variables]
    group.set_auto_maskandscale(False)  # nothing is masked or packed: it need not search
    for target, variable in zip(targets, content.variables.values(), strict=True):
        values = variable.values
        put = None if values.shape or target.dtype is str else getattr(target, "_put", None)
        if put is None:
            target[...] = values.astype(object) if target.dtype is str else values
        else:
            put(values, *FIRST)


def number_in(variable: "netCDF4.Variable") -> float | int:
    """Return the number that a variable without dimensions holds."""
    get = None if variable.dimensions else getattr(variable, "_get", None)
    return (variable[...] if get is None else get(*FIRST)).item()


def _defined(group: "netCDF4.Dataset", name: str, content: Content) -> "netCDF4.Variable":
    """Return a new variable of a group, with its attributes and no values."""
    variable = content.variables[name]
    dims, values = tuple(map(str, variable.dims)), variable.values
    words = values.dtype.kind in "OU"
    is_coordinate = name in dims or name in content.clocks
    # CF forbids one in coordinates
    fill = np.nan if values.dtype.kind == "f" and not is_coordinate else None
    target = group.createVariable(name, str if words else values.dtype, dims, fill_value=fill)
    target.setncatts(_attributes(name, content, is_coordinate))
    return target


def _attributes(name: str, content: Content, is_coordinate: bool) -> dict[str, Any]:
    """Return the attributes of a variable: units as CF has them, and what belongs to it."""
    variables = content.variables
    dims, attributes = variables[name].dims, dict(variables[name].attrs)
    is_number = variables[name].values.dtype.kind in "if"
    unit = attributes.pop("units", "1" if is_coordinate and is_number else "")
    units = {"units": unit} if "reduced_units" in attributes else unit_attributes(unit)
    clocks = [c for c in content.clocks if c in variables and set(variables[c].dims) <= set(dims)]
    along = {"coordinates": " ".join(clocks)} if clocks and not is_coordinate else {}
    sure = [f"{name}_{quality}" for quality in QUALITIES if f"{name}_{quality}" in variables]
    ancillary = {"ancillary_variables": " ".join(sure)} if sure else {}
    return attributes | units | ancillary | along


def unit_attributes(unit: str) -> dict[str, str]:
    """Return the attributes that tell a unit, such as "T", "1" or "s/T"; none for "", of words.

    CPU time in terms of a gas's own units is in seconds.
    """
    if not unit:
        return {}
    if unit in UDUNITS:
        return {"units": unit}
    return {"units": "s" if unit.startswith("s/") else "1", "reduced_units": unit}


def unit_of(attributes: Mapping[str, str]) -> str:
    """Return the unit that `unit_attributes` tell; "" for words."""
    return attributes.get("reduced_units", attributes.get("units", ""))


SEAL = b"\nroughgas sha256 "
LARGEST = 4e9  # bytes that a file may say it holds
NUMBER, WHOLE, WORD, JSON = "a number", "a whole number", "text", "a JSON object"
ATTRIBUTES = {
    "schema_version": WHOLE,
    **dict.fromkeys(("seed", "dimension", "particles", "initial_exact", "reseeded"), WHOLE),
    **dict.fromkeys(("r", "beta", "inertia", "spin_share", "mu", "packing", "r_at_speed"), NUMBER),
    **dict.fromkeys(("experiment", "scale", "r_label", "beta_label", "command", "swept"), WORD),
    **dict.fromkeys(("variant", "theory", "study", "task", "initial_digest"), WORD),
    **dict.fromkeys(("experiment_json", "settings_json", "species_json", "langevin_json"), JSON),
}
"""What the attributes that are read must be, where they are there."""
LEGAL = {
    "r": RESTITUTION,
    "beta": ROUGHNESS,
    "seed": Interval("[0, inf)"),
    "dimension": Interval("[2, 3]"),
    "particles": Interval("[1, inf)"),
    "inertia": Interval("(0, 1]"),
    "spin_share": Interval("[0, 1]"),
    "mu": Interval("[0, inf)"),
    "packing": Interval("[0, 1]"),
}
"""Which of these numbers are legal."""


class Kind(NamedTuple):
    """What a file of a kind has at least."""

    attributes: frozenset[str]
    variables: frozenset[str]


POINT, REDUCED = "a point", "a reduced dataset"
TASK, STUDIES = "a task of a study", "a dataset of studies"
SWEPT = re.compile(r"(\w+\.)*\w+")
KINDS = {
    TASK: Kind(frozenset({"study", "task"}), frozenset()),
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
    """A file of roughgas whose checksum proves that it has changed since it was written."""


@contextmanager
def opened(path: str | Path, *kinds: str) -> Iterator["netCDF4.Dataset"]:
    """Open the netCDF file at `path`, of one of `kinds` (by default any), to read.

    Nothing locks the file, and what is read is what the checksum was taken of. Raises InputError
    for files of other programs, of other kinds and of newer schemas, for files that are cut off,
    and for those that claim to be larger than LARGEST; DamagedError where the checksum is not that
    of the contents, and no other process holds the file; OSError where it cannot be read.
    """
    import netCDF4

    place = Path(path)
    if not place.exists():
        why = os.strerror(errno.ENOENT)
        made = place.parts[:1] == ("results",) and place.suffix == ".nc"
        hint = f"{why}; to make it: snakemake -j2 {path}" if made else why
        raise FileNotFoundError(errno.ENOENT, hint, str(path))
    if not place.is_file():  # a pipe would be waited for
        raise InputError("file", path, "be a file")
    _check_size(path, place.stat().st_size)
    content = place.read_bytes()
    _check_seal(content, place)
    try:  # from memory: HDF5 would lock the file, and a disk without locks refuse that
        file = netCDF4.Dataset(path, memory=content)
    except (OSError, RuntimeError, UnicodeError) as error:
        legal = "be a dataset of roughgas: it is of another program, or cut off" + _held(place)
        raise InputError("file", path, legal) from error
    with file:
        _check_attributes(file, path)
        variables = [v for g in (file, *file.groups.values()) for v in g.variables.values()]
        _check_size(path, sum(8.0 * math.prod(variable.shape) for variable in variables))
        if (found := kind_of(file)) not in (kinds or (*KINDS, STUDIES)):
            wanted = " or ".join(kinds) or "a dataset of roughgas"
            other = f", not {found}" if found else ""
            raise InputError("file", path, f"be {wanted}{other}")
        yield file


def _check_size(path, size):
    if size > LARGEST:
        raise InputError(f"size of {path}", f"{size:.3g} bytes", f"be at most {LARGEST:.0g}")


def _check_seal(content, path):
    """Raise DamagedError unless the checksum at the end, if there is any, is that of the rest."""
    end = content.rfind(SEAL)
    if end < 0:
        return
    digest = hashlib.sha256(memoryview(content)[:end]).hexdigest()
    if content[end + len(SEAL) :] == digest.encode():
        return
    if held := _held(path):
        raise InputError("file", path, f"be whole{held}")
    raise DamagedError("file", path, "be what was written to it: it is damaged")


def _held(path):
    """Return words on the process that has locked a file, as one that writes HDF5 does; else none.

    Linux lists locks and their inodes in /proc/locks, which takes no lock.
    """
    try:
        inode, locks = str(path.stat().st_ino), Path("/proc/locks").read_text()
    except OSError:
        return ""
    for line in locks.splitlines():
        fields = line.split()  # number, kind, advisory, mode, process, device:inode, ...
        if len(fields) > 5 and fields[5].rpartition(":")[2] == inode and fields[3] == "WRITE":
            return f": process {fields[4]} holds it, and may be writing it; try again afterwards"
    return ""


def is_of_kind(path: str | Path, kind: str) -> bool:
    """Return whether the file at `path` is a dataset of roughgas of this kind, whole."""
    try:
        with opened(path, kind):
            return True
    except InputError:
        return False


def kind_of(file: "netCDF4.Dataset") -> str | None:
    """Return the kind of an open file; None if it is of none."""
    if file.groups:
        return STUDIES
    # a number of particles that is swept is a dimension
    attributes, variables = {*file.ncattrs(), *file.dimensions}, set(file.variables)
    fits = (k for k, one in KINDS.items() if attributes >= one[0] and variables >= one[1])
    return next(fits, None)


def attributes_of(file: "netCDF4.Dataset") -> dict[str, Any]:
    """Return the global attributes of an open file."""
    return {name: file.getncattr(name) for name in file.ncattrs()}


def seal(path: str | Path) -> None:
    """Append the checksum of a finished file to it.

    HDF5 ignores what follows its end. What another program writes anew has no seal, and is read.
    """
    with Path(path).open("r+b") as file:
        digest = hashlib.file_digest(file, "sha256").hexdigest()
        file.write(SEAL + digest.encode())


def is_foreign(path: str | Path) -> bool:
    """Return whether a file is netCDF or JSON, but not as roughgas has written it to the end."""
    with Path(path).open("rb") as file:
        begins = file.read(4).startswith((b"\x89HDF", b"CDF")) or Path(path).suffix == ".json"
        file.seek(max(0, file.seek(0, os.SEEK_END) - len(SEAL) - 64))
        return begins and not file.read().startswith(SEAL)


def require(attributes: Mapping[str, Any], names: Iterable[str], path: str | Path) -> None:
    """Raise InputError for the first of the attributes `names` that the file does not have."""
    for name in names:
        if name not in attributes:
            raise InputError(f"attribute {name} of {path}", "(nothing)", "be given")


def _check_attributes(file: "netCDF4.Dataset", path: str | Path) -> None:
    for name, value in attributes_of(file).items():
        wanted = ATTRIBUTES.get(name)
        if wanted and not _fits(value, wanted):
            raise InputError(f"{name} of {path}", shown(value), f"be {wanted}")
        if name in LEGAL:
            LEGAL[name].check(f"{name} of {path}", value)
        if wanted == JSON:
            from_json(value, f"{name} of {path}")
    swept = getattr(file, "swept", "effect.parameter")
    if not SWEPT.fullmatch(swept):
        raise InputError(f"swept of {path}", shown(swept), "be EFFECT.PARAMETER, or a setting")
    version = getattr(file, "schema_version", SCHEMA_VERSION)
    if version > SCHEMA_VERSION:
        legal = f"be at most {SCHEMA_VERSION}: a newer roughgas has written the file"
        raise InputError(f"schema_version of {path}", version, legal)


def _fits(value: Any, wanted: str) -> bool:
    if wanted in (WORD, JSON):
        return isinstance(value, str)
    is_number = np.ndim(value) == 0 and np.asarray(value).dtype.kind in "iuf"
    return bool(is_number and math.isfinite(value) and (wanted == NUMBER or value == int(value)))
