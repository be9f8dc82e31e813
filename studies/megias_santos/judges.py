"""Judge of the statement on published stationary states."""

import numpy as np
import xarray as xr

from roughgas.judging import SIGNIFICANT, Estimate, Finding, NotTestedError, grade, points, text

from .published import beside_published

CLOSE = 0.003
"""Difference in R up to which points that differ significantly qualify. Finite kicks are worth
0.0003, the number of particles beyond its degrees of freedom 0.0004. Fixed before its data."""


def is_published(gas: xr.Dataset) -> Finding:
    """R_corrected minus the published R is compatible with zero."""
    gap, error = (one.values for one in beside_published(gas))
    there = np.isfinite(gap) & np.isfinite(gas.R.values)
    if not there.any():
        raise NotTestedError("no published point is in the sweep and in a steady state")
    gap, error = gap[there], error[there]
    z = gap / error
    off = np.abs(z) >= SIGNIFICANT
    largest = int(np.argmax(np.abs(z)))
    worst = Estimate(float(gap[largest]), float(error[largest]), np.inf)
    reason = (
        f"At {int(off.sum())} of {points(len(z))} R differs by {SIGNIFICANT:g} combined standard "
        f"errors or more; z has the root mean square {np.sqrt(np.mean(z**2)):.2f}, and the largest "
        f"is that of {text(worst)}."
    )
    verdict = grade(not off.any(), bool((np.abs(gap[off]) < CLOSE).all()))
    return Finding(verdict, reason, (("R - published R where z is largest", worst),))
