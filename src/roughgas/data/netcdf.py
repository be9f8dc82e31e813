"""Writer and reader of all netCDF files, which follow the CF conventions.

Before anything is read from a file, its type, completeness and size are checked: any program may
have written it, and the disk may have damaged it.

Files are written with netCDF4 alone: importing xarray would double the start-up of a point's job.

CF demands units of UDUNITS, which reads T as tesla and a as a year. A quantity in reduced units
therefore is dimensionless: its `units` are 1, and `reduced_units` names the reduced unit.
"""

import errno
import hashlib
import math
import os
import re
import threading
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from enum import StrEnum
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from roughgas.base import (
    RESTITUTION,
    ROUGHNESS,
    Attributes,
    InputError,
    Interval,
    NamedValues,
    __version__,
    from_json,
    on_one_line,
    short_repr,
)
from roughgas.base.files import atomic_write
from roughgas.data.formats import DATASET
from roughgas.data.variables import CLOCKS, Array

if TYPE_CHECKING:
    import netCDF4
    import xarray

COMMON_ATTRIBUTES = {
    "Conventions": "CF-1.11",
    "schema_version": DATASET.newest,
    "source": f"roughgas {__version__}, event-driven simulation of rough, inelastic particles",
    "history": f"written by roughgas {__version__}; undated: the same run gives the same bytes",
    "references": "S. McNamara and S. Luding, Phys. Rev. E 58, 2247 (1998), "
    "doi:10.1103/PhysRevE.58.2247",
    "comment": "Particle radius a = particle mass m = time unit T = 1; reduced_units of a variable "
    "are in terms of these, of collisions per particle, or of an energy at the start.",
}
UDUNITS = ("1", "s", "1/s")
SCALAR_SLICE = [0], [1], [1]
"""Start, count and stride of a scalar for netCDF4's internal get and put, which skip its indexing:
that takes ten times as long."""
UNDECODABLE = (LookupError, AttributeError, TypeError, ValueError, ArithmeticError, RuntimeError)
"""Exceptions of xarray for variables whose attributes it misinterprets."""
UNCERTAINTY_SUFFIXES = ("stderr", "dof", "trusted", "ci95", "ci95_trusted")
"""Suffixes of ancillary variables of <name> on its uncertainty (<name>_stderr, ...)."""


class Content(NamedTuple):
    """Variables by name, and attributes, of a file or of a group in it.

    `clocks` are coordinates whose dimension has another name, such as a time along `sample`.
    """

    variables: Mapping[str, "Array | xarray.Variable"]
    attributes: Mapping[str, Any]
    clocks: Sequence[str] = CLOCKS


def content_of(dataset: "xarray.Dataset") -> Content:
    """Return the content of a dataset, whose variables have the attributes of `described`."""
    clocks = sorted(str(name) for name in dataset.coords if name not in dataset.dims)
    return Content(
        {str(name): variable for name, variable in dataset.variables.items()}, dataset.attrs, clocks
    )


def write_netcdf(
    path: str | Path,
    content: Content,
    groups: Mapping[str, Content] | None = None,
) -> None:
    """Write a netCDF4 file of `content` and of `groups`, by name, atomically.

    Parent folders are created. The root gets the common attributes of all files. Nothing is
    compressed: noisy series would shrink by a fourth, but take a fifth longer to write. Raises
    OSError if the file cannot be written, as on a full disk.
    """
    import netCDF4

    try:
        with atomic_write(path) as draft:
            with netCDF4.Dataset(draft, "w") as file:
                _fill(file, content, COMMON_ATTRIBUTES)
                for name, group_content in (groups or {}).items():
                    _fill(file.createGroup(name), group_content, {})
            append_checksum(draft)
    except (RuntimeError, PermissionError) as error:  # netCDF4's errors for a full disk
        reason = f"{error}; is the disk full or the folder read-only?"
        raise OSError(f"cannot write {path}: {reason}") from error


def in_memory(content: Content) -> "xarray.Dataset":
    """Return the dataset that `write_netcdf` and `read_netcdf` would give, without a file."""
    import netCDF4

    file = netCDF4.Dataset("memory.nc", "w", memory=1)  # never written to a disk
    _fill(file, content, COMMON_ATTRIBUTES)
    with netCDF4.Dataset("memory.nc", memory=file.close()) as written:
        return _loaded(written, "memory.nc")


def read_netcdf(path: str | Path, *file_types: str, group: str | None = None) -> "xarray.Dataset":
    """Return the dataset at `path`, or its group `group`, in memory; the file is closed.

    `file_types` are the legal types of the file, such as POINT; by default all types are legal.
    Raises InputError and OSError as `opened` does.
    """
    with opened(path, *file_types) as file:
        return _loaded(file if group is None else file.groups[group], path)


def read_groups(path: str | Path) -> "dict[str, xarray.Dataset]":
    """Return all groups of a dataset of studies in memory, by name; the file is checked once.

    Raises InputError and OSError as `opened` does.
    """
    with opened(path, STUDIES) as file:
        return {name: _loaded(group, path) for name, group in file.groups.items()}


def _loaded(group: "netCDF4.Dataset", path: str | Path) -> "xarray.Dataset":
    """Return an open file, or a group of it, as a dataset in memory; the file stays open.

    Raises InputError, which names `path`, for content that xarray cannot decode, such as a
    scale_factor that is text.
    """
    import xarray

    try:
        return xarray.open_dataset(xarray.backends.NetCDF4DataStore(group)).load()
    except UNDECODABLE as error:
        legal = f"hold what can be decoded: {type(error).__name__}: {error}"
        raise InputError("file", path, on_one_line(legal)) from error


def _fill(group: "netCDF4.Dataset", content: Content, common: Attributes) -> None:
    """Write content to an open file, or to a group of it; `common` are further attributes."""
    group.setncatts({**common, **content.attributes})
    for variable in content.variables.values():
        for dim, length in zip(variable.dims, variable.values.shape, strict=True):
            if dim not in group.dimensions:
                group.createDimension(str(dim), length)
    # All variables are defined before data are written: each later one makes netCDF rescan all.
    targets = [_defined(group, name, content) for name in content.variables]
    group.set_auto_maskandscale(False)  # nothing is masked or packed; this saves the search
    for target, variable in zip(targets, content.variables.values(), strict=True):
        values = variable.values
        put = None if values.shape or target.dtype is str else getattr(target, "_put", None)
        if put is None:
            target[...] = values.astype(object) if target.dtype is str else values
        else:
            put(values, *SCALAR_SLICE)


def number_in(variable: "netCDF4.Variable") -> float | int:
    """Return the number in a scalar variable of an open file."""
    get = None if variable.dimensions else getattr(variable, "_get", None)
    return (variable[...] if get is None else get(*SCALAR_SLICE)).item()


def _defined(group: "netCDF4.Dataset", name: str, content: Content) -> "netCDF4.Variable":
    """Create the variable `name` of a group, with its attributes but no values, and return it."""
    variable = content.variables[name]
    dims, values = tuple(map(str, variable.dims)), variable.values
    is_text = values.dtype.kind in "OU"
    is_coordinate = name in dims or name in content.clocks
    # CF forbids a fill value in coordinates
    fill = np.nan if values.dtype.kind == "f" and not is_coordinate else None
    target = group.createVariable(name, str if is_text else values.dtype, dims, fill_value=fill)
    target.setncatts(_attributes(name, content, is_coordinate))
    return target


def _attributes(name: str, content: Content, is_coordinate: bool) -> NamedValues:
    """Return the attributes of the variable `name`, with units of CF.

    They name its coordinates, unless it is a coordinate itself, and the variables on its
    uncertainty.
    """
    variables = content.variables
    dims, attributes = variables[name].dims, dict(variables[name].attrs)
    is_number = variables[name].values.dtype.kind in "if"
    unit = attributes.pop("units", "1" if is_coordinate and is_number else "")
    units = {"units": unit} if "reduced_units" in attributes else unit_attributes(unit)
    clocks = [c for c in content.clocks if c in variables and set(variables[c].dims) <= set(dims)]
    coordinates = {"coordinates": " ".join(clocks)} if clocks and not is_coordinate else {}
    uncertainties = [
        f"{name}_{quality}" for quality in UNCERTAINTY_SUFFIXES if f"{name}_{quality}" in variables
    ]
    ancillary = {"ancillary_variables": " ".join(uncertainties)} if uncertainties else {}
    return attributes | units | ancillary | coordinates


def unit_attributes(unit: str) -> dict[str, str]:
    """Return the attributes `units` and `reduced_units` for a unit, such as "T", "1" or "s/T".

    There are none for "", the unit of words. CPU time per reduced unit counts as seconds.
    """
    if not unit:
        return {}
    if unit in UDUNITS:
        return {"units": unit}
    return {"units": "s" if unit.startswith("s/") else "1", "reduced_units": unit}


def unit_of(attributes: Mapping[str, str]) -> str:
    """Return the unit, such as "T", in attributes made by `unit_attributes`; "" for words."""
    return attributes.get("reduced_units", attributes.get("units", ""))


CHECKSUM_PREFIX = b"\nroughgas sha256 "
MAX_BYTES = 4e9  # bytes, on disk or by the shapes of its variables
OPENING_TIMEOUT = 60  # seconds, ample for HDF5 to open any valid file


class AttributeType(StrEnum):
    """Type of a global attribute; its text completes a message "it must be ..."."""

    NUMBER = "a number"
    INTEGER = "a whole number"
    TEXT = "text"
    JSON = "a JSON object"


NUMBER, INTEGER, TEXT, JSON = AttributeType
ATTRIBUTE_TYPES = {
    **dict.fromkeys(("seed", "dimension", "particles", "initial_exact", "reseeded"), INTEGER),
    **dict.fromkeys(("r", "beta", "inertia", "spin_share", "mu", "packing", "r_at_speed"), NUMBER),
    **dict.fromkeys(("experiment", "scale", "r_label", "beta_label", "command", "swept"), TEXT),
    **dict.fromkeys(("variant", "theory", "study", "task", "initial_digest"), TEXT),
    **dict.fromkeys(("experiment_json", "settings_json", "species_json", "langevin_json"), JSON),
}
"""Types of the global attributes that are read, if present."""
LEGAL_VALUES = {
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
"""Legal intervals of these numbers."""


class FileType(NamedTuple):
    """Names of the attributes and variables that a file of a type must have."""

    attributes: frozenset[str]
    variables: frozenset[str]


POINT, REDUCED = "a point", "a reduced dataset"
TASK, STUDIES = "a task of a study", "a dataset of studies"
SWEPT_PATTERN = re.compile(r"(\w+\.)*\w+")
FILE_TYPES = {
    TASK: FileType(frozenset({"study", "task"}), frozenset()),
    REDUCED: FileType(
        frozenset({"experiment", "scale", "dimension", "particles"}),
        frozenset({"r", "beta", "n_seeds", "E_trans", "equilibrated"}),
    ),
    POINT: FileType(
        frozenset({"experiment", "scale", "r", "beta", "seed", "dimension", "particles"}),
        frozenset({"E_trans", "collisions", "kernel_seconds", "equilibrated"}),
    ),
}
"""Types of files without groups; a file has the first type that fits."""


class DamagedError(InputError):
    """A file of roughgas whose checksum proves that it has changed since it was written."""


@contextmanager
def opened(path: str | Path, *file_types: str) -> Iterator["netCDF4.Dataset"]:
    """Open the netCDF file at `path` for reading; its type must be in `file_types`, if given.

    Types are such as POINT. The file is not locked: its bytes are read once, verified by their
    checksum, and decoded. Raises InputError for files of other programs, types and versions, for
    truncated files, for files of more than MAX_BYTES, on disk or by their dimensions, and for files
    that HDF5 does not open within OPENING_TIMEOUT; DamagedError for a wrong checksum, unless
    another process holds the file; OSError where it cannot be read. Damage that the checksum cannot
    prove, in a file without it or with a forged one, may crash HDF5, and the process with it.
    """
    file_path = Path(path)
    if not file_path.exists():
        reason = os.strerror(errno.ENOENT)
        is_pipeline_result = file_path.parts[:1] == ("results",) and file_path.suffix == ".nc"
        hint = f"{reason}; to make it: snakemake -j2 {path}" if is_pipeline_result else reason
        raise FileNotFoundError(errno.ENOENT, hint, str(path))
    if not file_path.is_file():  # a pipe would block
        raise InputError("file", path, "be a file")
    _check_size(path, file_path.stat().st_size)
    content = file_path.read_bytes()
    _verify_checksum(content, file_path)
    try:
        file = _open_in_time(path, content)
    except (OSError, RuntimeError, UnicodeError, AttributeError) as error:
        legal = "be a dataset of roughgas: it is of another program, or cut off" + _writer(
            file_path
        )
        raise InputError("file", path, legal) from error
    with file:
        _check_attributes(file, path)
        variables = [v for g in (file, *file.groups.values()) for v in g.variables.values()]
        _check_size(path, sum(8.0 * math.prod(variable.shape) for variable in variables))
        if (file_type := file_type_of(file)) not in (file_types or (*FILE_TYPES, STUDIES)):
            expected = " or ".join(file_types) or "a dataset of roughgas"
            contrast = f", not {file_type}" if file_type else ""
            raise InputError("file", path, f"be {expected}{contrast}")
        yield file


def _open_in_time(path: str | Path, content: bytes) -> "netCDF4.Dataset":
    """Return the bytes `content` of the file at `path` as an open dataset.

    Raises netCDF4's errors, and InputError for a timeout. Some damaged files make HDF5 loop
    endlessly, while no signal reaches Python. Then a thread is left behind, which ends with the
    process.
    """
    import netCDF4

    outcome: list[netCDF4.Dataset | Exception] = []

    def work() -> None:
        """Append the open dataset, or the exception, to `outcome`."""
        try:  # from memory: HDF5 would lock the file, which fails on a disk without locks
            file = netCDF4.Dataset(path, memory=content)
            attributes_of(file)  # HDF5 reads them only now
            outcome.append(file)
        except Exception as error:
            outcome.append(error)

    thread = threading.Thread(target=work, daemon=True)
    thread.start()
    thread.join(OPENING_TIMEOUT)
    if not outcome:
        raise InputError(
            "file", path, f"be a dataset of roughgas: HDF5 reads it for {OPENING_TIMEOUT} s"
        )
    if isinstance(outcome[0], Exception):
        raise outcome[0]
    return outcome[0]


def _check_size(path, size):
    """Raise InputError for a file at `path` of more than MAX_BYTES; `size` is in bytes."""
    if size > MAX_BYTES:
        raise InputError(f"size of {path}", f"{size:.3g} bytes", f"be at most {MAX_BYTES:.0g}")


def _verify_checksum(content, path):
    """Raise DamagedError if the bytes of the file at `path` end with a checksum that is wrong.

    Raises InputError instead if another process holds the file. Bytes without a checksum pass.
    """
    end = content.rfind(CHECKSUM_PREFIX)
    if end < 0:
        return
    digest = hashlib.sha256(memoryview(content)[:end]).hexdigest()
    if content[end + len(CHECKSUM_PREFIX) :] == digest.encode():
        return
    if held := _writer(path):
        raise InputError("file", path, f"be whole{held}")
    raise DamagedError("file", path, "be what was written to it: it is damaged")


def _writer(path):
    """Return a remark on the process that is writing the HDF5 file at `path`; "" without one.

    Such a process has locked the file. Linux lists locks with their inodes in /proc/locks.
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


def is_of_type(path: str | Path, file_type: str) -> bool:
    """Return whether the file at `path` is an intact dataset of roughgas of a type, such as POINT.

    Raises OSError if it cannot be read.
    """
    try:
        with opened(path, file_type):
            return True
    except InputError:
        return False


def file_type_of(file: "netCDF4.Dataset") -> str | None:
    """Return the type of an open file, such as POINT; None if no type fits."""
    if file.groups:
        return STUDIES
    # a swept number of particles is a dimension, not an attribute
    swept_dimension = {"particles"} & {*file.dimensions}
    attributes, variables = swept_dimension.union(file.ncattrs()), set(file.variables)
    matches = (
        name
        for name, required in FILE_TYPES.items()
        if attributes >= required[0] and variables >= required[1]
    )
    return next(matches, None)


def attributes_of(file: "netCDF4.Dataset") -> NamedValues:
    """Return the global attributes of an open file, or of a group, by name."""
    return {name: file.getncattr(name) for name in file.ncattrs()}


def append_checksum(path: str | Path) -> None:
    """Append the SHA-256 checksum of a finished file to it.

    HDF5 ignores bytes after its end. A file that another program rewrites has no checksum, and is
    read without.
    """
    with Path(path).open("r+b") as file:
        digest = hashlib.file_digest(file, "sha256").hexdigest()
        file.write(CHECKSUM_PREFIX + digest.encode())


def is_dataset(path: str | Path) -> bool:
    """Return whether the file at `path` begins as netCDF does, or is called .json.

    Raises OSError if it cannot be read.
    """
    with Path(path).open("rb") as file:
        return file.read(4).startswith((b"\x89HDF", b"CDF")) or Path(path).suffix == ".json"


def is_foreign(path: str | Path) -> bool:
    """Return whether the file at `path` lacks the checksum at the end of roughgas's files.

    Raises OSError if it cannot be read.
    """
    with Path(path).open("rb") as file:
        file.seek(max(0, file.seek(0, os.SEEK_END) - len(CHECKSUM_PREFIX) - 64))
        return not file.read().startswith(CHECKSUM_PREFIX)


def require(attributes: Attributes, names: Iterable[str], path: str | Path) -> None:
    """Raise InputError, which names `path`, for the first of the attributes that is missing."""
    for name in names:
        if name not in attributes:
            raise InputError(f"attribute {name} of {path}", "(nothing)", "be given")


def check_version(attributes: Attributes, key: str) -> None:
    """Raise InputError, with this `key`, if `schema_version` in attributes cannot be read.

    A dataset of another program has none, and passes.
    """
    version = attributes.get("schema_version", DATASET.newest)
    if not _fits(version, INTEGER):
        raise InputError(key, short_repr(version), f"be {INTEGER}")
    DATASET.check(key, int(version))


def _check_attributes(file: "netCDF4.Dataset", path: str | Path) -> None:
    """Raise InputError, which names `path`, for illegal global attributes of an open file."""
    attributes = attributes_of(file)
    check_version(attributes, f"schema_version of {path}")  # other versions may have other types
    for name, value in attributes.items():
        attribute_type = ATTRIBUTE_TYPES.get(name)
        if attribute_type and not _fits(value, attribute_type):
            raise InputError(f"{name} of {path}", short_repr(value), f"be {attribute_type}")
        if name in LEGAL_VALUES:
            LEGAL_VALUES[name].check(f"{name} of {path}", value)
        if attribute_type == JSON:
            from_json(value, f"{name} of {path}")
    swept = getattr(file, "swept", "effect.parameter")
    if not SWEPT_PATTERN.fullmatch(swept):
        raise InputError(f"swept of {path}", short_repr(swept), "be EFFECT.PARAMETER, or a setting")


def _fits(value: Any, attribute_type: AttributeType) -> bool:
    """Return whether the value of an attribute has a type; numbers must be finite scalars."""
    if attribute_type in (TEXT, JSON):
        return isinstance(value, str)
    is_number = np.ndim(value) == 0 and np.asarray(value).dtype.kind in "iuf"
    return bool(
        is_number and math.isfinite(value) and (attribute_type == NUMBER or value == int(value))
    )
