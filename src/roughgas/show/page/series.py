"""The time series of a point, thinned to what a screen can show, and numbers as JSON has them."""

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from roughgas.data.variables import CLOCKS

if TYPE_CHECKING:
    import xarray

LONGEST = 200
"""The most values that are shown of a time series."""
SHOWN = ("R", "E_trans", "E_rot")
DIGITS = 5


def time_series(seed: "xarray.Dataset") -> dict[str, Any]:
    """Return R and both energies of a seed over time, as means over blocks.

    `clock` is "time", in T, or "collisions_per_particle"; `block` is the number of samples in a
    mean; `measured` is the window in which R is measured, its ends None where they are unknown.
    """
    clock = next(name for name in CLOCKS[::-1] if name in seed)
    columns = {"at": seed[clock].values} | {name: seed[f"{name}_series"].values for name in SHOWN}
    window = [exact(seed.get(name, math.nan)) for name in ("measured_from", "plateau_end")]
    block = math.ceil(columns["at"].size / LONGEST)
    thinned = {name: rounded(block_means(values, block)) for name, values in columns.items()}
    return {"clock": clock, "block": block, "measured": window} | thinned


def block_means(values: np.ndarray, block: int) -> np.ndarray:
    """Return the means over blocks of `block` values; the last block may be shorter."""
    begins = np.arange(0, values.size, block)
    return np.add.reduceat(values, begins) / np.diff(np.append(begins, values.size))


def exact(value: Any) -> float | int | None:
    """Return a number as it is, to the last bit; None if it is not finite."""
    number = np.asarray(value).item()
    return number if math.isfinite(number) else None


def rounded(values: Any) -> list[float | None]:
    """Return numbers to DIGITS digits, for what is only looked at; None if one is not finite."""
    return [float(f"{x:.{DIGITS}g}") if math.isfinite(x) else None for x in np.asarray(values)]
