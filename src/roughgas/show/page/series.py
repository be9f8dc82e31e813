"""The time series of a point, thinned to what a screen can show."""

import math
from pathlib import Path
from typing import Any

import numpy as np

from roughgas.data.variables import CLOCKS
from roughgas.show.page.numbers import exact, rounded

LONGEST = 200
"""So many values of a time series are shown at most."""
SHOWN = ("R", "E_trans", "E_rot")


def time_series(path: Path) -> dict[str, Any]:
    """R and both energies over time from the dataset of a seed: means over blocks of equal length.

    `clock` is "time", in T, or "collisions_per_particle"; `block` counts the samples in a mean;
    `measured` has the begin and the end of the window that R is measured in, None where unknown.
    """
    import netCDF4

    with netCDF4.Dataset(path) as file:
        file.set_auto_mask(False)
        clock = next(name for name in CLOCKS[::-1] if name in file.variables)
        columns = {"at": file[clock][...]}
        columns |= {name: file[f"{name}_series"][...] for name in SHOWN}
        window = [
            exact(file[name][...]) if name in file.variables else None
            for name in ("measured_from", "plateau_end")
        ]
    block = math.ceil(columns["at"].size / LONGEST)
    thinned = {name: rounded(block_means(values, block)) for name, values in columns.items()}
    return {"clock": clock, "block": block, "measured": window} | thinned


def block_means(values: np.ndarray, block: int) -> np.ndarray:
    """Means over blocks of so many values; the last block may be shorter."""
    begins = np.arange(0, values.size, block)
    return np.add.reduceat(values, begins) / np.diff(np.append(begins, values.size))
