"""Text files with tables of particles; messages name the file, the line and the column."""

import os
import stat
from collections import deque
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import NamedTuple, NoReturn, SupportsIndex, TypeVar

import numpy as np

from roughgas.base import InputError, short_repr
from roughgas.base.files import LEGAL_FILE

MAX_PARTICLES = 100_000_000
LARGEST_FRAME = 1_000_000_000
LARGEST_ID = 2**53
AXES = "xyz"
F = TypeVar("F")


class TextFile:
    """The lines of an open text file; `number` is the number of the latest, from 1."""

    def __init__(self, path: str | Path, lines: Iterator[str]) -> None:
        """Store the path, for messages, and the lines."""
        self.path, self.number, self._lines = path, 0, lines

    def __iter__(self) -> Iterator[str]:
        """Yield the remaining lines, without white space at their ends.

        Raises InputError for a line without an end: its last number may be cut off.
        """
        for line in self._lines:
            self.number += 1
            if not line.endswith("\n"):
                self.refuse(line, "end with a new line: the file is cut off")
            yield line.strip()

    def line(self, content: str) -> str:
        """Return the next line; raise InputError, which names its `content`, at the end."""
        line = next(iter(self), None)
        if line is None:
            raise InputError(f"{self.path}, line {self.number + 1}", "(end)", f"be {content}")
        return line

    def rows(self, count: int, columns: Sequence[str]) -> "Rows":
        """Return the next `count` lines, which have these columns; raise InputError at the end."""
        first = self.number + 1
        lines = [self.line(f"particle {k} of {count}") for k in range(1, count + 1)]
        return Rows(self.path, range(first, first + count), lines, tuple(columns))

    def count(self, text: str) -> int:
        """Return the number of particles in `text`; raise InputError for an illegal number."""
        if not text.isdecimal() or not 1 <= int(text[:20]) <= MAX_PARTICLES:
            self.refuse(text, f"be a number of particles in [1, {MAX_PARTICLES}]")
        return int(text)

    def numbers(self, text: str, count: int) -> list[float]:
        """Return the `count` numbers in `text`; raise InputError for others, or another count."""
        numbers = [_number(word) for word in text.split()]
        if len(numbers) != count or not np.isfinite(numbers).all():
            self.refuse(text, f"be {count} finite numbers")
        return numbers

    def refuse(self, value: str, legal: str) -> NoReturn:
        """Raise InputError for a `value` in the present line."""
        raise InputError(f"{self.path}, line {self.number}", short_repr(value), legal)


@contextmanager
def text_file(path: str | Path) -> Iterator[TextFile]:
    """Open a text file. Bytes that are no UTF-8 become a character of no number.

    Raises InputError for anything except a regular file, OSError where it cannot be read.
    """
    if not stat.S_ISREG(os.stat(path).st_mode):
        raise InputError("file", path, LEGAL_FILE)
    with open(path, encoding="utf-8", errors="replace") as file:
        yield TextFile(path, iter(file))


class Rows(NamedTuple):
    """Lines of a file, with the names of their columns; numbers are of lines, from 1."""

    path: str | Path
    numbers: Sequence[int]
    lines: Sequence[str]
    columns: tuple[str, ...]

    def table(self) -> "Table":
        """Return the lines as a table, in the order of the column `id` if there is one.

        Raises InputError for a line with another number of columns, and for an `id` twice.
        """
        words = [line.split() for line in self.lines]
        for number, row in zip(self.numbers, words, strict=True):
            if len(row) != len(self.columns):
                legal = f"be {len(self.columns)}: {short_repr(' '.join(self.columns))}"
                raise InputError(f"{self.path}, line {number}: columns", len(row), legal)
        table = Table(self.path, self.numbers, words, self.columns)
        if "id" not in self.columns:
            return table
        ids = table.integers("id", 0, LARGEST_ID)
        order = np.argsort(ids, kind="stable")
        for row in order[1:][np.diff(ids[order]) == 0]:
            table.refuse(row, "id", ids[row], "be the number of one particle")
        numbers = [self.numbers[row] for row in order]
        return Table(self.path, numbers, [words[row] for row in order], self.columns)


class Table(NamedTuple):
    """Words of lines in named columns; numbers are of lines, from 1."""

    path: str | Path
    numbers: Sequence[int]
    words: Sequence[list[str]]
    columns: tuple[str, ...]

    def texts(self, name: str) -> list[str]:
        """Return the words in the column `name`."""
        column = self.columns.index(name)
        return [row[column] for row in self.words]

    def values(self, *names: str) -> np.ndarray:
        """Return the numbers in these columns, (lines, columns); raise InputError for other words,
        and for numbers that are not finite."""
        indices = [self.columns.index(name) for name in names]
        words = [[row[index] for index in indices] for row in self.words]
        try:
            values = np.array(words, float)
        except ValueError:
            values = np.array([[_number(word) for word in row] for row in words])
        for row, column in np.argwhere(~np.isfinite(values)):
            self.refuse(row, names[column], short_repr(words[row][column]), "be a finite number")
        return values

    def positive(self, *names: str) -> np.ndarray | None:
        """Return the numbers (lines,) in the first of these columns that is there, or None.

        Raises InputError for numbers that are not positive.
        """
        for name in names:
            if name in self.columns:
                values = self.values(name)[:, 0]
                for row in np.flatnonzero(values <= 0.0):
                    self.refuse(row, name, values[row], "be positive")
                return values
        return None

    def radius(self) -> np.ndarray | None:
        """Return the radii (lines,), or halves of the diameters; None without either column.

        Raises InputError as `positive`.
        """
        diameter = self.positive("diameter")
        return self.positive("radius") if diameter is None else diameter / 2.0

    def integers(self, name: str, low: int, high: int) -> np.ndarray:
        """Return the whole numbers in the column `name`; raise InputError outside [low, high]."""
        values = self.values(name)[:, 0]
        illegal = (values != np.floor(values)) | (values < low) | (values > high)
        for row in np.flatnonzero(illegal):
            self.refuse(row, name, values[row], f"be a whole number in [{low}, {high}]")
        return values.astype(np.int64)

    def vectors(self, *patterns: str) -> np.ndarray | None:
        """Return vectors (lines, 3) from three columns; None if they are not there.

        In the first pattern with a column for x, such as "v*", the star stands for x, y and z. A
        vector without z lies in the plane z = 0. Raises InputError if y is missing.
        """
        for pattern in patterns:
            x, y, z = (pattern.replace("*", axis) for axis in AXES)
            if x in self.columns:
                self.require(y)
                names = [x, y, z] if z in self.columns else [x, y]
                return np.pad(self.values(*names), ((0, 0), (0, 3 - len(names))))
        return None

    def require(self, name: str) -> None:
        """Raise InputError without a column `name`; alternatives are joined, as in "x or xs"."""
        if not {*name.split(" or ")} & {*self.columns}:
            key = f"{self.path}, above line {min(self.numbers)}: columns"
            raise InputError(key, short_repr(" ".join(self.columns)), f"have {name} among them")

    def refuse(self, row: SupportsIndex, column: str, value: object, legal: str) -> NoReturn:
        """Raise InputError for a `value` in a row, counted from 0, and a column."""
        key = f"{self.path}, line {self.numbers[int(row)]}, column {column}"
        raise InputError(key, value, legal)


def _number(word: str) -> float:
    """Return the number that a word stands for; NaN for none."""
    try:
        return float(word)
    except ValueError:
        return float("nan")


def chosen_frame(frames: Iterator[F], number: int, path: str | Path) -> F:
    """Return the frame `number` of the file at `path`: from 0, or from its end if negative.

    Raises InputError for a number that the file does not have.
    """
    last: deque[F] = deque(maxlen=max(1, min(-number, LARGEST_FRAME)))
    count = 0
    for frame in frames:
        if count == number:
            return frame
        last.append(frame)
        count += 1
    check_frame(number, count, path)
    return last[0]


def check_frame(number: int, count: int, path: str | Path) -> None:
    """Raise InputError unless a file with `count` frames has the frame `number`, which counts from
    the end if negative."""
    if not count:
        raise InputError("file", path, "have a frame")
    if not -count <= number < count:
        legal = f"lie in [{-count}, {count - 1}]: {path} has {count}"
        raise InputError("frame", number, legal)
