"""Results of the scale `long`: R of homogeneous gases to 0.0001, and what changes R."""

from collections.abc import Iterator
from pathlib import Path

import xarray as xr

from roughgas.judging import LongRow, read_long_rows
from roughgas.tasks import Estimate, estimate_of, slices_along

from .results import GAS_PARAMETERS
from .tasks import State

TABLE = Path(__file__).with_name("long.csv")
HOMOGENEOUS_R, SIZE_EFFECT = "R of homogeneous disks", "N (R_N - R) of homogeneous disks"
KICK_EFFECT, EVENT_R = "effect of finite kicks on R", "R of event-driven disks"
EVENT_LIMIT = "R of event-driven disks, extrapolated in N"
EVENT_SIZE_EFFECT = "N (R_N - R) of event-driven disks"
"""Quantities in the table."""
SECONDS_PER_HOUR = 3600.0


def long_table(data: xr.Dataset) -> Iterator[LongRow]:
    """Yield R of each state, the effect of the number of particles and of kicks, and R by events.

    The CPU time of a task is shared equally among its rows; what follows from other rows has none.
    """
    for row in slices_along(data, "state"):
        parameters = {name: row[name].item() for name in State._fields}
        hours = float(row.seconds) / SECONDS_PER_HOUR / 2.0
        for quantity, name in (HOMOGENEOUS_R, "R"), (SIZE_EFFECT, "size_effect"):
            yield LongRow(quantity, parameters, _estimate(row, name, row.R_dof), hours)
    probe = {name: float(data.attrs[f"probe_{name}"]) for name in State._fields}
    hours = float(data.kick_seconds) / SECONDS_PER_HOUR
    yield LongRow(KICK_EFFECT, probe, _estimate(data, "kick_effect", data.kick_dof), hours)
    hours = float(data.event_seconds) / SECONDS_PER_HOUR / data.sizes["gas"]
    for row in slices_along(data, "gas"):
        parameters = probe | {name: row[name].item() for name in GAS_PARAMETERS}
        yield LongRow(EVENT_R, parameters, _estimate(row, "event_R", data.event_dof), hours)
    for quantity, name in (EVENT_LIMIT, "event_limit"), (EVENT_SIZE_EFFECT, "event_size_effect"):
        yield LongRow(quantity, probe, _estimate(data, name, data.event_limit_dof), 0.0)


def _estimate(data, name, dof):
    """Return the Estimate of a variable with the degrees of freedom of its error."""
    return estimate_of(data, name)._replace(dof=float(dof))


def committed(quantity: str) -> dict[State, Estimate]:
    """Return a quantity of homogeneous gases by state, from the committed table."""
    return {
        State(*(float(row.parameters[name]) for name in State._fields)): row.estimate
        for row in read_long_rows(TABLE)
        if row.quantity == quantity
    }
