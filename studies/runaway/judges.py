"""Judge of the statement on runaway spins."""

import numpy as np
import xarray as xr

from roughgas.judging import Estimate, Finding, NotTestedError, grade, power_law, text

METHODS = {"dsmc": "DSMC", "events": "events"}


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
    names = "time", "time_stderr", "escapes"
    time, stderr, escapes = (gases[f"{kind}_{name}"].values for name in names)
    known = np.isfinite(time) & (stderr > 0)
    if known.sum() < 2:
        return None
    number, time, stderr = gases[f"{kind}_particles"].values[known], time[known], stderr[known]
    law = power_law(number, time, (time / stderr) ** 2)
    dof = float(escapes[known].sum() - known.sum())
    return Estimate(law.exponent, law.stderr if dof >= 1 else np.nan, dof)
