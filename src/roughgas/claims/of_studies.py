"""Judges of the statements that studies decide: on sheared gases, and on runaway spins."""

import numpy as np
import xarray as xr

from roughgas.claims.evidence import NotTestedError
from roughgas.claims.verdicts import FAR, NEAR, Finding, grade, text
from roughgas.statistics.errors import SIGNIFICANT, Estimate, sum_error
from roughgas.statistics.fits import power_law

METHODS = {"dsmc": "DSMC", "events": "events"}


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


def sooner_the_larger(runaway: xr.Dataset) -> Finding:
    """The exponent of N in the time until R > 0.9 is negative at each mu at which that time is
    known for two numbers of particles or more, by DSMC and by events."""
    found = [
        (f"{method}, mu = {mu:g}", exponent)
        for kind, method in METHODS.items()
        for mu in runaway.mu.values
        if (exponent := _exponent(runaway.sel(mu=mu), kind)) is not None
    ]
    if not found:
        raise NotTestedError("no time of escape is known for two numbers of particles")
    found.sort(key=lambda pair: -pair[1].value)
    (flattest, least), (steepest, most) = found[0], found[-1]
    falls, rises = ([one.real and sign * one.value > 0 for _, one in found] for sign in (-1, 1))
    if not any(falls) and not any(rises):
        raise NotTestedError(f"the errors are too large to tell a direction: {text(most)} at most")
    reason = (
        f"The time falls significantly with N in {sum(falls)} of {len(found)} cases, and rises in "
        f"{sum(rises)}. The exponent is from {text(least)} ({flattest}) to {text(most)}"
        f" ({steepest})."
    )
    numbers = tuple((f"exponent of N, {where}", one) for where, one in found)
    return Finding(grade(all(falls), not any(rises)), reason, numbers)


def _exponent(gases: xr.Dataset, kind: str) -> Estimate | None:
    """Return the exponent of N in the time of escape; None where fewer than two times are known."""
    time, stderr, escapes = (
        gases[f"{kind}_{name}"].values for name in ("time", "time_stderr", "escapes")
    )
    known = np.isfinite(time) & (stderr > 0)
    if known.sum() < 2:
        return None
    number, time, stderr = gases[f"{kind}_particles"].values[known], time[known], stderr[known]
    law = power_law(number, time, (time / stderr) ** 2)
    dof = float(escapes[known].sum() - known.sum())
    return Estimate(law.exponent, law.stderr if dof >= 1 else np.nan, dof)
