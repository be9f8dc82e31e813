"""Published stationary states of dilute rough disks driven by white noise: theta = T_rot/T_tr, and
the cumulants a20, a11, a02.

Megias & Santos, Front. Phys. 10, 971671 (2022); their data are public under the MIT licence: the
repository amegiasf/MpembaSplitting, commit f2d033c. theta is in the folder "Steady states". The
cumulants are means over the last 100 rows of columns 4, 6 and 5 in the folder "Transient", as is
theta by events; their errors are the largest of blocks of 1, 5 and 10 rows. The repository does not
name its columns: we identified them by theory and by our own data. Rounded here to five to seven
digits.
"""

from pathlib import Path

import numpy as np
import xarray as xr

from roughgas.judging import Estimate

REFERENCE = Path(__file__).with_name("reference.csv")
CUMULANTS = "a20", "a11", "a02"


def published(
    method: str, grid: xr.DataArray, name: str = "R"
) -> tuple[xr.DataArray, xr.DataArray]:
    """Return R, or the cumulant `name`, and its standard error by `method`, DSMC or EDMD, at the
    points of `grid`; NaN where unpublished."""
    values, errors = grid * np.nan, grid * np.nan
    rows = np.genfromtxt(REFERENCE, delimiter=",", names=True, dtype=None, encoding="utf-8")
    for row in rows[rows["method"] == method]:
        point = {axis: float(row[axis]) for axis in ("r", "beta", "spin_share")}
        if all(np.isclose(grid[axis], value).any() for axis, value in point.items()):
            theta = float(row["theta"])
            of_theta = theta / (1 + theta), float(row["theta_stderr"]) / (1 + theta) ** 2
            value_and_error = (
                of_theta if name == "R" else (float(row[name]), float(row[f"{name}_stderr"]))
            )
            values.loc[point], errors.loc[point] = value_and_error
    return values, errors


def published_R(r: float, beta: float, spin_share: float, method: str = "DSMC") -> Estimate:
    """Return R of a state by `method`, DSMC or EDMD, with its error.

    Raises KeyError for a state that is not published.
    """
    grid = xr.DataArray(
        [[[0.0]]],
        {"r": [r], "beta": [beta], "spin_share": [spin_share]},
        ("r", "beta", "spin_share"),
    )
    value, error = (float(array.squeeze()) for array in published(method, grid))
    if np.isnan(value):
        raise KeyError((r, beta, spin_share))
    return Estimate(value, error)


def difference_from_published(
    gas: xr.Dataset, name: str = "R"
) -> tuple[xr.DataArray, xr.DataArray, xr.DataArray]:
    """Return R_corrected, or the cumulant `name`, minus its value published by DSMC.

    The other arrays are the combined standard error and its degrees of freedom, by Welch and
    Satterthwaite; published errors have infinitely many. The error of R_corrected is taken as the
    error of R, which pools the errors of seeds.
    """
    values, errors = published("DSMC", gas.R, name)
    ours, stderr = gas.R_corrected if name == "R" else gas[name], gas[f"{name}_stderr"]
    squares = stderr**2 + errors**2
    dof = gas[f"{name}_dof"] * (squares / stderr**2) ** 2
    return ours - values, np.sqrt(squares), dof


def cumulant_differences(
    gas: xr.Dataset,
) -> tuple[xr.DataArray, xr.DataArray, xr.DataArray]:
    """Return difference_from_published of all cumulants, along a dimension `cumulant`."""
    along = xr.DataArray(list(CUMULANTS), dims="cumulant", name="cumulant")
    differences = [difference_from_published(gas, name) for name in CUMULANTS]
    gap, error, dof = (xr.concat(arrays, along) for arrays in zip(*differences, strict=True))
    return gap, error, dof
