"""Judge of the statement on sheared gases."""

import numpy as np
import xarray as xr

from roughgas.judging import (
    AGREE_RELATIVE,
    DISAGREE_RELATIVE,
    FAILS,
    Estimate,
    Finding,
    NotTestedError,
    check_power,
    grade,
    sum_error,
    text,
)


def shear_gives_the_excess(profiles: xr.Dataset) -> Finding:
    """The excess of E_rot/E_trans over Lun's formula, summed over all sheared gases, is within
    AGREE_RELATIVE of what their measured shear rate and stress make it by `theory.transport`."""
    gases = profiles.isel(point=np.isfinite(profiles.theta.values))
    if not gases.sizes["point"]:
        raise NotTestedError("the study holds no sheared gas")
    if "runs" not in gases.attrs:
        raise NotTestedError("the study does not say of how many runs its errors are")
    lun = gases.R_lun / (1 - gases.R_lun)
    dof = np.full(gases.sizes["point"], gases.attrs["runs"] - 1.0)
    excess = _total(gases.theta / lun - 1, gases.theta_stderr / lun, dof)
    expected = _total(gases.factor - 1, gases.factor_stderr, dof)
    if not expected.is_significant:
        raise NotTestedError("theory expects no excess that differs from none significantly")
    ratio = excess.value / expected.value
    errors = [excess.stderr / expected.value, ratio * expected.stderr / expected.value]
    off = Estimate(ratio - 1, *map(float, sum_error(errors, [excess.dof, expected.dof])))
    verdict = grade(
        abs(off.value) <= AGREE_RELATIVE,
        abs(off.value) <= DISAGREE_RELATIVE or not off.is_significant,
    )
    if verdict != FAILS:
        check_power(off.detectable, DISAGREE_RELATIVE)
    reason = (
        f"Over {gases.sizes['point']} gases the relative excess of E_rot/E_trans over Lun's "
        f"formula is {text(excess)} in sum, expected {text(expected)}: found over expected - 1 is "
        f"{text(off)}."
    )
    numbers = (("found over expected - 1", off), ("found", excess), ("expected", expected))
    return Finding(verdict, reason, numbers)


def _total(values: xr.DataArray, stderr: xr.DataArray, dof: np.ndarray) -> Estimate:
    """Return the sum of independent values."""
    return Estimate(float(values.sum()), *map(float, sum_error(stderr.values, dof)))
