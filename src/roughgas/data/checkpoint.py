"""Checkpoints: a simulation under way, saved whole and resumed with the same bits.

A checkpoint is one .npz file. It holds every array of a State, what the run has recorded so far,
and a text that says which run it belongs to.
"""

import zipfile
import zlib
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np

from roughgas.base.files import remove_dead_drafts, whole_file

OWNER, STATE, RECORD = "belongs to", "state.", "record."
DAMAGE = (OSError, EOFError, KeyError, ValueError, RuntimeError, zipfile.BadZipFile, zlib.error)
"""What zipfile and numpy raise; it depends on where a file is damaged."""


class UnusableCheckpoint(ValueError):
    """A checkpoint that a run cannot resume from; its text says why, as the end of a sentence."""


def save(path: str | Path, owner: str, state: Any, record: Mapping[str, np.ndarray]) -> None:
    """Write `state` and the arrays of `record` to `path`, whole or not at all.

    `owner` says which run this is: only the same one may resume from here. Raises OSError.
    """
    content: dict[str, Any] = {OWNER: np.array(owner)}
    content |= {STATE + name: array for name, array in arrays_of(state)}
    content |= {RECORD + name: array for name, array in record.items()}
    with whole_file(path) as draft, open(draft, "wb") as file:
        np.savez(file, **content)


def restore(path: str | Path, owner: str, state: Any) -> dict[str, np.ndarray]:
    """Fill `state`, a fresh one of the same scene and size, from `path`, and return the record.

    Values are copied into the existing arrays, so that those that share memory still do. Raises
    FileNotFoundError if there is no checkpoint, and UnusableCheckpoint if it is damaged or belongs
    to another run; `state` is then as it was.
    """
    content = _content(path)
    if content.pop(OWNER, None) != owner:
        raise UnusableCheckpoint("belongs to other settings or to other sources")
    here = dict(arrays_of(state))
    saved = {name: content.get(STATE + name, np.empty(())) for name in here}
    if any(saved[name].shape != here[name].shape for name in here):
        raise UnusableCheckpoint("holds another kind of state")
    for name, array in here.items():
        array[...] = saved[name]
    return {
        name.removeprefix(RECORD): array
        for name, array in content.items()
        if name.startswith(RECORD)
    }


def discard(path: str | Path) -> None:
    """Remove a checkpoint that is no longer needed, and what killed writers of it have left."""
    Path(path).unlink(missing_ok=True)
    remove_dead_drafts(Path(path))


def arrays_of(state: Any, prefix: str = "") -> Iterator[tuple[str, np.ndarray]]:
    """Yield (dotted name, array) for every array in nested NamedTuples.

    None and plain tuples are left out: the latter hold what follows from the scene.
    """
    for name, part in zip(state._fields, state, strict=True):
        if isinstance(part, np.ndarray):
            yield prefix + name, part
        elif hasattr(part, "_fields"):
            yield from arrays_of(part, f"{prefix}{name}.")


def _content(path: str | Path) -> dict[str, np.ndarray]:
    """Return all arrays in the file, after verifying their checksums."""
    try:
        with zipfile.ZipFile(path) as archive:
            if archive.testzip() is not None:
                raise UnusableCheckpoint("is damaged")
        with np.load(path, allow_pickle=False) as archive:
            return {name: archive[name] for name in archive.files}
    except FileNotFoundError:
        raise
    except DAMAGE as error:
        raise UnusableCheckpoint("is damaged") from error
