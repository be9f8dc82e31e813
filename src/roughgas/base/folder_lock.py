"""The lock of a workflow's folder, and the process that holds it.

The system frees the lock whenever its process ends, even if killed. The lock file records the
process, so that other users and other machines that share the folder can name it.
"""

import fcntl
import json
import os
import socket
import time
from contextlib import suppress
from pathlib import Path
from typing import NamedTuple, Self, TextIO

START_TIME_TOLERANCE = 1.0  # seconds, between two readings of a process's start time


class Holder(NamedTuple):
    """The process that holds a folder: `pid`, the name `host` of its machine, and its start.

    `begun` is the start in Unix time (s), which tells it from a later process with the same id.
    """

    pid: int
    host: str
    begun: float

    @classmethod
    def of_this_process(cls) -> Self:
        """Return the id, the machine and the start of this process."""
        import psutil

        return cls(os.getpid(), socket.gethostname(), psutil.Process().create_time())

    def is_gone(self) -> bool:
        """Return whether the process has ended; False for a process of another machine."""
        import psutil

        if self.host != socket.gethostname():
            return False
        try:
            return abs(psutil.Process(self.pid).create_time() - self.begun) > START_TIME_TOLERANCE
        except psutil.AccessDenied:
            return False
        except psutil.NoSuchProcess:
            return True


class HeldError(RuntimeError):
    """Another Snakemake holds the folder: the text names its process and a remedy."""


def lock(path: str | Path) -> TextIO:
    """Lock the file at `path`, created if missing; return the open file, which keeps the lock.

    The process keeps the lock until it closes the file or ends. Raises HeldError where another
    process has the lock, OSError where `path` cannot be written. On a disk that does not support
    locks this succeeds always.
    """
    file = open(path, "a+", encoding="utf-8")
    with suppress(OSError):
        try:
            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            file.close()
            raise HeldError(advice(holder(path))) from None
    file.truncate(0)
    json.dump(Holder.of_this_process(), file)
    file.flush()
    return file


def is_held(path: str | Path) -> bool:
    """Return whether a process has the lock of the file at `path`; False if it cannot be read."""
    try:
        with open(path, encoding="utf-8") as file:
            fcntl.flock(file, fcntl.LOCK_SH | fcntl.LOCK_NB)
    except BlockingIOError:
        return True
    except OSError:
        return False
    return False


def holder(path: str | Path) -> Holder | None:
    """Return the process that has the lock of the file at `path`, or None if unknown.

    Where the process recorded in the file is gone, this is a child of it that still has the file
    open.
    """
    try:
        recorded = Holder(*json.loads(Path(path).read_text(encoding="utf-8")))
        if not recorded.is_gone():
            return recorded
    except (OSError, ValueError, TypeError):
        pass
    return _opener(os.path.realpath(path))


def _opener(path: str) -> Holder | None:
    """Return another process of this machine that has the file at `path` open, or None."""
    import psutil

    for process in psutil.process_iter():
        with suppress(psutil.Error, OSError):  # another user's process, or already ended
            if process.pid != os.getpid() and path in {file.path for file in process.open_files()}:
                return Holder(process.pid, socket.gethostname(), process.create_time())
    return None


def advice(holding: Holder | None) -> str:
    """Return the message on the process `holding` the folder, with its age and a remedy.

    None stands for a process that is not known.
    """
    head = "another Snakemake is at work in this folder: "
    if holding is None:
        return (
            f"{head}its process is not known (another user's, or on another machine); wait until "
            "it ends, or look for it with `ps -ef | grep snakemake` on each machine that has this "
            "folder, and stop it with `kill -INT PID`, or with `kill -KILL PID` if it hangs"
        )
    pid, host, begun = holding
    on_host = "" if host == socket.gethostname() else f" on {host}"
    age = duration_text(time.time() - begun)
    return (
        f"{head}process {pid}{on_host}, which began {age} ago; wait until it "
        f"ends, or stop it{on_host} with `kill -INT {pid}`, or with `kill -KILL {pid}` if it hangs"
    )


def duration_text(seconds: float) -> str:
    """Return a duration (s) in its two largest units: 45 s, 3 min, 2 h 5 min."""
    elapsed = int(max(seconds, 0.0))
    days, hours, minutes = elapsed // 86400, elapsed // 3600 % 24, elapsed // 60 % 60
    if days:
        return f"{days} d {hours} h"
    if hours:
        return f"{hours} h {minutes} min"
    return f"{minutes} min" if minutes else f"{elapsed} s"


def advice_on_snakemakes_lock(path: str | Path) -> str:
    """Return the advice to add to Snakemake's message that its own lock exists.

    It depends on the lock of the file at `path`, ours. Unlike this one, Snakemake's lock outlives a
    process that is killed.
    """
    if is_held(path):
        return advice(holder(path))
    return (
        "no Snakemake is known to be at work in this folder: unless one runs on another machine, a "
        "killed one has left its lock; `snakemake --unlock`, then the same command"
    )
