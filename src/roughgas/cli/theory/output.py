"""Theory's numbers as tables, as JSON and as CSV."""

import csv
import sys
from collections.abc import Mapping, Sequence

import numpy as np

from roughgas.cli.layout import as_json, columns
from roughgas.cli.theory.quantities import PAPER, Gas, Quantity

Tables = Sequence[tuple[Gas, Mapping[str, Quantity]]]
"""All quantities of each gas; the gases have the same points."""


def _titles(gas: Gas) -> str:
    return f"{gas.dimension}D, q = {gas.inertia:g}"


def point(tables: Tables) -> str:
    """A row for each quantity, a column for each dimension."""
    gas, first = tables[0]
    friction = "" if gas.mu is None else f", mu = {gas.mu:g}"
    rows = [[f"r = {gas.r[0]:g}, beta = {gas.beta[0]:g}{friction}"]]
    rows[0] += [*(_titles(one) for one, _ in tables), ""]
    for name, quantity in first.items():
        sources = dict.fromkeys(found[name].source for _, found in tables)
        numbers = [_shown(found[name].values.flat[0]) for _, found in tables]
        rows.append([quantity.meaning, *numbers, "; ".join(sources)])
    return f"{columns(rows)}\n\n{_notes()}"


def curve(tables: Tables) -> str:
    """A row for each point; below, what the columns are."""
    names = list(tables[0][1])
    rows = [["D", "r", "beta", *names]]
    rows += [[_shown(value) for value in row.values()] for row in _rows(tables)]
    about = []
    for name, quantity in tables[0][1].items():
        sources = dict.fromkeys(found[name].source for _, found in tables)
        about.append([name, quantity.meaning, "; ".join(sources)])
    inertia = " and ".join(_titles(gas) for gas, _ in tables)
    return f"{columns(rows, numbers=True)}\n\n{columns(about)}\n\n{inertia}.\n{_notes()}"


def _notes() -> str:
    return f"Rates are per collision per particle. Equations: docs/physics.md, and\n{PAPER}."


def _rows(tables: Tables) -> list[dict[str, float]]:
    found = []
    for gas, table in tables:
        for k in range(len(gas.r)):
            place = {"dimension": gas.dimension, "r": gas.r[k], "beta": gas.beta[k]}
            values = {n: np.broadcast_to(q.values, gas.r.shape)[k] for n, q in table.items()}
            found.append(place | values)
    return found


def as_record(tables: Tables) -> str:
    """JSON: a record for each point, and what its numbers are."""
    gas, first = tables[0]
    record = {
        "inertia": {f"{one.dimension}": one.inertia for one, _ in tables},
        "spin_share": gas.spin_share,
        "mu": gas.mu,
        "reference": PAPER,
        "quantities": {
            name: {
                "meaning": quantity.meaning,
                "source": {f"{one.dimension}": table[name].source for one, table in tables},
            }
            for name, quantity in first.items()
        },
        "points": _rows(tables),
    }
    return as_json(record)


def write_csv(tables: Tables) -> None:
    """A row for each point; the last column says which equations R is from."""
    table = csv.writer(sys.stdout, lineterminator="\n")
    table.writerow(["dimension", "r", "beta", *tables[0][1], "sources"])
    sources = {
        gas.dimension: "; ".join(f"{name}: {one.source}" for name, one in found.items())
        for gas, found in tables
    }
    for row in _rows(tables):
        numbers = [format(value, ".10g") for value in row.values()]
        table.writerow([*numbers, sources[row["dimension"]]])


def _shown(value: float) -> str:
    return f"{value:.5g}"
