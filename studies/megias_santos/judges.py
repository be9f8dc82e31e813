"""Judge of the statement on published stationary states."""

import numpy as np
import xarray as xr

from roughgas.judging import SIGNIFICANT, Finding, grade, points, sample, text

from .published import beside_published

CLOSE = 0.003
"""Difference in R up to which points that differ significantly qualify. An independent check of
heated gases found finite kicks worth 0.0003 at most, and the number of particles, beyond its
degrees of freedom, 0.0004. Fixed before its data."""


def is_published(gas: xr.Dataset) -> Finding:
    """R_corrected minus the published R is compatible with zero."""
    gap, error = beside_published(gas)
    gap = sample(gap.where(np.isfinite(gas.R)), error, np.full(gap.shape, np.inf))
    z, off = gap.value / gap.stderr, gap.real()
    largest = int(np.argmax(np.abs(z)))
    worst = gap.at(largest)
    reason = (
        f"At {int(off.sum())} of {points(gap.size)} R differs by {SIGNIFICANT:g} combined standard "
        f"errors or more; z has the root mean square {np.sqrt(np.mean(z**2)):.2f}, and the largest "
        f"is that of {text(worst)} at {gap.place(largest)}."
    )
    verdict = grade(not off.any(), not gap.off(CLOSE).any())
    return Finding(verdict, reason, (("R - published R where z is largest", worst),))
