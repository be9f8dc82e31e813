"""How much of R of a cooling gas is due to its number of particles, and how much to its box.

The homogeneous gas, by direct simulation Monte Carlo, has a number of particles but no box.
Event-driven gases have a box, too: where it is many mean free paths wide, shear waves grow, which
hold energy of translation, and then clusters, so that R keeps falling. A dilute gas of as many
particles has a box of few mean free paths, and neither.
"""

from collections.abc import Mapping
from typing import Any

import numpy as np
import xarray as xr

from roughgas import theory
from roughgas.statistics.errors import Estimate
from roughgas.studies.tasks import VARIABLES, point_names
from roughgas.tasks import dataset, estimate, flat, mean, over, stacked, variables


def combine(parts: Mapping[str, xr.Dataset], settings: Mapping[str, Any]) -> xr.Dataset:
    """Return R by both methods over point, number of particles and packing, from all tasks."""
    names, numbers, packings = point_names(settings), settings["particles"], settings["packings"]
    found = stacked(
        [
            stacked([_gas(parts[f"{name}-n{number}"], number, packings) for number in numbers])
            for name in names
        ]
    )
    found["theory"] = found["theory"][:, 0]
    experiments, r, beta = zip(*names.values(), strict=True)
    ends = np.arange(1, found["R_series"].shape[-1] + 1) / found["R_series"].shape[-1]
    found |= {"experiment": list(experiments), "r": list(r), "beta": list(beta)}
    found |= {"point": list(names), "particles": numbers, "part": ends}
    found |= {"packing": np.array(packings, float)}
    about = {"seed": settings["seed"], "precision": settings["precision"]}
    known = variables(VARIABLES, "finite_size")
    return dataset(known, found, **about).set_coords(["experiment", "r", "beta"])


def _gas(part: xr.Dataset, number: int, packings) -> dict[str, Any]:
    """Return all variables of one point and number of particles, packings along the first axis."""
    dsmc, noise = estimate(part, "dsmc_R"), 2.0 * (part.attrs["dimension"] - 1) / number
    boxes = [_box(part.isel(packing=k), number, x, noise) for k, x in enumerate(packings)]
    for box in boxes:
        quotient = over(box["R"], dsmc)
        box["over_dsmc"] = quotient._replace(value=quotient.value - 1.0)
    return flat(
        {
            "dsmc_R": dsmc,
            "dsmc_a02": estimate(part, "dsmc_a02"),
            "dsmc_seconds": float(part.dsmc_seconds),
            "theory": float(part.theory),
            "flow_of_noise": noise,
            **stacked(boxes),
        }
    )


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
