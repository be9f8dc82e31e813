"""A reduced dataset: all points of an experiment, over r and beta."""

import math
from typing import TYPE_CHECKING, Any

from roughgas.cli.layout import columns, with_error
from roughgas.cli.show.point import SHAPES, cost
from roughgas.data.reduced import EQUILIBRATED, third_axis
from roughgas.data.reduced import read_reduced as read
from roughgas.results.table import rows as rows_of
from roughgas.theory.prediction import equation_of

if TYPE_CHECKING:
    import xarray

__all__ = ["read", "record", "text"]


def record(data: "xarray.Dataset") -> dict[str, Any]:
    """Attributes, and a row for each place, for a script."""
    rows = [{name: value for name, value in row.items() if value != ""} for row in rows_of(data)]
    return {"attributes": data.attrs, "points": rows}


def text(data: "xarray.Dataset") -> str:
    """For a person."""
    about, swept = data.attrs, third_axis(data.attrs)
    spins = "R" in data
    table = [[*([swept] if swept else []), "r", "beta", "seeds", *_head(spins), "steady"]]
    for row in rows_of(data):
        value = row["value"]
        place = [value if isinstance(value, str) else f"{value:g}"] if swept else []
        place += [f"{row['r']:g}", f"{row['beta']:g}", f"{row['n_seeds']:.0f}"]
        steady = "yes" if row["equilibrated"] > EQUILIBRATED else "NO"
        table.append([*place, *_found(row, spins), steady])
    axes = "r and beta" if swept is None else f"{swept}, r and beta"
    gas = f"{about['particles']} {SHAPES[int(about['dimension'])]}"
    head = [
        ["experiment", f"{about['experiment']}, scale {about['scale']}"],
        ["gas", gas],
        ["points", f"{len(table) - 1} over {axes}"],
        ["cost", cost(data.sum())],
    ]
    return f"{columns(head)}\n\n{columns(table, numbers=True)}\n\n{_notes(about, spins)}"


def _head(spins: bool) -> list[str]:
    return ["R", "95 %", "theory", "residual"] if spins else ["E_trans"]


def _found(row: dict[str, Any], spins: bool) -> list[str]:
    if not spins:
        return [with_error(row["E_trans"], _error(row["E_trans_stderr"]))]
    trust = "" if row["R_ci95_trusted"] == 1.0 else "?"
    return [
        with_error(row["R"], _error(row["R_stderr"])),
        f"{row['R_ci95']:.4f}{trust}",
        f"{row['R_theory']:.4f}",
        f"{row['residual']:+.4f}",
    ]


def _error(value: Any) -> float:
    """NaN where a column is not there."""
    return math.nan if value == "" else value


def _notes(about: dict[str, Any], spins: bool) -> str:
    if not spins:
        return "Energies per degree of freedom; their error is the scatter over seeds."
    return (
        "95 %: half width of the interval; ?: it may be too narrow, the run being short.\n"
        f"Theory: {equation_of(about).name}."
    )
