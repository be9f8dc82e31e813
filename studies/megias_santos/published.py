"""The published stationary states of dilute rough disks driven by white noise: theta = T_rot/T_tr,
and the cumulants a20, a11, a02.

Megias & Santos, Front. Phys. 10, 971671 (2022); their data are public under the MIT licence: the
repository amegiasf/MpembaSplitting, commit f2d033c. theta is in the folder "Steady states". The
cumulants are means over the last 100 rows of columns 4, 6 and 5 in the folder "Transient", as is
theta by events; their errors are the largest of blocks of 1, 5 and 10 rows. What these columns are
is told nowhere: theory and our own data say which is which. Rounded here to five to seven digits.
"""

from pathlib import Path

import numpy as np
import xarray as xr

REFERENCE = Path(__file__).with_name("reference.csv")
CUMULANTS = "a20", "a11", "a02"


def published(method: str, at: xr.DataArray, name: str = "R") -> tuple[xr.DataArray, xr.DataArray]:
    """Return R, or a cumulant of this name, and its standard error by `method`, DSMC or EDMD, where
    `at` is; else NaN."""
    values, errors = at * np.nan, at * np.nan
    rows = np.genfromtxt(REFERENCE, delimiter=",", names=True, dtype=None, encoding="utf-8")
    for row in rows[rows["method"] == method]:
        place = {axis: float(row[axis]) for axis in ("r", "beta", "spin_share")}
        if all(np.isclose(at[axis], value).any() for axis, value in place.items()):
            theta = float(row["theta"])
            of_theta = theta / (1 + theta), float(row["theta_stderr"]) / (1 + theta) ** 2
            found = of_theta if name == "R" else (float(row[name]), float(row[f"{name}_stderr"]))
            values.loc[place], errors.loc[place] = found
    return values, errors


def beside_published(gas: xr.Dataset, name: str = "R") -> tuple[xr.DataArray, xr.DataArray]:
    """Return R_corrected, or a cumulant, minus what is published by DSMC, and the combined standard
    error.

    The error of R_corrected is taken as that of R, which pools the errors of seeds.
    """
    values, errors = published("DSMC", gas.R, name)
    ours = gas.R_corrected if name == "R" else gas[name]
    return ours - values, np.sqrt(gas[f"{name}_stderr"] ** 2 + errors**2)


def cumulants_beside_published(gas: xr.Dataset) -> tuple[xr.DataArray, xr.DataArray]:
    """Return the same for all cumulants, along a dimension `cumulant`."""
    along = xr.DataArray(list(CUMULANTS), dims="cumulant", name="cumulant")
    pairs = [beside_published(gas, name) for name in CUMULANTS]
    gap, error = (xr.concat(parts, along) for parts in zip(*pairs, strict=True))
    return gap, error
