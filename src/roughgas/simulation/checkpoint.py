"""Checkpoints: files that store the progress of a run, which resumes from them bit by bit.

A checkpoint is one .npz file: every array of a State, arrays of the run itself, the version of this
format, a checksum, and a text that identifies the run.
"""

import hashlib
import os
import time
import zipfile
import zlib
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np

from roughgas.base import EndedEarlyError, InputError, Interval, Record
from roughgas.base.files import atomic_write, remove_dead_drafts
from roughgas.data.formats import CHECKPOINT
from roughgas.kernel.state import State
from roughgas.scene import Scene
from roughgas.simulation.state_encoding import UnusableCheckpoint, decode, encode

VERSION_KEY, OWNER_KEY, CHECKSUM_KEY = "version", "belongs to", "sha256"
DAMAGE_ERRORS = (
    *(OSError, EOFError, KeyError, ValueError, RuntimeError, MemoryError, TypeError),
    *(zipfile.BadZipFile, zlib.error),
)
"""Errors of zipfile and numpy; the damaged position of a file decides which one is raised."""
UNKNOWN_CONTENT = "holds what no run has kept"
OTHER_CAUSES = (InputError, EndedEarlyError, OSError, ImportError, MemoryError)
"""Errors of a run that the arrays of its checkpoint do not cause."""
STORED_KINDS = "biufU"  # of the dtypes of arrays in a checkpoint
INTERVAL_VARIABLE = "ROUGHGAS_CHECKPOINT_SECONDS"
"""Variable of the environment with the seconds between two writes of a checkpoint."""
DEFAULT_INTERVAL = "180"
INTERVAL_SECONDS = Interval("[0, 1e9]")


class Checkpoint:
    """The checkpoint file of a run, written at intervals; a run shorter than one writes none.

    A file that is unreadable or belongs to another run is not used: `refused` gives the reason.
    `path` is the file's path, and `content` are its arrays by name.
    """

    def __init__(self, path: str | Path, owner: str) -> None:
        """Read the file at `path`, if it exists and is usable.

        `owner` is a hash that identifies the run and its sources (see run_points.checkpoint_owner).
        Raises InputError for an illegal interval in the environment or a path of no regular file,
        OSError.
        """
        self.path, self.refused, self._owner = Path(path), "", owner
        self._interval = _interval_seconds(os.environ.get(INTERVAL_VARIABLE, DEFAULT_INTERVAL))
        self._written = time.monotonic()
        self.content: dict[str, np.ndarray] = {}
        """The arrays of the file by name; empty for a run that starts from the beginning."""
        try:
            self.content = read(path, owner)
        except FileNotFoundError:
            pass
        except UnusableCheckpoint as error:
            self.refused = str(error)

    @property
    def has_content(self) -> bool:
        """Whether the run resumes from the content of a file."""
        return bool(self.content)

    def may_have_caused(self, error: Exception) -> bool:
        """Return whether the content of the file may have caused `error`.

        It is the error of the run that resumed from the file.
        """
        return self.has_content and not isinstance(error, OTHER_CAUSES)

    def refuse(self, error: Exception, say: Callable[[str], None]) -> None:
        """Remove the file, whose content has caused `error`, so that the run starts afresh.

        `say` prints a line with the reason.
        """
        self.refused = str(error) if isinstance(error, UnusableCheckpoint) else UNKNOWN_CONTENT
        say(f"{self.path} {self.refused}: starting afresh")
        self.content = {}
        self.discard()

    def due(self) -> bool:
        """Return whether the interval between two writes has passed since the last one."""
        return time.monotonic() - self._written >= self._interval

    def write(self, content: Mapping[str, np.ndarray]) -> None:
        """Write the file anew, with the arrays `content` by name. Raises OSError."""
        write(self.path, self._owner, content)
        self._written = time.monotonic()

    def discard(self) -> None:
        """Remove the file, and drafts of it that killed processes have left."""
        discard(self.path)


@contextmanager
def restoring() -> Iterator[None]:
    """Turn any error of the `with` block into UnusableCheckpoint.

    The block restores arrays from a file.
    """
    try:
        yield
    except UnusableCheckpoint:
        raise
    except Exception as error:
        raise UnusableCheckpoint(UNKNOWN_CONTENT) from error


@contextmanager
def resumable(
    path: str | Path | None, owner: str, say: Callable[[str], None]
) -> Iterator[Checkpoint | None]:
    """Yield the checkpoint at `path` for a run with this `owner`, or None without a path.

    Reports through `say` whether the run resumes. A gas that ends early leaves no checkpoint; if
    the run is interrupted, KeyboardInterrupt says whether the next run resumes.
    """
    if path is None:
        yield None
        return
    checkpoint = Checkpoint(path, owner)
    if checkpoint.refused:
        say(f"{checkpoint.path} {checkpoint.refused}: starting afresh")
    if checkpoint.has_content:
        say(f"going on from {checkpoint.path}")
    try:
        with advising_to_resume(checkpoint.path):
            yield checkpoint
    except EndedEarlyError:
        checkpoint.discard()
        raise


@contextmanager
def advising_to_resume(path: Path) -> Iterator[None]:
    """Add advice to KeyboardInterrupt: the same command resumes from the checkpoint at `path`.

    Without a file at `path`, the exception stays as it is.
    """
    try:
        yield
    except KeyboardInterrupt as stop:
        if not path.exists():
            raise
        advice = f"the same command goes on from {path}"
        raise KeyboardInterrupt("; ".join([*map(str, stop.args), advice])) from None


def checkpoint_path(output: str | Path) -> str:
    """Return the path of a run's checkpoint, next to the file `output` of its results."""
    return f"{output}.checkpoint.npz"


def _interval_seconds(text: str) -> float:
    """Return the seconds between two writes, from the environment's `text`. Raises InputError."""
    try:
        return INTERVAL_SECONDS.check(INTERVAL_VARIABLE, float(text))
    except ValueError:
        raise INTERVAL_SECONDS.error(INTERVAL_VARIABLE, text) from None


def with_prefix(prefix: str, arrays: Mapping[str, np.ndarray]) -> dict[str, np.ndarray]:
    """Return the arrays by new names: `prefix`, a dot, and the old name."""
    return {f"{prefix}.{name}": array for name, array in arrays.items()}


def under_prefix(prefix: str, content: Mapping[str, np.ndarray]) -> dict[str, np.ndarray]:
    """Return the arrays of `content` whose names begin with `prefix` and a dot.

    Their new names are the rest of the names.
    """
    start = f"{prefix}."
    return {
        name.removeprefix(start): array for name, array in content.items() if name.startswith(start)
    }


def save(path: str | Path, owner: str, state: State, record: Mapping[str, np.ndarray]) -> None:
    """Write the kernel's `state`, and the caller's arrays `record` by name, to `path` atomically.

    `owner` identifies the run: no other one may resume from the file. Raises OSError.
    """
    content = with_prefix("state", encode(state))
    write(path, owner, content | with_prefix("record", record))


def write(path: str | Path, owner: str, content: Mapping[str, np.ndarray]) -> None:
    """Write the arrays `content`, by name, to `path` atomically. Raises OSError.

    The file also gets `owner`, the hash of the run, the version of the format and a checksum.
    """
    version = np.array(CHECKPOINT.newest)
    arrays: dict[str, Any] = {VERSION_KEY: version, OWNER_KEY: np.array(owner), **content}
    arrays[CHECKSUM_KEY] = np.array(_checksum(arrays))
    with atomic_write(path) as draft, open(draft, "wb") as file:
        np.savez(file, **arrays)


def restore(path: str | Path, owner: str, state: State, scene: Scene) -> dict[str, np.ndarray]:
    """Fill the kernel's `state` from the file at `path`, and return the arrays `record`.

    The record was given to `save`. `state` must be a new state of the same scene and size, and
    `owner` the hash given to `save`. Values are copied into the existing arrays, so that arrays
    which share memory still do. Raises FileNotFoundError if there is no checkpoint, and
    UnusableCheckpoint if it is damaged, was written by another roughgas, or belongs to another run;
    `state` is then unchanged.
    """
    content = read(path, owner)
    decode(under_prefix("state", content), state, scene)
    return under_prefix("record", content)


def discard(path: str | Path) -> None:
    """Remove a checkpoint and the drafts that killed writers of it have left."""
    Path(path).unlink(missing_ok=True)
    remove_dead_drafts(Path(path))


def read(path: str | Path, owner: str) -> dict[str, np.ndarray]:
    """Return the arrays of the checkpoint at `path` by name, after verifying checksum and `owner`.

    Raises FileNotFoundError, InputError if `path` is no regular file (a folder or a pipe), and
    UnusableCheckpoint if the file is damaged, has an unsupported version, or has another owner.
    """
    path = Path(path)
    if path.exists() and not path.is_file():  # reading a pipe would block, a device has no end
        raise InputError("checkpoint", path, "be a file")
    try:
        content = _arrays_in(path)
        version = int(content.get(VERSION_KEY, np.array(CHECKPOINT.oldest)).item())
        _check_version(version)
        checked = version > CHECKPOINT.oldest or CHECKSUM_KEY in content
        if checked and content.pop(CHECKSUM_KEY).item() != _checksum(content):
            raise UnusableCheckpoint("is damaged")
    except (FileNotFoundError, UnusableCheckpoint):
        raise
    except DAMAGE_ERRORS as error:
        raise UnusableCheckpoint("is damaged") from error
    content.pop(VERSION_KEY, None)
    if str(content.pop(OWNER_KEY, "")) != owner:
        raise UnusableCheckpoint("belongs to other settings or to other sources")
    return content


def _check_version(version: int) -> None:
    """Raise UnusableCheckpoint for a version of the format that this package does not read."""
    try:
        CHECKPOINT.check(VERSION_KEY, version)
    except InputError as error:
        raise UnusableCheckpoint(f"is of version {version}, which must {error.legal}") from error


def _arrays_in(path: Path) -> dict[str, np.ndarray]:
    """Return the arrays in an .npz file by name.

    Raises UnusableCheckpoint if lengths or CRCs of its members are wrong.
    """
    with zipfile.ZipFile(path) as archive:
        members = archive.infolist()
        # members are not compressed: more bytes than the file has would fill the memory
        if sum(member.file_size for member in members) > path.stat().st_size or archive.testzip():
            raise UnusableCheckpoint("is damaged")
    with np.load(path, allow_pickle=False) as archive:
        return {name: archive[name] for name in archive.files}


def _checksum(content: Record) -> str:
    """Return the SHA-256 checksum, as hexadecimal digits, of all arrays and their names.

    The checksums of zip cover single members, and any program that changes one renews them.
    """
    digest = hashlib.sha256()
    for name, array in sorted((name, np.asarray(values)) for name, values in content.items()):
        digest.update(repr((name, array.dtype.str, array.shape)).encode() + array.tobytes())
    return digest.hexdigest()
