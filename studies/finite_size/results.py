"""How much of R of a cooling gas is due to its number of particles, and how much to its box.

The homogeneous gas, by direct simulation Monte Carlo, has a number of particles but no box.
Event-driven gases have a box, too: where it is many mean free paths wide, shear waves grow, which
hold energy of translation, and then clusters, so that R keeps falling. A dilute gas of as many
particles has a box of few mean free paths, and neither.
"""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from roughgas import theory
from roughgas.tasks import (
    Estimate,
    along,
    cell,
    dataset,
    estimate,
    label,
    markdown,
    mean,
    over,
    stacked,
    variables,
)

from .tasks import point_names

VARIABLES = Path(__file__).with_name("variables.yaml")


def combine(parts: Mapping[str, xr.Dataset], settings: Mapping[str, Any]) -> xr.Dataset:
    """Return R by both methods over point, number of particles and packing, from all tasks."""
    names, numbers, packings = point_names(settings), settings["particles"], settings["packings"]
    rows = [[_gas(parts[f"{name}-n{n}"], n, packings) for n in numbers] for name in names]
    found = stacked([stacked(row) for row in rows])
    found["theory"] = found["theory"][:, 0]
    experiments, r, beta = zip(*names.values(), strict=True)
    ends = np.arange(1, found["R_series"].shape[-1] + 1) / found["R_series"].shape[-1]
    found |= {"experiment": list(experiments), "r": list(r), "beta": list(beta)}
    found |= {"point": list(names), "particles": numbers, "part": ends}
    found |= {"packing": np.array(packings, float)}
    about = {"seed": settings["seed"], "precision": settings["precision"]}
    return dataset(variables(VARIABLES), found, **about).set_coords(["experiment", "r", "beta"])


def _gas(part: xr.Dataset, number: int, packings) -> dict[str, Any]:
    """Return all variables of one point and number of particles, packings along the first axis."""
    dsmc, noise = estimate(part, "dsmc_R"), 2.0 * (part.attrs["dimension"] - 1) / number
    boxes = [_box(part.isel(packing=k), number, x, noise) for k, x in enumerate(packings)]
    for box in boxes:
        quotient = over(box["R"], dsmc)
        box["over_dsmc"] = quotient._replace(value=quotient.value - 1.0)
    return stacked(boxes) | {
        "dsmc_R": dsmc,
        "dsmc_a02": estimate(part, "dsmc_a02"),
        "dsmc_seconds": float(part.dsmc_seconds),
        "theory": float(part.theory),
        "flow_of_noise": noise,
    }


def _box(part, number, packing, noise):
    """Return what the runs at one packing find, measured in the second half of each."""
    dimension, late = part.attrs["dimension"], part.isel(part=slice(part.sizes["part"] // 2, None))
    still = without_flow(late.R_now.values, late.flow.values, noise)
    still += late.R.values - late.R_now.values
    series = [mean(one) for one in part.R.values.T]
    side = (number / float(theory.number_density(packing, dimension))) ** (1.0 / dimension)
    return {
        "R": mean(late.R.values.mean(axis=1)),
        "R_without_flow": mean(still.mean(axis=1)),
        "a02": mean(late.a02.values.mean(axis=1)),
        "flow": mean(late.flow.values.mean(axis=1)),
        "box": side / float(theory.mean_free_path(packing, dimension)),
        "replicas": part.sizes["run"],
        "length": float(part.length),
        "seconds": float(part.seconds),
        "R_series": Estimate(*np.array([one[:2] for one in series]).T),
    }


def without_flow(R: np.ndarray, flow: np.ndarray, noise: float) -> np.ndarray:
    """Return R without the energy by which waves that hold the share `flow` of E_trans exceed the
    share `noise`, that of as many degrees of freedom in equilibrium."""
    theta = R / (1.0 - R)
    return theta / (theta + 1.0 - flow + noise)


def table(data: xr.Dataset) -> str:
    """Return R of a cooling gas by number of particles, and what a box adds at each packing."""
    numbers = [f"N = {n}" for n in data.particles.values]
    rows, tails = [], []
    for one in along(data, "point"):
        gases = along(one, "particles")
        gap = estimate(gases[-1], "dsmc_R").scaled(100 / float(one.theory))
        missing = f"{gap._replace(value=gap.value - 100):+±} %"
        cells = [cell(gas, "dsmc_R", ".4f") for gas in gases]
        rows.append([label(one), f"{float(one.theory):.4f}", *cells, missing])
        tails.append([label(one), *(cell(gas, "dsmc_a02", "±") for gas in gases)])
    head = ["point", "theory of free cooling", *numbers, "the last over the theory of free cooling"]
    return (
        f"## Number and box of a cooling gas\n\nR of the homogeneous gas (DSMC):\n\n"
        f"{markdown(head, rows)}\nThe fourth cumulant a02 of its spins:\n\n"
        f"{markdown(['point', *numbers], tails)}"
        + "".join(_in_boxes(place, numbers) for place in along(data, "packing"))
    )


def _in_boxes(data, numbers):
    """Return what events find at one packing, over DSMC of as many particles."""
    rows = [
        [label(one), *(cell(gas, "over_dsmc", "+±", 100) for gas in along(one, "particles"))]
        for one in along(data, "point")
    ]
    waves = [
        [label(one), *(cell(gas, "flow", "±", 100) for gas in along(one, "particles"))]
        for one in along(data, "point")
    ]
    return (
        f"\nR by events at packing {float(data.packing):g} over that by DSMC, minus 1, in %:\n\n"
        f"{markdown(['point', *numbers], rows)}\nThere, the share of E_trans in the longest shear"
        f" waves, in % (uncorrelated: 2/N, spheres 4/N):\n\n{markdown(['point', *numbers], waves)}"
    )
