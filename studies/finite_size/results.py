"""R of a cooling gas against its number of particles and the size of its box.

The homogeneous gas, by direct simulation Monte Carlo, has a number of particles but no box.
Event-driven gases also have a box: if it is many mean free paths wide, shear waves grow and take up
translational energy, and later clusters form, so that R keeps falling. A dilute gas of the same
number of particles has a box of few mean free paths, and stays homogeneous.
"""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from roughgas import theory
from roughgas.tasks import (
    Estimate,
    dataset,
    estimate_of,
    estimate_ratio,
    markdown,
    mean_estimate,
    point_title,
    read_variables,
    slices_along,
    stack_rows,
    table_cell,
)

from .tasks import point_names

VARIABLES = Path(__file__).with_name("variables.yaml")


def combine(task_results: Mapping[str, xr.Dataset], settings: Mapping[str, Any]) -> xr.Dataset:
    """Return R by both methods over point, number of particles and packing, from all tasks."""
    names, numbers, packings = point_names(settings), settings["particles"], settings["packings"]
    rows = [[_gas(task_results[f"{name}-n{n}"], n, packings) for n in numbers] for name in names]
    values = stack_rows([stack_rows(row) for row in rows])
    values["theory"] = values["theory"][:, 0]
    experiments, r, beta = zip(*names.values(), strict=True)
    ends = np.arange(1, values["R_series"].shape[-1] + 1) / values["R_series"].shape[-1]
    values |= {"experiment": list(experiments), "r": list(r), "beta": list(beta)}
    values |= {"point": list(names), "particles": numbers, "part": ends}
    values |= {"packing": np.array(packings, float)}
    attributes = {"seed": settings["seed"], "precision": settings["precision"]}
    return dataset(read_variables(VARIABLES), values, **attributes).set_coords(
        ["experiment", "r", "beta"]
    )


def _gas(task_result: xr.Dataset, number: int, packings) -> dict[str, Any]:
    """Return all variables of one point and number of particles, packings along the first axis."""
    dsmc, noise = (
        estimate_of(task_result, "dsmc_R"),
        2.0 * (task_result.attrs["dimension"] - 1) / number,
    )
    boxes = [_box(task_result.isel(packing=k), number, x, noise) for k, x in enumerate(packings)]
    for box in boxes:
        quotient = estimate_ratio(box["R"], dsmc)
        box["over_dsmc"] = quotient._replace(value=quotient.value - 1.0)
    return stack_rows(boxes) | {
        "dsmc_R": dsmc,
        "dsmc_a02": estimate_of(task_result, "dsmc_a02"),
        "dsmc_seconds": float(task_result.dsmc_seconds),
        "theory": float(task_result.theory),
        "flow_of_noise": noise,
    }


def _box(runs, number, packing, noise):
    """Return the averages over the runs at one packing, from the second half of each run."""
    dimension, late = runs.attrs["dimension"], runs.isel(part=slice(runs.sizes["part"] // 2, None))
    still = without_flow(late.R_now.values, late.flow.values, noise)
    still += late.R.values - late.R_now.values
    series = [mean_estimate(values) for values in runs.R.values.T]
    side = (number / float(theory.number_density(packing, dimension))) ** (1.0 / dimension)
    return {
        "R": mean_estimate(late.R.values.mean(axis=1)),
        "R_without_flow": mean_estimate(still.mean(axis=1)),
        "a02": mean_estimate(late.a02.values.mean(axis=1)),
        "flow": mean_estimate(late.flow.values.mean(axis=1)),
        "box": side / float(theory.mean_free_path(packing, dimension)),
        "replicas": runs.sizes["run"],
        "length": float(runs.length),
        "seconds": float(runs.seconds),
        "R_series": Estimate(*np.array([estimate[:2] for estimate in series]).T),
    }


def without_flow(R: np.ndarray, flow: np.ndarray, noise: float) -> np.ndarray:
    """Return R without the excess energy of shear waves. The waves hold the share `flow` of
    E_trans; the excess is over `noise`, their share in equilibrium by their number of degrees of
    freedom."""
    theta = R / (1.0 - R)
    return theta / (theta + 1.0 - flow + noise)


def table(data: xr.Dataset) -> str:
    """Return R of a cooling gas by number of particles, and the change by the box at each packing,
    Markdown."""
    numbers = [f"N = {n}" for n in data.particles.values]
    rows, tails = [], []
    for point in slices_along(data, "point"):
        gases = slices_along(point, "particles")
        gap = estimate_of(gases[-1], "dsmc_R").scaled(100 / float(point.theory))
        missing = f"{gap._replace(value=gap.value - 100):+±} %"
        cells = [table_cell(gas, "dsmc_R", ".4f") for gas in gases]
        rows.append([point_title(point), f"{float(point.theory):.4f}", *cells, missing])
        tails.append([point_title(point), *(table_cell(gas, "dsmc_a02", "±") for gas in gases)])
    head = ["point", "theory of free cooling", *numbers, "the last over the theory of free cooling"]
    return (
        f"## Number and box of a cooling gas\n\nR of the homogeneous gas (DSMC):\n\n"
        f"{markdown(head, rows)}\nThe fourth cumulant a02 of its spins:\n\n"
        f"{markdown(['point', *numbers], tails)}"
        + "".join(_box_tables(at_packing, numbers) for at_packing in slices_along(data, "packing"))
    )


def _box_tables(data, numbers):
    """Return R by events at one packing over R by DSMC, and the energy in shear waves, Markdown."""
    rows = [
        [
            point_title(point),
            *(table_cell(gas, "over_dsmc", "+±", 100) for gas in slices_along(point, "particles")),
        ]
        for point in slices_along(data, "point")
    ]
    waves = [
        [
            point_title(point),
            *(table_cell(gas, "flow", "±", 100) for gas in slices_along(point, "particles")),
        ]
        for point in slices_along(data, "point")
    ]
    return (
        f"\nR by events at packing {float(data.packing):g} over that by DSMC, minus 1, in %:\n\n"
        f"{markdown(['point', *numbers], rows)}\nThere, the share of E_trans in the longest shear"
        f" waves, in % (uncorrelated: 2/N, spheres 4/N):\n\n{markdown(['point', *numbers], waves)}"
    )
