"""R of single states in the limit of many particles, and the effects of kicks and packing."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from roughgas.judging import point_text
from roughgas.tasks import (
    Estimate,
    dataset,
    markdown,
    mean_estimate,
    read_variables,
    slices_along,
    stack_rows,
    table_cell,
)

from .tasks import EVENTS, HOMOGENEOUS, KICKS, State, runs_of_tasks

VARIABLES = Path(__file__).with_name("variables.yaml")
GAS_PARAMETERS = ("particles", "packing", "interval")
KICK_ORDER = 2  # order of the effect of the interval of kicks


def combine(task_results: Mapping[str, xr.Dataset], settings: Mapping[str, Any]) -> xr.Dataset:
    """Return R of each state, R over the interval of kicks, and R of event-driven gases."""
    by_kind = {
        kind: {
            name: task_results[name]
            for name in runs_of_tasks(settings)
            if name.startswith(f"{kind}-")
        }
        for kind in (HOMOGENEOUS, KICKS, EVENTS)
    }
    numbers = np.array(settings[HOMOGENEOUS]["particles"], float)
    rows = []
    for state, data in zip(settings["states"], by_kind[HOMOGENEOUS].values(), strict=True):
        limit, slope = extrapolated(numbers, data.R.values)
        rows.append(
            State(*state)._asdict()
            | {"R": limit, "R_dof": limit.dof, "size_effect": slope}
            | {"seconds": float(data.seconds)}
        )
    (kicks,), (events,) = by_kind[KICKS].values(), by_kind[EVENTS].values()
    gases = [
        dict(zip(GAS_PARAMETERS, gas, strict=True)) | {"event_R": mean_estimate(values)}
        for gas, values in zip(settings[EVENTS]["gases"], events.R.values, strict=True)
    ]
    limit, slope = events_extrapolated(settings[EVENTS]["gases"], events.R.values)
    intervals = settings[KICKS]["intervals"]
    kicked = [{"kicked_R": mean_estimate(values)} for values in kicks.R.values]
    effect = kick_effect(intervals, kicks.R.values, settings[HOMOGENEOUS]["interval"])
    scalars = {
        "kick_interval": intervals,
        "kick_effect": effect,
        "kick_dof": effect.dof,
        "kick_seconds": float(kicks.seconds),
        "event_dof": events.sizes["run"] - 1.0,
        "event_limit": limit,
        "event_size_effect": slope,
        "event_limit_dof": limit.dof,
        "event_seconds": float(events.seconds),
    }
    probe = {
        f"probe_{name}": float(value)
        for name, value in zip(State._fields, settings["probe"], strict=True)
    }
    values = stack_rows(rows) | stack_rows(gases) | stack_rows(kicked) | scalars
    return dataset(read_variables(VARIABLES), values, seed=settings["seed"], **probe)


def extrapolated(particles: np.ndarray, R: np.ndarray) -> tuple[Estimate, Estimate]:
    """Return R of infinitely many particles, and the slope of R over 1/N, by least squares.

    `R` has the shape (sizes, runs). All runs have the same length in collisions of all particles,
    and thus the same error, which is taken from their scatter about the line.
    """
    runs = R.shape[1]
    columns = np.repeat(np.stack([np.ones_like(particles), 1.0 / particles], axis=1), runs, axis=0)
    coefficients, *_ = np.linalg.lstsq(columns, R.ravel(), rcond=None)
    dof = float(R.size - 2)
    variance = float(np.sum((R.ravel() - columns @ coefficients) ** 2)) / dof
    errors = np.sqrt(variance * np.diag(np.linalg.inv(columns.T @ columns)))
    limit, slope = (
        Estimate(float(value), float(error), dof)
        for value, error in zip(coefficients, errors, strict=True)
    )
    return limit, slope


def events_extrapolated(gases, R: np.ndarray) -> tuple[Estimate, Estimate]:
    """Return R of infinitely many event-driven disks without density, and the slope over 1/N.

    `gases` are rows of GAS_PARAMETERS, R has the shape (gases, runs). Only gases count that have as
    frequent kicks as the first one, in a box of as many mean free paths: the product of number and
    packing is the same, so that 1/N and the packing vanish together.
    """
    particles, packing, interval = np.array(gases, float).T
    lengths = particles * packing
    alike = np.isclose(lengths, lengths[0]) & (interval == interval[0])
    return extrapolated(particles[alike], R[alike])


def kick_effect(intervals, R: np.ndarray, interval: float) -> Estimate:
    """Return the change of R at `interval` from continuous noise, an effect of second order.

    `R` has the shape (2, runs), at a short and a long interval.
    """
    short, long = map(mean_estimate, R)
    squares = [length**KICK_ORDER for length in (*intervals, interval)]
    return long.minus(short).scaled(squares[2] / (squares[1] - squares[0]))


def table(data: xr.Dataset) -> str:
    """Return R of homogeneous and of event-driven gases, Markdown."""
    states = [
        [*(f"{state[name].item():g}" for name in State._fields)]
        + [table_cell(state, name) for name in ("R", "size_effect")]
        for state in slices_along(data, "state")
    ]
    gases = [
        [*(f"{gas[name].item():g}" for name in GAS_PARAMETERS), table_cell(gas, "event_R")]
        for gas in slices_along(data, "gas")
    ]
    sizes = markdown([*State._fields, "R", "N (R_N - R)"], states)
    events = markdown([*GAS_PARAMETERS, "R"], gases)
    probe = point_text({name: data.attrs[f"probe_{name}"] for name in State._fields})
    effect = f"Kicks change R of the homogeneous gases by {table_cell(data, 'kick_effect')}."
    limit = (
        f"Extrapolated in 1/N at an equal length of the box in mean free paths: "
        f"{table_cell(data, 'event_limit')}, N (R_N - R) = {table_cell(data, 'event_size_effect')}."
    )
    return (
        f"## R of homogeneous gases\n\n{sizes}\n\n{effect}\n\n"
        f"## R of event-driven gases, {probe}\n\n{events}\n\n{limit}\n"
    )
