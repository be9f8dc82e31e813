"""Judges of the statements on published stationary states."""

import math

import numpy as np
import xarray as xr

from roughgas.judging import (
    Estimate,
    Finding,
    NotTestedError,
    grade,
    point_text,
    points,
    sample,
    text,
)
from roughgas.tasks import estimate_of, slices_along

from .long import HOMOGENEOUS_R, committed
from .published import cumulant_differences, difference_from_published, published_R
from .tasks import State

CLOSE = 0.003
"""Difference in R up to which points that differ significantly qualify. An independent check of
heated gases found finite kicks worth 0.0003 at most, and the number of particles, beyond its
degrees of freedom, 0.0004. Fixed before its data."""
CLOSE_CUMULANTS = 0.01
"""The same for cumulants, a tenth of the larger ones. Fixed after runs at two states with larger
kicks, and before the data that are judged."""

CLOSE_HOMOGENEOUS = 0.0003
"""The same for R of homogeneous gases, which has neither packing nor walls."""
LARGEST_HOMOGENEOUS_ERROR = 0.0002
"""Combined error of R of homogeneous gases beyond which nothing is judged."""


def is_published(gas: xr.Dataset) -> Finding:
    """R_corrected minus the published R is compatible with zero."""
    return _compatible(gas, *difference_from_published(gas), "R", CLOSE)


def are_published(gas: xr.Dataset) -> Finding:
    """a20, a11 and a02 minus the published ones are compatible with zero."""
    differences = cumulant_differences(gas)
    return _compatible(gas, *differences, "a cumulant", CLOSE_CUMULANTS)


def _compatible(gas, gap, error, dof, quantity, tolerance) -> Finding:
    """Judge differences by Student's t over their combined standard errors."""
    gap = sample(gap.where(np.isfinite(gas.R)), error, dof)
    sigmas, off = np.array([gap.at(k).sigma for k in range(gap.size)]), gap.is_significant()
    largest = int(np.argmax(np.abs(sigmas)))
    worst = gap.at(largest)
    reason = (
        f"At {int(off.sum())} of {points(gap.size)} {quantity} differs significantly; z has the "
        f"root mean square {np.sqrt(np.mean(sigmas**2)):.2f}, and the largest difference in its "
        f"errors is {text(worst)} at {gap.point_text(largest)}."
    )
    verdict = grade(not off.any(), not gap.off(tolerance).any())
    return Finding(verdict, reason, ((f"{quantity} - published, largest in its errors", worst),))


def homogeneous_is_published(tasks: xr.Dataset) -> Finding:
    """R of homogeneous gases in long.csv minus the published R is compatible with zero.

    The data of this scale test that the tasks still give the results in long.csv.
    """
    limits, gaps = committed(HOMOGENEOUS_R), {}
    for row in slices_along(tasks, "state"):
        state = State(*(row[name].item() for name in State._fields))
        at = point_text(state._asdict())
        limit = limits[state]
        again = estimate_of(row, "R")._replace(dof=float(row.R_dof))
        if again.minus(limit).is_significant:
            raise NotTestedError(f"R of homogeneous gases is {again} at {at}, {limit} in long.csv")
        gaps[at] = limit.minus(published_R(*state))
    off = [gap for gap in gaps.values() if gap.is_significant]
    if not off and max(gap.stderr for gap in gaps.values()) > LARGEST_HOMOGENEOUS_ERROR:
        raise NotTestedError("the errors of R of homogeneous gases are too large")
    worst = max(gaps, key=lambda at: abs(gaps[at].sigma))
    mean = sum(gap.value for gap in gaps.values()) / len(gaps)
    error = math.sqrt(sum(gap.stderr**2 for gap in gaps.values())) / len(gaps)
    reason = (
        f"At {len(off)} of {points(len(gaps))} R differs significantly; the largest difference in "
        f"its errors is {text(gaps[worst])} at {worst}, the mean {Estimate(mean, error):+±}."
    )
    verdict = grade(not off, all(abs(gap.value) < CLOSE_HOMOGENEOUS for gap in off))
    return Finding(verdict, reason, (("R - published, largest in its errors", gaps[worst]),))
