"""Judges of statements on the waits of beds."""

import numpy as np
import xarray as xr

from roughgas.judging import (
    Estimate,
    Finding,
    NotTestedError,
    Sample,
    agreement,
    grade,
    text,
)

SHORT_WAIT = 500.0  # T
SAME_R, OTHER_R = 0.002, 0.006
"""Differences of R that agree, and that disagree: two and six errors of the least precise bed."""
SLOW = 100.0  # T
CLOSE, FAR = 0.25, 0.5
"""Relative differences of an e-fold from theory, at constant coefficients, that agree, and that
qualify."""


def short_wait_suffices(data: xr.Dataset) -> Finding:
    """R after a wait of SHORT_WAIT agrees with R of the settled bed."""
    after = data.sel(wait=SHORT_WAIT)
    known = after.isel(point=np.flatnonzero(np.isfinite(after.R_bias)))
    coordinates = {name: known[name].values for name in ("r", "beta")}
    dof = known.runs.values - 1.0
    sample = Sample(coordinates, known.R_bias.values, known.R_bias_stderr.values, dof)
    return agreement(sample, "R of the settled bed", SAME_R, OTHER_R)


def beds_settle(data: xr.Dataset) -> Finding:
    """The measured e-fold of E_trans agrees with theory in beds that settle slowly."""
    slow = data.isel(point=np.flatnonzero((data.settling >= SLOW) & np.isfinite(data.e_fold)))
    if not slow.sizes["point"]:
        raise NotTestedError(f"no bed has an e-fold of {SLOW:g} T or more")
    numbers = [
        (
            f"r = {r:g}, beta = {beta:g}: e-fold over theory, minus 1",
            Estimate(e_fold / theory - 1.0, stderr / theory, runs - 1.0),
        )
        for r, beta, e_fold, stderr, theory, runs in zip(
            *(
                slow[name].values
                for name in ("r", "beta", "e_fold", "e_fold_stderr", "settling", "runs")
            ),
            strict=True,
        )
    ]
    numbers.sort(key=lambda pair: -abs(pair[1].value))
    largest = abs(numbers[0][1].value)
    reason = "; ".join(f"{name}: {text(number)}" for name, number in numbers) + "."
    return Finding(grade(largest < CLOSE, largest < FAR), reason, tuple(numbers))
