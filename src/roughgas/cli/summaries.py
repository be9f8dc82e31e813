"""What `roughgas show` says of a point, of studies and of their tasks."""

import json
import math
from collections.abc import Mapping
from typing import Any

import numpy as np
from xarray import DataArray, Dataset

from roughgas.base.formatting import columns
from roughgas.data.netcdf import unit_of
from roughgas.statistics.errors import NO, UNKNOWN, YES, Estimate
from roughgas.theory.prediction import equation_of

FEW = 0.01
"""Share of contacts altered by the contact-time model, above which a result depends on it."""
OF_SPECIES = ("E_trans", "E_rot", "R")


def theory_beside(point: Dataset, R: float, expected: float) -> list[list[str]]:
    """Return what theory says of R, and how far off R is; or why it says nothing."""
    name = equation_of(point.attrs, point).name
    if math.isnan(expected):
        spins = "contacts change no spin, and spins that are 0 stay so"
        return [["theory", f"none ({name}): at beta = -1 {spins}"]]
    return [["theory", f"{expected:.4f}, {name}: R is {_off(R, expected)} it"]]


def collisional(point: Dataset) -> list[list[str]]:
    """Return R averaged over collisions, as the theory of a driven gas is."""
    if "R_collisional" not in point:
        return []
    found = Estimate(float(point.R_collisional), float(point.R_collisional_stderr))
    like = equation_of(point.attrs, point).name
    said = f"averaged over collisions, as {like}"
    if "R_unsubtracted" in point:
        said = f"averaged over collisions, mean flow and mean spin included, unlike {like}"
    return [["R_collisional", f"{found}, {said}"]]


def energies(point: Dataset) -> list[list[str]]:
    """Return the energies of a point, with their errors where they are known."""
    when = ", as the measurement begins" if "plateau_end" in point else ""
    return [
        [name, f"{_estimate(point, name)} {_unit(point[name])}, per degree of freedom{when}"]
        for name in ("E_trans", "E_rot")
        if name in point
    ]


def altered(point: Dataset) -> list[list[str]]:
    """Return how many contacts the contact-time model has altered, where it acts."""
    share = float(point.get("contact_time_fraction", 0.0))
    if not share > 0.0:
        return []
    said = f"{100.0 * share:.2g} % of contacts were altered by the contact-time model"
    return [["contact time", f"{said}: R depends on it" if share > FEW else said]]


def by_species(point: Dataset) -> str:
    """Return a row for each species of a mixture."""
    there = [name for name in OF_SPECIES if f"{name}_species" in point]
    rows = [["species", "particles", *there]]
    for k, name in enumerate(point.species.values):
        one = point.isel(species=k)
        found = [_estimate(one, f"{name}_species") for name in there]
        rows.append([str(name), str(int(one.species_particles)), *found])
    return columns(rows, numbers=True)


def _estimate(point: Dataset, name: str) -> str:
    return f"{Estimate(float(point[name]), float(point.get(f'{name}_stderr', math.nan)))}"


def _unit(array: DataArray) -> str:
    return unit_of(array.attrs)


def _off(value: float, expected: float) -> str:
    return f"{abs(value - expected):.4f} {'below' if value < expected else 'above'}"


MOST_VALUES = 4  # of a variable, that are all shown
FLAGS = {YES: True, NO: False, UNKNOWN: None}


def scalars(data: Dataset) -> dict[str, Any]:
    """Return the single numbers of a dataset by name; flags are True, False, or None: unknown."""
    return {
        str(name): FLAGS[int(one)] if "flag_meanings" in one.attrs else one.values.item()
        for name, one in data.variables.items()
        if not one.dims
    }


def task_text(data: Dataset) -> str:
    """Return a table of the variables of a task."""
    about = data.attrs
    chosen = json.loads(about["settings_json"])["study"]
    head = [["task", f"{about['task']} of the study {about['study']}, scale {about['scale']}"]]
    head += [[key, str(one)] for key, one in chosen.items() if not isinstance(one, dict | list)]
    table = [["variable", "over", "value"]]
    for name, one in data.variables.items():
        over = ", ".join(f"{dim} ({data.sizes[dim]})" for dim in one.dims)
        table.append([str(name), over, _values(one.values)])
    file = f"results/{about['scale']}/studies/{about['study']}/{about['task']}.nc"
    return "\n\n".join([columns(head), columns(table), f"To make it again: snakemake -j1 {file}"])


def _values(values: np.ndarray) -> str:
    """Return few values as they are, many as their range."""
    if values.size <= MOST_VALUES or values.dtype.kind not in "fiu":
        few = values.ravel()[:MOST_VALUES]
        return ", ".join(str(one) if isinstance(one, str) else f"{one:.5g}" for one in few)
    there = values[np.isfinite(values)]
    if not there.size:
        return "nothing"
    return f"{there.min():.5g} to {there.max():.5g}, {there.mean():.5g} on average"


def task_record(data: Dataset) -> dict[str, Any]:
    """Return the sizes and single numbers of a task."""
    return {"sizes": dict(data.sizes), "variables": scalars(data)}


def studies_record(studies: Mapping[str, Dataset]) -> dict[str, Any]:
    """Return the same of each study, by name."""
    found = {name: {"attributes": one.attrs} | task_record(one) for name, one in studies.items()}
    return {"studies": found}


def studies_text(studies: Mapping[str, Dataset]) -> str:
    """Return the tables of all studies."""
    from roughgas.studies.tables import TABLES

    scales = {data.attrs["scale"] for data in studies.values()}
    parts = [TABLES[name](data).strip() for name, data in studies.items()]
    return "\n\n".join([f"scale {', '.join(sorted(scales))}", *parts])
