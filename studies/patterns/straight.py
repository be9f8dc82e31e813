"""Stripes that are straight to begin with, in a layer of the published size.

A layer of 100 D by 20 D has stripes across its length alone, and chooses their wavelength. Five of
these side by side, each the mirror image of the next, are a layer of (100 D)^2. Does it stay so?

    python -m studies.patterns.straight g g120.nc     # 32 cycles of it, to go on from by --from
"""

import argparse
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from roughgas import simulate

from .published import DIAMETER

WIDTH, COPIES = 20.0, 5  # D, of the narrow layer
LENGTH = WIDTH * COPIES
SPHERES_PER_AREA = 6  # per D^2
AXES_OF_VECTORS = {"position": "axis", "velocity": "axis", "spin": "spin_axis"}


def mirrored(layer: xr.Dataset, copies: int, width: float) -> xr.Dataset:
    """Return the last state of a layer between solid walls, repeated `copies` times side by side,
    each the mirror image of the next, without the walls between them. The layer is `width` (a) wide
    along y.

    Variables are `position`, `velocity` and `spin` (particle, axis), and `time`.
    """
    state = {name: layer[f"last_{name}"].values[0] for name in AXES_OF_VECTORS}
    columns: dict[str, list[np.ndarray]] = {name: [] for name in AXES_OF_VECTORS}
    for number in range(copies):
        side = -1.0 if number % 2 else 1.0
        begin = number * width if side > 0.0 else (number + 1) * width
        columns["position"].append(state["position"] * [1.0, side, 1.0] + [0.0, begin, 0.0])
        columns["velocity"].append(state["velocity"] * [1.0, side, 1.0])
        columns["spin"].append(state["spin"] * [side, 1.0, side])  # an axial vector
    stacked = {
        n: (("particle", AXES_OF_VECTORS[n]), np.concatenate(arrays))
        for n, arrays in columns.items()
    }
    return xr.Dataset(stacked | {"time": float(layer.last_time[0])})


def main(case: str, output: str) -> None:
    """Simulate both layers of a case, and write the large one."""
    settings: dict[str, Any] = {"experiment": f"patterns.layers/case{case}", "r": 0.7, "beta": 0.35}
    narrow = simulate(
        **settings,
        particles=round(SPHERES_PER_AREA * LENGTH * WIDTH),
        box=(DIAMETER * LENGTH, DIAMETER * WIDTH, "open"),
        layer={"width": None},
        observe={"pattern": None},
    )
    large = simulate(
        **settings,
        particles=round(SPHERES_PER_AREA * LENGTH * WIDTH * COPIES),
        layer={"width": LENGTH, "cycles": {"equilibrate": 0}},
        observe={"pattern": {"cells": 100}},
        initial=mirrored(narrow, COPIES, DIAMETER * WIDTH),
    )
    draft = Path(f"{output}.tmp")  # so that `output` is complete or absent
    large.to_netcdf(draft)
    draft.replace(output)


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("case", choices=["b", "g"], help="of the published stripes")
    parser.add_argument("output", help="the dataset to write")
    main(**vars(parser.parse_args()))
