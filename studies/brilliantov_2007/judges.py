"""Judge of the correlation between spins and velocities."""

import xarray as xr

from roughgas.judging import Finding, check_power, deviation_of, grade, text

WITHOUT_CORRELATION = 1 / 3
REFUTING = 0.005
"""A deviation from 1/3 that a test without any significant point must have been able to see."""


def angles_differ_from_chance(gas: xr.Dataset) -> Finding:
    """<cos^2> of the angle between V and w differs from 1/3 significantly."""
    gap = deviation_of(gas, "cos2_angle", xr.DataArray(WITHOUT_CORRELATION))
    significant = gap.is_significant()
    if not significant.any():
        check_power(gap.detectable(), REFUTING)
    largest, location = gap.largest()
    reason = (
        f"<cos^2> differs from 1/3 significantly at {int(significant.sum())} of {gap.size} points; "
        f"the largest difference is {text(largest)} at {location}."
    )
    verdict = grade(significant.mean() > 0.5, bool(significant.any()))
    return Finding(verdict, reason, (("largest difference from 1/3", largest),), gap.detectable())
