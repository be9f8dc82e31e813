"""Comparison of published numbers with ours: rows of evidence, and their tables as CSV.

A row is a line of CSV, and names its source, so that it can be checked. All rows are kept, also
disagreeing ones. An `Estimate` is a number with its standard error and the degrees of freedom of
the error. Verdicts are on all rows together: see row_verdicts.py.
"""

import csv
import math
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import NamedTuple

import numpy as np

from roughgas.base import InputError, NamedValues, Record, in_csv
from roughgas.base.files import atomic_write
from roughgas.statistics.estimates import Estimate

TIERS = {
    "exact": "exact result",
    "simulation": "another group's simulation",
    "experiment": "experiment",
    "theory": "approximate theory",
    "own": "second code of our own",
}
"""Kinds of published numbers, in descending weight."""
STORED = (
    *("study", "quantity", "at", "tier", "source", "read", "theirs", "theirs_stderr"),
    *("ours", "ours_stderr", "ours_dof"),
)
"""Columns that a row is read from, beside its texts on the right."""
DERIVED = ("t", "dof", "probability")
"""Columns that follow from the row: `gap` over its error, degrees of freedom, and probability."""
TEXTS = "corrections", "reason"
COLUMNS = (*STORED, *DERIVED, *TEXTS)
ROUNDING = 1e-9
"""Errors below this share of a published number are of rounding: no simulation has them."""


class Row(NamedTuple):
    """A published number and ours, for a gas with the parameters `at`, such as "r = 0.9".

    An exact number has the error 0; NaN stands for an error that the source does not give.
    """

    quantity: str
    at: str
    tier: str  # a key of TIERS
    source: str  # authors, year, DOI
    read: str  # the equation, figure, table or file that it was read from, and how
    theirs: Estimate
    ours: Estimate
    corrections: str = ""  # applied to ours, for size or packing, with their magnitude
    reason: str = ""  # known reasons for a difference

    @property
    def gap(self) -> Estimate:
        """Ours minus theirs, with the combined error; a missing error of theirs counts as 0."""
        error = np.nan_to_num(self.theirs.stderr)
        return self.ours.minus(self.theirs._replace(stderr=float(error)))

    @property
    def t(self) -> float:
        """The gap in combined standard errors; NaN without our error."""
        return self.gap.t

    @property
    def probability(self) -> float:
        """Two-sided probability of the gap by chance, by Student's t; NaN without our error.

        The degrees of freedom of the combined error follow Welch and Satterthwaite; published
        errors have infinitely many.
        """
        return self.gap.probability

    @property
    def z(self) -> float:
        """Gaussian deviate as improbable as the gap, for axes that rows of all errors share."""
        return self.gap.sigma

    @property
    def is_without_error(self) -> bool:
        """Whether the source gives no error: ours alone then decides."""
        return math.isnan(self.theirs.stderr)

    @property
    def is_without_chance(self) -> bool:
        """Whether the error is at most of rounding, as for single contacts and counted cycles."""
        return self.gap.stderr < ROUNDING * abs(self.theirs.value)


def write_rows(study: str, rows: Iterable[Row], output: str | Path) -> None:
    """Write the rows of evidence of a study, given by its name, as CSV to `output`.

    Raises ValueError for an unknown tier.
    """
    write_table([row_cells(study, row) for row in rows], COLUMNS, output)


def read_rows(path: str | Path) -> list[tuple[str, Row]]:
    """Return the rows of evidence in a CSV, each as (name of its study, row).

    Columns that follow from others are not read. Raises InputError for a table without the rest.
    """
    return [(cells["study"], _row(cells)) for cells in _read(path)]


def row_cells(study: str, row: Row) -> NamedValues:
    """Return the cells of a row of a study by column, numbers as text.

    Raises ValueError for an unknown tier.
    """
    if row.tier not in TIERS:
        raise ValueError(f"tier {row.tier!r} of {row.quantity}: must be one of {', '.join(TIERS)}")
    gap = row.gap
    numbers = {
        "theirs": row.theirs.value,
        "theirs_stderr": row.theirs.stderr,
        "ours": row.ours.value,
        "ours_stderr": row.ours.stderr,
        "ours_dof": row.ours.dof,
        "t": gap.t,
        "dof": gap.dof,
        "probability": gap.probability,
    }
    return row._asdict() | {"study": study} | {k: number_cell(x) for k, x in numbers.items()}


def number_cell(number: float) -> str:
    """Return a number as the text of a cell, nine digits."""
    return f"{float(number):.9g}"


def write_table(rows: Iterable[Record], columns: Iterable[str], output: str | Path) -> None:
    """Write rows of cells by column as CSV with these columns, atomically."""
    columns = tuple(columns)
    with atomic_write(output) as draft, open(draft, "w", newline="", encoding="utf-8") as file:
        table = csv.writer(file, lineterminator="\n")
        table.writerow(columns)
        table.writerows([in_csv(row[name]) for name in columns] for row in rows)


def _row(cells: dict[str, str]) -> Row:
    """Return the row of evidence from its cells by column."""
    theirs = Estimate(float(cells["theirs"]), float(cells["theirs_stderr"]))
    ours = Estimate(*(float(cells[name]) for name in ("ours", "ours_stderr", "ours_dof")))
    texts = {name: cells[name] for name in Row._fields if name not in ("theirs", "ours")}
    return Row(theirs=theirs, ours=ours, **texts)


def _read(path: str | Path) -> Iterator[dict[str, str]]:
    """Yield the rows of a CSV of evidence as texts by column.

    Raises InputError for a table that lacks a column.
    """
    with open(path, newline="", encoding="utf-8") as file:
        table = csv.DictReader(file)
        if missing := {*STORED, *TEXTS} - {*(table.fieldnames or ())}:
            names = ", ".join(name for name in (*STORED, *TEXTS) if name in missing)
            raise InputError("table of evidence", path, f"have the columns {names}, too")
        yield from ({key: text.removeprefix("'") for key, text in row.items()} for row in table)
