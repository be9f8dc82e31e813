"""Judge of the statement on sheared gases."""

import numpy as np
import xarray as xr

from roughgas.judging import (
    FAR,
    NEAR,
    SIGNIFICANT,
    Estimate,
    Finding,
    NotTestedError,
    grade,
    sum_error,
    text,
)


def shear_gives_the_excess(profiles: xr.Dataset) -> Finding:
    """The excess of E_rot/E_trans over Lun's formula, summed over all sheared gases, is within NEAR
    of what their measured shear rate and stress make it by `theory.transport`."""
    gases = profiles.isel(point=np.isfinite(profiles.theta.values))
    if not gases.sizes["point"]:
        raise NotTestedError("the study holds no sheared gas")
    if "runs" not in gases.attrs:
        raise NotTestedError("the study does not say of how many runs its errors are")
    lun = gases.R_lun / (1 - gases.R_lun)
    dof = np.full(gases.sizes["point"], gases.attrs["runs"] - 1.0)
    found = _total(gases.theta / lun - 1, gases.theta_stderr / lun, dof)
    expected = _total(gases.factor - 1, gases.factor_stderr, dof)
    if not expected.real:
        raise NotTestedError("theory expects no excess that differs from none significantly")
    ratio = found.value / expected.value
    parts = [found.stderr / expected.value, ratio * expected.stderr / expected.value]
    off = Estimate(ratio - 1, *map(float, sum_error(parts, [found.dof, expected.dof])))
    if SIGNIFICANT * off.stderr > FAR:
        raise NotTestedError(f"the errors are too large: found over expected - 1 is {text(off)}")
    verdict = grade(abs(off.value) <= NEAR, abs(off.value) <= FAR or not off.real)
    reason = (
        f"Over {gases.sizes['point']} gases the relative excess of E_rot/E_trans over Lun's "
        f"formula is {text(found)} in sum, expected {text(expected)}: found over expected - 1 is "
        f"{text(off)}."
    )
    numbers = (("found over expected - 1", off), ("found", found), ("expected", expected))
    return Finding(verdict, reason, numbers)


def _total(values: xr.DataArray, stderr: xr.DataArray, dof: np.ndarray) -> Estimate:
    """Return the sum of independent values."""
    return Estimate(float(values.sum()), *map(float, sum_error(stderr.values, dof)))
