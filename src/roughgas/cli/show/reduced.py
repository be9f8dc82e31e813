"""A reduced dataset: all points of an experiment, over r and beta."""

import math
from typing import TYPE_CHECKING, Any

from roughgas.base.layout import columns
from roughgas.cli.show.parts import SHAPES, cost
from roughgas.data.reduced import EQUILIBRATED, third_axis
from roughgas.data.reduced import read_reduced as read
from roughgas.results.table import rows as rows_of
from roughgas.statistics.estimate import Estimate
from roughgas.theory.prediction import equation_of

if TYPE_CHECKING:
    import xarray

__all__ = ["read", "record", "text"]

HEAD = ["R", "95 %", "theory", "residual"]


def record(data: "xarray.Dataset") -> dict[str, Any]:
    """Return attributes, and a row for each place."""
    rows = [{name: value for name, value in row.items() if value != ""} for row in rows_of(data)]
    return {"attributes": data.attrs, "points": rows}


def text(data: "xarray.Dataset") -> str:
    """Return a summary for a person."""
    about, swept = data.attrs, third_axis(data.attrs)
    axes = [*([swept] if swept else []), "r", "beta"]
    table = [[*axes, "seeds", *(HEAD if "R" in data else ["E_trans"]), "steady"]]
    for row in rows_of(data):
        value = row["value"]
        place = [value if isinstance(value, str) else f"{value:g}"] if swept else []
        place += [f"{row['r']:g}", f"{row['beta']:g}", f"{row['n_seeds']:.0f}"]
        steady = "yes" if row["equilibrated"] > EQUILIBRATED else "NO"
        table.append([*place, *_found(row), steady])
    over = f"{swept}, r and beta" if swept else "r and beta"
    head = [
        ["experiment", f"{about['experiment']}, scale {about['scale']}"],
        ["gas", f"{about['particles']} {SHAPES[int(about['dimension'])]}"],
        ["points", f"{len(table) - 1} over {over}"],
        ["cost", cost(data.sum())],
    ]
    return f"{columns(head)}\n\n{columns(table, numbers=True)}\n\n{_notes(data)}"


def _found(row: dict[str, Any]) -> list[str]:
    """Return the cells of the result; a column that is not there is empty in `row`."""
    name = "R" if row["R"] != "" else "E_trans"
    value = f"{Estimate(row[name], row[f'{name}_stderr'] or math.nan)}"
    if name == "E_trans":
        return [value]
    half = f"{row['R_ci95']:.4f}{'' if row['R_ci95_trusted'] == 1.0 else '?'}"
    return [value, half, f"{row['R_theory']:.4f}", f"{row['residual']:+.4f}"]


def _notes(data: "xarray.Dataset") -> str:
    if "R" not in data:
        return "Energies per degree of freedom; their error is the scatter over seeds."
    return (
        "95 %: half width of the interval; ?: it may be too narrow, as the run is short.\n"
        f"Theory: {equation_of(data.attrs).name}."
    )
