"""The summaries of many points: a reduced dataset, a study, a task of one, a pilot."""

import json
import math
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from roughgas.base.layout import columns
from roughgas.cli.show.gas import SHAPES, cost, scalars
from roughgas.data.reduced import EQUILIBRATED, third_axis
from roughgas.results.table import rows as rows_of
from roughgas.statistics.estimate import Estimate
from roughgas.theory.prediction import equation_of

if TYPE_CHECKING:
    import xarray

    from roughgas.planning.pilot import Pilot

FOUND = ["R", "95 %", "theory", "residual"]
MOST_VALUES = 4  # of a variable, that are all shown
UNIT = "T (cooling gas: collisions per particle)"
MEANING = {
    "transient": f"until energies are steady, in {UNIT}",
    "autocorrelation_time": f"of R, in {UNIT}",
    "variance": "of the mean of R over a length of one",
    "dof": "degrees of freedom of the variance",
    "pace": "collisions per particle in a length of one",
    "seconds_per_length": "s of CPU time",
    "settled": "whether a steady state was found",
    "length": f"that was simulated, in {UNIT}",
    "seconds": "s of CPU time that the pilot took",
}


def reduced_record(data: "xarray.Dataset") -> dict[str, Any]:
    """Return a row for each place."""
    return {
        "points": [{k: value for k, value in row.items() if value != ""} for row in rows_of(data)]
    }


def reduced_text(data: "xarray.Dataset") -> str:
    """Return the summary of all points of an experiment."""
    about, swept = data.attrs, third_axis(data.attrs)
    axes = [*([swept] if swept else []), "r", "beta"]
    table = [[*axes, "seeds", *(FOUND if "R" in data else ["E_trans"]), "steady"]]
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


def task_record(data: "xarray.Dataset") -> dict[str, Any]:
    """Return the sizes and single numbers of a task of a study of accuracy, or of a study."""
    return {"sizes": dict(data.sizes), "variables": scalars(data)}


def task_text(data: "xarray.Dataset") -> str:
    """Return the summary of a task of a study of accuracy."""
    about = data.attrs
    chosen = json.loads(about["settings_json"])["study"]
    head = [["task", f"{about['task']} of the study {about['study']}, scale {about['scale']}"]]
    head += [[key, str(one)] for key, one in chosen.items() if not isinstance(one, dict | list)]
    table = [["variable", "over", "value"]]
    for name, one in data.variables.items():
        over = ", ".join(f"{dim} ({data.sizes[dim]})" for dim in one.dims)
        table.append([name, over, _values(one.values)])
    again = f"roughgas study {about['study']} {about['task']} --scale {about['scale']} -o task.nc"
    return "\n\n".join([columns(head), columns(table), f"To make it again: {again}"])


def _values(values: np.ndarray) -> str:
    """Return few values as they are, many as their range."""
    if values.size <= MOST_VALUES or values.dtype.kind not in "fiu":
        return ", ".join(_one(value) for value in values.ravel()[:MOST_VALUES])
    there = values[np.isfinite(values)]
    if not there.size:
        return "nothing"
    return f"{_one(there.min())} to {_one(there.max())}, {_one(there.mean())} on average"


def _one(value: Any) -> str:
    return str(value) if isinstance(value, str) else f"{value:.5g}"


def studies_record(studies: Mapping[str, "xarray.Dataset"]) -> dict[str, Any]:
    """Return what there is of each study."""
    found = {name: {"attributes": one.attrs} | task_record(one) for name, one in studies.items()}
    return {"studies": found}


def studies_text(studies: Mapping[str, "xarray.Dataset"]) -> str:
    """Return what `roughgas tables` writes."""
    from roughgas.studies.accuracy.tables import TABLES

    scales = {data.attrs["scale"] for data in studies.values()}
    parts = [TABLES[name](data).strip() for name, data in studies.items()]
    return "\n\n".join([f"scale {', '.join(sorted(scales))}", *parts])


def pilot_record(pilot: "Pilot") -> dict[str, Any]:
    """Return all of a pilot."""
    return {"variables": pilot._asdict()}


def pilot_text(pilot: "Pilot") -> str:
    """Return the summary of a pilot: what the cost and the error of a point follow from."""
    rows = []
    for name, value in pilot._asdict().items():
        shown = ("no", "yes")[value] if isinstance(value, bool) else f"{value:.5g}"
        rows.append([name, shown, MEANING[name]])
    error = (pilot.variance / 1000.0) ** 0.5
    note = f"A run that measures for a length of 1000 finds R to about {error:.2g}."
    return f"{columns(rows)}\n\n{note}"
