"""The published stationary states: theta = T_rot/T_tr of dilute rough disks driven by white noise.

Megias & Santos, Front. Phys. 10, 971671 (2022); their data are public under the MIT licence: the
repository amegiasf/MpembaSplitting, folder "Steady states", commit f2d033c. Rounded here to seven
digits, their errors to three.
"""

from pathlib import Path

import numpy as np
import xarray as xr

REFERENCE = Path(__file__).with_name("reference.csv")


def published(method: str, at: xr.DataArray) -> tuple[xr.DataArray, xr.DataArray]:
    """Return R and its standard error by `method`, DSMC or EDMD, where `at` is; else NaN."""
    values, errors = at * np.nan, at * np.nan
    rows = np.genfromtxt(REFERENCE, delimiter=",", names=True, dtype=None, encoding="utf-8")
    for row in rows[rows["method"] == method]:
        place = {name: float(row[name]) for name in ("r", "beta", "spin_share")}
        if all(np.isclose(at[name], value).any() for name, value in place.items()):
            theta = float(row["theta"])
            values.loc[place] = theta / (1 + theta)
            errors.loc[place] = float(row["theta_stderr"]) / (1 + theta) ** 2
    return values, errors


def beside_published(gas: xr.Dataset) -> tuple[xr.DataArray, xr.DataArray]:
    """Return R_corrected minus R published by DSMC, and the combined standard error.

    The error of R_corrected is taken as that of R, which pools the errors of seeds.
    """
    values, errors = published("DSMC", gas.R)
    return gas.R_corrected - values, np.sqrt(gas.R_stderr**2 + errors**2)
