"""What a hard case is made of: its marker, the margins that it measures, and the remedies.

A test of this catalogue is marked by `hard_case` and measures through the fixture `margins`; where
a remedy in the source keeps it from failing, a second test takes that remedy out (fixture
`without`) and expects the case to fail.
"""

import os
import shutil
import subprocess
import sys
from pathlib import Path
from typing import NamedTuple

import numpy as np
import pytest

import roughgas

PACKAGE = Path(roughgas.__file__).parent
ROOT = Path(__file__).parents[2]
BEYOND = "beyond its limit"


def hard_case(title: str, danger: str):
    """Mark a test as a case of the catalogue: what it is called, and what could go wrong."""
    return pytest.mark.hard_case(title=title, danger=danger)


class Margin(NamedTuple):
    """One number that a case measured, and where it would have failed."""

    family: str
    case: str
    danger: str
    what: str  # what was measured, with its unit
    measured: float
    sense: str  # "at most" or "at least" the limit
    limit: float
    tried: int
    unit: str  # what was tried so often


class Remedy(NamedTuple):
    """A part of the source without which a case was seen to fail."""

    family: str
    case: str
    remedy: str


class Margins:
    """Notes margins, and fails a test where one is beyond its limit.

    `full` says whether the case is tried as often as the command does, or only as often as there is
    time for among other tests.
    """

    def __init__(self, family: str, case: str, danger: str, full: bool):
        self.about = family, case, danger
        self.full = full
        self.rows: list[Margin] = []
        self.series: dict[str, dict[str, list[float]]] = {}

    def size(self, quick: int, full: int) -> int:
        """How often to try."""
        return full if self.full else quick

    def at_most(self, what: str, measured: float, limit: float, tried: int, unit: str) -> None:
        """`measured`, the largest of so many, must not exceed the limit; NaN does."""
        self._note(Margin(*self.about, what, float(measured), "at most", limit, int(tried), unit))
        assert measured <= limit, f"{what}: {measured:.3g} is {BEYOND}, at most {limit:g}"

    def at_least(self, what: str, measured: float, limit: float, tried: int, unit: str) -> None:
        """`measured`, the smallest of so many, must not be below the limit; NaN is."""
        self._note(Margin(*self.about, what, float(measured), "at least", limit, int(tried), unit))
        assert measured >= limit, f"{what}: {measured:.3g} is {BEYOND}, at least {limit:g}"

    def keep(self, picture: str, **columns) -> None:
        """Keep columns of numbers, for the picture of that name (see pictures.py)."""
        self.series[picture] = {name: np.asarray(x, float).tolist() for name, x in columns.items()}

    def _note(self, row: Margin) -> None:
        self.rows.append(row)
        print(f"{row.what}: {row.measured:.4g}, {row.sense} {row.limit:g}; {row.tried} {row.unit}")


class Without:
    """Runs a case in a process of its own, with a part of the source replaced."""

    def __init__(self, folder: Path, family: str):
        self.folder, self.family = folder, family
        self.rows: list[Remedy] = []

    def __call__(
        self, remedy: str, case, file: str, old: str, new: str, limit: float = 900
    ) -> None:
        """Expect the test function `case` to fail once `old` in a file of the package is `new`.

        It must do so because a margin is beyond its limit, within `limit` seconds.
        """
        copy = self.folder / "roughgas"
        shutil.copytree(PACKAGE, copy, ignore=shutil.ignore_patterns("__pycache__"))
        source = copy / file
        text = source.read_text(encoding="utf-8")
        assert text.count(old) == 1, f"{file} has this remedy {text.count(old)} times: {old}"
        source.write_text(text.replace(old, new), encoding="utf-8")
        result = self._run(f"{sys.modules[case.__module__].__file__}::{case.__name__}", limit)
        assert result.returncode == pytest.ExitCode.TESTS_FAILED, result.stdout
        assert BEYOND in result.stdout, result.stdout
        mark = next(mark for mark in case.pytestmark if mark.name == "hard_case")
        self.rows.append(Remedy(self.family, mark.kwargs["title"], remedy))

    def _run(self, test: str, limit: float) -> subprocess.CompletedProcess:
        environment = os.environ | {
            "PYTHONPATH": str(self.folder),
            "ROUGHGAS_CACHE_DIR": str(self.folder / "cache"),
        }
        environment.pop("PYTEST_ADDOPTS", None)
        command = [sys.executable, "-m", "pytest", "-x", "-n0", "-p", "no:cacheprovider", test]
        return subprocess.run(
            command, cwd=ROOT, env=environment, capture_output=True, text=True, timeout=limit
        )
