"""Theory's numbers as tables, as JSON and as CSV."""

import csv
import sys
from collections.abc import Mapping, Sequence

import numpy as np

from roughgas.base.layout import as_json, columns
from roughgas.cli.theory.quantities import Gas, Quantity

Tables = Sequence[tuple[Gas, Mapping[str, Quantity]]]
"""All quantities of each gas; the gases have the same points."""
PAPER = "S. McNamara, S. Luding, Phys. Rev. E 58, 2247 (1998)"
NOTES = f"Rates are per collision per particle. Equations: docs/physics.md, and\n{PAPER}."


def point(tables: Tables) -> str:
    """Return a row for each quantity, a column for each dimension."""
    gas, first = tables[0]
    friction = "" if gas.mu is None else f", mu = {gas.mu:g}"
    rows = [[f"r = {gas.r[0]:g}, beta = {gas.beta[0]:g}{friction}", *_titles(tables), ""]]
    for name, quantity in first.items():
        numbers = [f"{found[name].values.flat[0]:.5g}" for _, found in tables]
        rows.append([quantity.meaning, *numbers, _sources(tables, name)])
    return f"{columns(rows)}\n\n{NOTES}"


def curve(tables: Tables) -> str:
    """Return a row for each point; below, what the columns are."""
    first = tables[0][1]
    rows = [["D", "r", "beta", *first]]
    rows += [[f"{value:.5g}" for value in row.values()] for row in _rows(tables)]
    about = [[name, one.meaning, _sources(tables, name)] for name, one in first.items()]
    inertia = " and ".join(_titles(tables))
    return f"{columns(rows, numbers=True)}\n\n{columns(about)}\n\n{inertia}.\n{NOTES}"


def as_record(tables: Tables) -> str:
    """Return JSON: a record for each point, and what its numbers are."""
    gas, first = tables[0]
    sources = {
        name: {f"{one.dimension}": found[name].source for one, found in tables} for name in first
    }
    record = {
        "inertia": {f"{one.dimension}": one.inertia for one, _ in tables},
        "spin_share": gas.spin_share,
        "mu": gas.mu,
        "reference": PAPER,
        "quantities": {
            name: {"meaning": one.meaning, "source": sources[name]} for name, one in first.items()
        },
        "points": _rows(tables),
    }
    return as_json(record)


def write_csv(tables: Tables) -> None:
    """Print a row for each point; the last column says which equations its numbers are from."""
    table = csv.writer(sys.stdout, lineterminator="\n")
    table.writerow(["dimension", "r", "beta", *tables[0][1], "sources"])
    for gas, found in tables:
        sources = "; ".join(f"{name}: {one.source}" for name, one in found.items())
        for row in _rows([(gas, found)]):
            table.writerow([*(format(value, ".10g") for value in row.values()), sources])


def _titles(tables: Tables) -> list[str]:
    return [f"{gas.dimension}D, q = {gas.inertia:g}" for gas, _ in tables]


def _sources(tables: Tables, name: str) -> str:
    return "; ".join(dict.fromkeys(found[name].source for _, found in tables))


def _rows(tables: Tables) -> list[dict[str, float]]:
    rows = []
    for gas, found in tables:
        values = {name: np.broadcast_to(one.values, gas.r.shape) for name, one in found.items()}
        for k in range(len(gas.r)):
            place = {"dimension": gas.dimension, "r": gas.r[k], "beta": gas.beta[k]}
            rows.append(place | {name: one[k] for name, one in values.items()})
    return rows
