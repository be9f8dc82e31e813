"""Judges of the statements on published stationary states."""

import numpy as np
import xarray as xr

from roughgas.judging import SIGNIFICANT, Finding, grade, points, sample, text

from .published import beside_published, cumulants_beside_published

CLOSE = 0.003
"""Difference in R up to which points that differ significantly qualify. An independent check of
heated gases found finite kicks worth 0.0003 at most, and the number of particles, beyond its
degrees of freedom, 0.0004. Fixed before its data."""
CLOSE_CUMULANTS = 0.01
"""The same of cumulants, a tenth of the larger ones. Fixed after runs at two states with larger
kicks, and before the data that are judged."""


def is_published(gas: xr.Dataset) -> Finding:
    """R_corrected minus the published R is compatible with zero."""
    return _compatible(gas, *beside_published(gas), "R", CLOSE)


def are_published(gas: xr.Dataset) -> Finding:
    """a20, a11 and a02 minus the published ones are compatible with zero."""
    found = cumulants_beside_published(gas)
    return _compatible(gas, *found, "a cumulant", CLOSE_CUMULANTS)


def _compatible(gas, gap, error, what, close) -> Finding:
    """Judge differences by their combined standard errors, as if these were known exactly.

    Degrees of freedom are infinitely many here. Rows of evidence count them, so that the same point
    may differ here and agree there.
    """
    gap = sample(gap.where(np.isfinite(gas.R)), error, np.full(gap.shape, np.inf))
    ratios, off = gap.value / gap.stderr, gap.real()
    largest = int(np.argmax(np.abs(ratios)))
    worst = gap.at(largest)
    reason = (
        f"At {int(off.sum())} of {points(gap.size)} {what} differs by {SIGNIFICANT:g} combined "
        "standard errors or more, as if these were known exactly; in them the root mean square is "
        f"{np.sqrt(np.mean(ratios**2)):.2f}, and the largest is {text(worst)} at "
        f"{gap.place(largest)}."
    )
    verdict = grade(not off.any(), not gap.off(close).any())
    return Finding(verdict, reason, ((f"{what} - published, largest in its errors", worst),))
