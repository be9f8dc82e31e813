"""Hard cases: their descriptions, in cases.yaml, and the margins that they measure.

A test of this catalogue measures through the fixture `margins`.
"""

import math
from pathlib import Path
from typing import NamedTuple

import numpy as np
import yaml

from hard_cases.checkpoint import FinishedCases
from roughgas.simulation.progress import ProgressBar

BEYOND = "beyond its limit"
CASES = yaml.safe_load(Path(__file__).with_name("cases.yaml").read_text(encoding="utf-8"))
"""The title of a case and its danger (a possible failure), by module and test."""


class Margin(NamedTuple):
    """A number that a case measured, and its limit."""

    family: str
    case: str
    danger: str
    what: str  # name of the measured quantity, with its unit
    measured: float
    sense: str  # "at most" or "at least" the limit
    limit: float
    tried: int  # number of trials
    unit: str  # of the trials: "pairs", "collisions", ...


class Remedy(NamedTuple):
    """A safeguard in the source without which a case failed."""

    family: str
    case: str
    remedy: str


def errors_of_share(share: float, tried: int) -> float:
    """Return three standard errors of a share that is measured in a number of trials: the allowance
    of a limit on it for chance."""
    return 3.0 * math.sqrt(share * (1.0 - share) / tried)


class Progress:
    """The progress of a run through its cases and within the present case, shown by a bar."""

    bar: ProgressBar | None = None
    name = "hard cases"

    def __init__(self) -> None:
        self.cases = self._ended = self._done = self._total = 0
        self._unit = ""

    def __str__(self) -> str:
        cases = f"{self._ended} of {self.cases} cases"
        return f"{cases}, and of the next one {self._within()}," if self._unit else cases

    def end_case(self) -> None:
        """Count a case that passed."""
        self._ended += 1
        self._done, self._total, self._unit = 0, 0, ""
        self._show()

    def reach(self, done: int, total: int, unit: str) -> None:
        """Report the progress of the present case, such as 90 of 1500 scenes."""
        self._done, self._total, self._unit = done, total, unit
        self._show()

    def _within(self) -> str:
        return f"{self._done} of {self._total} {self._unit}"

    def _show(self) -> None:
        if self.bar:
            share = (self._ended + self._done / max(self._total, 1)) / max(self.cases, 1)
            self.bar.reach(self._ended, self._within() if self._unit else "", share=share)


class Margins:
    """The margins of a case; a margin beyond its limit fails the test.

    With `full` a case has all trials, as in the command, else few, as among other tests.
    `finished` has the finished blocks of the case; `progress` gets its progress.
    """

    def __init__(
        self,
        family: str,
        case: str,
        danger: str,
        full: bool,
        finished: FinishedCases | None = None,
        progress: Progress | None = None,
    ):
        self.identity = family, case, danger
        self.full = full
        self.finished = FinishedCases() if finished is None else finished
        self.progress = progress or Progress()
        self.rows: list[Margin] = []
        self.series: dict[str, dict[str, list[float]]] = {}

    def size(self, quick: int, full: int) -> int:
        """Return the number of trials."""
        return full if self.full else quick

    def at_most(self, quantity: str, measured: float, limit: float, tried: int, unit: str) -> None:
        """Fail if `measured`, the largest value of all trials, exceeds the limit or is NaN."""
        self._record(
            Margin(*self.identity, quantity, float(measured), "at most", limit, int(tried), unit)
        )
        assert measured <= limit, f"{quantity}: {measured:.3g} is {BEYOND}, at most {limit:g}"

    def at_least(self, quantity: str, measured: float, limit: float, tried: int, unit: str) -> None:
        """Fail if `measured`, the smallest value of all trials, is below the limit or is NaN."""
        self._record(
            Margin(*self.identity, quantity, float(measured), "at least", limit, int(tried), unit)
        )
        assert measured >= limit, f"{quantity}: {measured:.3g} is {BEYOND}, at least {limit:g}"

    def keep(self, picture: str, **columns) -> None:
        """Store columns of numbers for a picture (see pictures.py)."""
        self.series[picture] = {name: np.asarray(x, float).tolist() for name, x in columns.items()}

    def _record(self, row: Margin) -> None:
        """Store and print a margin."""
        self.rows.append(row)
        print(f"{row.what}: {row.measured:.4g}, {row.sense} {row.limit:g}; {row.tried} {row.unit}")
