"""Copies of finished points, stored until all points of a command are finished.

If a job fails, the workflow deletes all its outputs, including finished ones. Next to each output
lies a hard link to it or, on a disk without links, a copy. Its name contains the hash of the run
that made it, as the owner of a checkpoint does.
"""

import glob
import os
import shutil
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path

from roughgas.base import InputError
from roughgas.base.files import atomic_write, remove_dead_drafts
from roughgas.data.netcdf import is_foreign
from roughgas.data.point import Point, read_point, write_point
from roughgas.simulation.progress import print_line

OWNER_DIGITS = 16
"""Digits of the owner's hash in the name of a file."""


class FinishedPoints:
    """The stored copies of finished points of a command that simulates several."""

    def __init__(self, outputs: Sequence[str]) -> None:
        """Manage the copies of the points whose datasets have the paths `outputs`."""
        self._outputs = outputs
        self._owner, self._is_taken = "", False
        self._count = 0

    def take(self, output: str, owner: str) -> Point | None:
        """Restore the file `output` from its stored copy, and return the point.

        `owner` is the hash of the point's run; copies of runs with other hashes are not used.
        Returns None if the point must be simulated. Damaged files and files of other runs are
        removed. The point has no coordinates. Raises InputError if the stored path is no file,
        OSError.
        """
        kept_path = _kept_path(output, owner)
        self._owner, self._is_taken = owner, False
        for path in _kept_files(output):
            if not path.is_file():
                raise InputError("finished point", path, "be a file")
            if path != kept_path:
                _discard_file(path, "belongs to other settings or to other sources")
        if not kept_path.exists():
            return None
        try:
            point = _read_kept_point(kept_path)
        except InputError:
            _discard_file(kept_path, "is damaged")
            return None
        _link(kept_path, output)
        os.utime(output)  # else a workflow takes it for older than its input
        print_line(f"{output} is finished: it was kept in {kept_path}")
        self._is_taken = True
        self._count += 1
        return point

    def write(self, output: str, point: Point) -> None:
        """Write a point to the file `output`, and store a copy, unless `take` has restored it.

        A failure to store the copy is only reported. Raises OSError if the file cannot be written.
        """
        if self._is_taken:
            return
        write_point(output, point)
        try:
            _link(output, _kept_path(output, self._owner))
            self._count += 1
        except OSError as error:  # the output itself is written
            print_line(f"{output} cannot be kept for another run: {error.strerror}")

    def discard(self) -> None:
        """Remove the stored copies of all points."""
        for output in self._outputs:
            for path in _kept_files(output):
                path.unlink(missing_ok=True)
            remove_dead_drafts(Path(output))

    @contextmanager
    def advising(self) -> Iterator[None]:
        """Add the number of stored points to the message of KeyboardInterrupt."""
        try:
            yield
        except KeyboardInterrupt as stop:
            if not self._count:
                raise
            summary = f"{self._count} of {len(self._outputs)} points are kept"
            advice = [*map(str, stop.args)] or ["the same command makes the others"]
            raise KeyboardInterrupt("; ".join([summary, *advice])) from None


def _kept_path(output: str, owner: str) -> Path:
    """Return the path of the stored copy of an output.

    Its name contains the hash `owner` of the run.
    """
    return Path(f"{output}.finished.{owner[:OWNER_DIGITS]}")


def _kept_files(output: str) -> list[Path]:
    """Return the paths of the stored copies of an output, of any run."""
    output_path = Path(output)
    paths = output_path.parent.glob(f"{glob.escape(output_path.name)}.finished.*")
    return sorted(path for path in paths if path.suffix != ".tmp")


def _discard_file(path: Path, reason: str) -> None:
    """Remove a stored copy, and print the `reason`, the end of a sentence."""
    print_line(f"{path} {reason}: starting afresh")
    path.unlink(missing_ok=True)


def _read_kept_point(path: Path) -> Point:
    """Return a point from its stored copy at `path`: variables without coordinates, and attributes.

    Raises InputError if the file was changed since it was written.
    """
    data = read_point(path)
    if is_foreign(path):
        raise InputError("finished point", path, "be as it was written")
    return Point({str(name): array.values for name, array in data.data_vars.items()}, data.attrs)


def _link(source: str | Path, target: str | Path) -> None:
    """Make `target` a hard link to `source`, or else a copy of it. Raises OSError."""
    try:
        os.link(source, target)
    except OSError:  # `target` exists, or the disk has no hard links
        with atomic_write(target) as draft:
            try:
                os.link(source, draft)
            except OSError:
                shutil.copyfile(source, draft)
