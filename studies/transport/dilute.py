"""Coefficients of gases without positions, from the tasks and from the table of long runs."""

from collections.abc import Iterator
from pathlib import Path

import xarray as xr

from roughgas import theory
from roughgas.judging import Estimate, LongRow, read_long_rows
from roughgas.tasks import markdown, with_minus_signs

from .coefficients import in_equilibrium, point
from .results import COEFFICIENTS, long_table
from .tasks import DIMENSIONS

TABLE = Path(__file__).with_name("long.csv")
SOURCES = {
    "spheres": "Pekeris & Alterman 1957, Proc. Natl. Acad. Sci. 43, 998",
    "disks": "Gass 1971, J. Chem. Phys. 54, 1898",
}
"""Sources of PUBLISHED."""
PUBLISHED = {
    ("viscosity", "spheres"): 1.0160,
    ("conductivity", "spheres"): 1.0252,
    ("viscosity", "disks"): 1.022,
    ("conductivity", "disks"): 1.029,
}
"""Coefficients of dilute smooth elastic gases over their first Sonine approximation."""


def rows_of(data: xr.Dataset) -> list[LongRow]:
    """Return the rows of long.csv at the scale `paper`; at other scales, or without it, of `data`.

    `data` is the dataset of the tasks.
    """
    rows = read_long_rows(TABLE) if data.attrs.get("scale") == "paper" else []
    return rows or list(long_table(data))


def limits(rows: list[LongRow], quantity: str, kind: str, method: str) -> dict[float, Estimate]:
    """Return a coefficient over its first approximation by q, extrapolated to its limit.

    `kind` is disks or spheres, `method` equilibrium (N -> infinity) or forced (no force). q = 0
    stands for smooth particles.
    """
    small = {"equilibrium": "particles", "forced": "force"}[method]
    return {
        (at["inertia"] if at["beta"] == 1.0 else 0.0): row.estimate
        for row, at in ((row, row.parameters) for row in rows)
        if (row.quantity, at["kind"], at["method"]) == (quantity, kind, method) and at[small] == 0
    }


def driven(rows: list[LongRow]) -> dict[tuple[float, float], Estimate]:
    """Return the coefficient of self-diffusion of driven disks over theory by (r, beta)."""
    return {
        (row.parameters["r"], row.parameters["beta"]): row.estimate
        for row in rows
        if row.quantity == "diffusion"
    }


def event_rows(*gases: xr.Dataset) -> Iterator[LongRow]:
    """Yield viscosity and conductivity of event-driven elastic gases over Enskog's theory."""
    for gas in map(point, gases):
        attributes = gas.attrs
        at = {
            "method": "events",
            "kind": "spheres" if attributes["dimension"] == 3 else "disks",
            **{"r": float(gas.r), "beta": float(gas.beta), "inertia": attributes["inertia"]},
            **{"particles": int(attributes["particles"]), "force": 0.0},
            "packing": round(attributes["packing"], 4),
        }
        hours = float(gas.kernel_seconds.sum()) / 3600.0
        for name in COEFFICIENTS:
            yield LongRow(name, at, in_equilibrium(gas, name)[-1], hours)


def events_by_state(rows: list[LongRow], quantity: str) -> dict[str, Estimate]:
    """Return a coefficient of event-driven rough spheres over theory, by N and packing in words."""
    return {
        f"N = {row.parameters['particles']:g}, packing {row.parameters['packing']:g}": row.estimate
        for row in rows
        if (row.quantity, row.parameters["method"]) == (quantity, "events")
    }


def corrected(quantity: str, kind: str, q: float) -> float:
    """Return the factor of theory by which spins change a coefficient of rough gases beyond
    Pidduck's terms."""
    return float(theory.spin_corrections(q, DIMENSIONS[kind])[COEFFICIENTS.index(quantity)])


def pairs_of_methods(
    rows: list[LongRow], quantity: str
) -> Iterator[tuple[str, Estimate, Estimate]]:
    """Yield (name of gas, coefficient by Green-Kubo formulae, and under small forces)."""
    for kind in ("disks", "spheres"):
        forced = limits(rows, quantity, kind, "forced")
        for q, estimate in limits(rows, quantity, kind, "equilibrium").items():
            if q in forced:
                yield name_of(kind, q), estimate, forced[q]


def name_of(kind: str, q: float) -> str:
    """Return the name of a gas, such as "rough spheres, q = 0.4"; q = 0 stands for smooth ones."""
    return f"rough {kind}, q = {q:g}" if q else f"smooth {kind}"


def table_of_limits(rows: list[LongRow]) -> str:
    """Return viscosity and conductivity of elastic gases over first approximations, Markdown."""
    head = ["elastic", *(f"{name}, {how}" for name in COEFFICIENTS for how in HOW.values())]
    lines = []
    for kind in ("spheres", "disks"):
        columns = [limits(rows, name, kind, how) for name in COEFFICIENTS for how in HOW]
        for q in sorted(columns[0]):
            cells = [f"{column[q]}" if q in column else "" for column in columns]
            lines.append([name_of(kind, q), *cells])
    return markdown(head, lines)


HOW = {"equilibrium": "Green-Kubo", "forced": "small forces"}
"""Methods in words."""


def table_of_diffusion(rows: list[LongRow]) -> str:
    """Return the coefficient of self-diffusion over theory of all driven disks, Markdown."""
    coefficients = driven(rows)
    r, beta = (sorted({point[k] for point in coefficients}) for k in range(2))
    head = ["driven disks", *(with_minus_signs(f"β = {x:g}") for x in beta)]
    lines = [[f"r = {y:g}", *(f"{coefficients[y, x]}" for x in beta)] for y in reversed(r)]
    return markdown(head, lines)
