"""Coefficients of gases without positions over first Sonine approximations, as rows.

A row is a coefficient of one gas: by Green-Kubo formulae at a number of particles and extrapolated
to infinitely many; under a small force and extrapolated to none; or the self-diffusion of driven
disks.
"""

from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from roughgas.judging import Estimate, LongRow, limit_at_zero
from roughgas.tasks import dataset, markdown, read_variables
from roughgas.tasks.transport import coefficients_in_equilibrium

from .tasks import Gas, gases_of, steps_of

VARIABLES = Path(__file__).with_name("variables.yaml")
COEFFICIENTS = ("viscosity", "conductivity")
LIMITS = {"equilibrium": "1/N", "forced": "force^2"}
"""Small parameter in which a coefficient is extrapolated to 0, by method."""
PARAMETERS = ("r", "beta", "inertia", "particles", "force")


def combine(task_results: Mapping[str, xr.Dataset], settings: Mapping[str, Any]) -> xr.Dataset:
    """Return all coefficients as rows, with their limits for N -> infinity or no force."""
    rows: list[tuple[Gas, str, Estimate, float]] = []
    for name, gas in gases_of(settings).items():
        result = task_results[name]
        estimates = _estimates(gas, result.drop_vars("seconds"), settings)
        rows += [(gas, key, estimates[key], float(result.seconds)) for key in estimates]
    rows += [limit for method in LIMITS for limit in _limits(rows, method)]
    rows.sort(key=lambda row: (row[1], row[0]))
    columns: dict[str, Any] = {
        name: [getattr(row[0], name) for row in rows] for name in ("method", "kind", *PARAMETERS)
    }
    columns["quantity"] = [row[1] for row in rows]
    value, stderr, dof = np.array([row[2] for row in rows]).T
    columns |= {"value": value, "value_stderr": stderr, "value_dof": dof}
    columns["seconds"] = [row[3] for row in rows]
    return dataset(read_variables(VARIABLES), columns, seed=settings["seed"])


def _estimates(gas, result, settings) -> dict[str, Estimate]:
    """Return coefficients of a gas over first approximations by name, of its task's `result`."""
    values = {str(name): result[name].values for name in result}
    if gas.method != "equilibrium":
        return {name: Estimate(*map(float, value)) for name, value in values.items()}
    _, interval = steps_of(gas, settings[gas.method])
    return coefficients_in_equilibrium(gas.properties, values, interval)


def _limits(rows, method) -> Iterator[tuple[Gas, str, Estimate, float]]:
    """Yield the limits of the coefficients by a method; `particles` or `force` of a limit is 0."""
    families: dict[tuple[Gas, str], list[tuple[float, Estimate, float]]] = {}
    for gas, coefficient, estimate, seconds in rows:
        if gas.method == method:
            small = 1.0 / gas.particles if method == "equilibrium" else gas.force**2
            limit = gas._replace(**{"particles" if method == "equilibrium" else "force": 0})
            families.setdefault((limit, coefficient), []).append((small, estimate, seconds))
    for (gas, coefficient), points in families.items():
        if len(points) > 1:
            yield gas, coefficient, extrapolated(points), sum(point[2] for point in points)


def extrapolated(points) -> Estimate:
    """Return the value at 0 of a straight line through (x, Estimate, ...) points, by least squares.

    Points are weighted by their errors; the error of the limit follows from theirs. Through more
    than three points it is a parabola.
    """
    x = np.array([point[0] for point in points])
    value, stderr, dof = np.array([point[1] for point in points]).T
    return Estimate(*map(float, limit_at_zero(x, value, stderr)), float(dof.min()))


def long_table(data: xr.Dataset) -> Iterator[LongRow]:
    """Yield the rows of the data of tasks, for long.csv."""
    for row in (data.isel(row=k) for k in range(data.sizes["row"])):
        names = ("method", "kind", *PARAMETERS)
        parameters = {name: row[name].item() for name in names}
        estimate = Estimate(float(row.value), float(row.value_stderr), float(row.value_dof))
        yield LongRow(str(row.quantity.item()), parameters, estimate, float(row.seconds) / 3600.0)


def table(data: xr.Dataset) -> str:
    """Return all coefficients over their first Sonine approximation, Markdown."""
    head = ["coefficient", "particles", "r", "β", "q", "method", "N", "force", "over theory"]
    rows = [
        [
            row.quantity,
            *(f"{row.parameters[name]}" for name in ("kind", "r", "beta")),
            f"{row.parameters['inertia']:.4g}",
            row.parameters["method"],
            f"{row.parameters['particles'] or '∞'}",
            f"{row.parameters['force']:g}",
            f"{row.estimate:±}",
        ]
        for row in long_table(data)
    ]
    return (
        "## Coefficients of gases without positions over first Sonine approximations\n\n"
        f"{markdown(head, rows)}"
    )
