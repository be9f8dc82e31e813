"""What a hard case is made of: its words, in cases.yaml, and the margins that it measures.

A test of this catalogue measures through the fixture `margins`.
"""

from pathlib import Path
from typing import NamedTuple

import numpy as np
import yaml

BEYOND = "beyond its limit"
CASES = yaml.safe_load(Path(__file__).with_name("cases.yaml").read_text(encoding="utf-8"))
"""By module and test: what the case is called, and what could go wrong."""


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
