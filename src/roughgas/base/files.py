"""Files get their final names only when they are whole."""

import errno
import os
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path


@contextmanager
def whole_file(path: str | Path) -> Iterator[Path]:
    """Yield a temporary path to write to; rename it to `path` on success, delete it otherwise.

    Parent folders are created. The name, `path`.PID.tmp, is this process's own: a job that outlives
    a killed workflow must not spoil what its successor writes. After SIGKILL the file remains until
    the next writer of `path` finds that its process is gone.
    Raises OSError, which names `path`, if the folder cannot be written or the disk is full.
    """
    path = Path(path)
    if path.exists() and not path.is_file():  # root could replace even /dev/null
        raise OSError(errno.EINVAL, "exists and is not a file", str(path))
    draft = path.with_name(f"{path.name}.{os.getpid()}.tmp")
    path.parent.mkdir(parents=True, exist_ok=True)
    remove_dead_drafts(path)
    try:
        yield draft
        with open(draft, "rb") as file:
            os.fsync(file.fileno())  # or a power cut could leave the new name without the content
        os.replace(draft, path)
    except OSError as error:
        if error.filename in (None, str(draft)):
            error.filename = str(path)
        raise
    finally:
        draft.unlink(missing_ok=True)


def check_place(path: str | Path) -> None:
    """Raise OSError if `path`, a file or a folder, could not be written.

    Called before work that takes long, rather than after it.
    """
    path = Path(path).absolute()
    if path.exists() and not (path.is_file() or path.is_dir()):
        raise OSError(errno.EINVAL, "exists and is not a file", str(path))
    folder = next(folder for folder in (path, *path.parents) if folder.is_dir())
    try:
        tempfile.TemporaryFile(dir=folder).close()  # for root all of /proc has permission
    except OSError as error:
        raise OSError(error.errno, "cannot be written", str(path)) from None


def remove_dead_drafts(path: Path) -> None:
    """Remove what killed writers of `path` have left."""
    for left in path.parent.glob(f"{path.name}.*.tmp"):
        if not _is_alive(left.name.split(".")[-2]):
            left.unlink(missing_ok=True)


def _is_alive(process: str) -> bool:
    """Return whether a process is there that can still write: one that is over, and whose end its
    parent has not yet taken note of, cannot."""
    try:
        os.kill(int(process), 0)
        state = Path(f"/proc/{process}/stat").read_bytes().rpartition(b")")[2].split()[0]
    except (ValueError, ProcessLookupError):
        return False
    except OSError:  # somebody else's, or a system without /proc
        return True
    return state not in (b"Z", b"X")


def write_text(path: str | Path, text: str) -> None:
    """Write `text` (UTF-8, line ends as given) to `path`, whole or not at all."""
    with whole_file(path) as draft:
        draft.write_text(text, encoding="utf-8", newline="")
