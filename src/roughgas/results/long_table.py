"""Tables of results that take hours: studies/NAME/long.csv, committed beside the code of a study.

`snakemake evidence_long` writes them from simulations at the scale `long`, which long.py of the
study has in `long_table(*datasets)`. The study's evidence, judges and figures read them, so that
the commands of minutes need no hours.
"""

import csv
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import NamedTuple

from roughgas.base import InputError
from roughgas.base.files import atomic_write
from roughgas.statistics.estimates import Estimate

COLUMNS = ("quantity", "parameters", "value", "stderr", "dof", "cpu_hours")


class LongRow(NamedTuple):
    """A measured quantity of a gas with the parameters, by name, and the CPU time in hours."""

    quantity: str
    parameters: Mapping[str, float | str]
    estimate: Estimate
    cpu_hours: float


def write_long_rows(rows: Iterable[LongRow], output: str | Path) -> None:
    """Write rows as CSV to `output`; parameters are written as "name=value; name=value"."""
    with atomic_write(output) as path, open(path, "w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(COLUMNS)
        for row in rows:
            parameters = "; ".join(f"{name}={value}" for name, value in row.parameters.items())
            numbers = (*row.estimate, row.cpu_hours)
            writer.writerow([row.quantity, parameters, *(f"{number:.6g}" for number in numbers)])


def read_long_rows(path: str | Path) -> list[LongRow]:
    """Return the rows of a table; [] if there is none. Raises InputError for other columns."""
    if not Path(path).exists():
        return []
    with open(path, encoding="utf-8", newline="") as file:
        reader = csv.DictReader(file)
        if tuple(reader.fieldnames or ()) != COLUMNS:
            raise InputError(f"columns of {path}", reader.fieldnames, f"be {', '.join(COLUMNS)}")
        return [_row(cells) for cells in reader]


def _row(cells):
    """Return the row with these cells, by column; numbers among its parameters are floats."""
    pairs = (pair.partition("=") for pair in cells["parameters"].split("; "))
    estimate = Estimate(*(float(cells[name]) for name in ("value", "stderr", "dof")))
    parameters = {name: _number_or_text(value) for name, _, value in pairs}
    return LongRow(cells["quantity"], parameters, estimate, float(cells["cpu_hours"]))


def _number_or_text(value):
    """Return a text as a float, or as it is if it is no number."""
    try:
        return float(value)
    except ValueError:
        return value
