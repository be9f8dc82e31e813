"""Judge of the tails of the velocities of spinners."""

import xarray as xr

from roughgas.judging import Finding, check_power, deviation_of, grade, text

REFUTING = 0.02
"""Kurtosis that a test must have been able to see: a stretched exponential of power 3/2 has 0.2."""


def tails_are_overpopulated(gas: xr.Dataset) -> Finding:
    """a20, the kurtosis of velocities, is positive significantly."""
    kurtosis = deviation_of(gas, "a20", xr.DataArray(0.0))
    positive = kurtosis.is_significant() & (kurtosis.value > 0.0)
    check_power(kurtosis.detectable(), REFUTING)
    largest, location = kurtosis.largest()
    reason = (
        f"a20 is positive significantly at {int(positive.sum())} of {kurtosis.size} points; the "
        f"largest is {text(largest)} at {location}."
    )
    return Finding(
        grade(bool(positive.all()), positive.mean() > 0.5),
        reason,
        (("largest a20", largest),),
        kurtosis.detectable(),
    )
