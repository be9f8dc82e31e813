"""Judge of the statement on runaway spins."""

import numpy as np
import xarray as xr

from roughgas.judging import Estimate, Finding, NotTestedError, grade, power_law, text

METHODS = {"dsmc": "DSMC", "events": "events"}


def sooner_the_larger(runaway: xr.Dataset) -> Finding:
    """The exponent of N in the time until R > 0.9 is negative at each mu at which that time is
    known for two numbers of particles or more, by DSMC and by events."""
    cases = [
        (f"{method}, mu = {mu:g}", exponent)
        for kind, method in METHODS.items()
        for mu in runaway.mu.values
        if (exponent := _exponent(runaway.sel(mu=mu), kind)) is not None
    ]
    if not cases:
        raise NotTestedError("no time of escape is known for two numbers of particles")
    cases.sort(key=lambda pair: -pair[1].value)
    (flattest, largest), (steepest, smallest) = cases[0], cases[-1]
    falls, rises = (
        [exponent.is_significant and sign * exponent.value > 0 for _, exponent in cases]
        for sign in (-1, 1)
    )
    if not any(falls) and not any(rises):
        raise NotTestedError(
            f"the errors are too large to tell a direction: {text(smallest)} at most"
        )
    reason = (
        f"The time falls significantly with N in {sum(falls)} of {len(cases)} cases, and rises in "
        f"{sum(rises)}. The exponent is from {text(largest)} ({flattest}) to {text(smallest)}"
        f" ({steepest})."
    )
    numbers = tuple((f"exponent of N, {case}", exponent) for case, exponent in cases)
    return Finding(grade(all(falls), not any(rises)), reason, numbers)


def _exponent(gases: xr.Dataset, kind: str) -> Estimate | None:
    """Return the exponent of N in the time of escape; None if fewer than two times are known."""
    names = "time", "time_stderr", "escapes"
    time, stderr, escapes = (gases[f"{kind}_{name}"].values for name in names)
    is_known = np.isfinite(time) & (stderr > 0)
    if is_known.sum() < 2:
        return None
    number, time, stderr = (
        gases[f"{kind}_particles"].values[is_known],
        time[is_known],
        stderr[is_known],
    )
    law = power_law(number, time, (time / stderr) ** 2)
    dof = float(escapes[is_known].sum() - is_known.sum())
    return Estimate(law.exponent, law.stderr if dof >= 1 else np.nan, dof)
