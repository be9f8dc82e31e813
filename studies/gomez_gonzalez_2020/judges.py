"""Judge of shear thickening."""

import math

import numpy as np
import xarray as xr

from roughgas.judging import (
    Estimate,
    Finding,
    NotTestedError,
    check_power,
    grade,
    steady,
    text,
)

THICKENED = 2.0
"""Ratio of viscosities from which a suspension counts as thickened."""


def suspension_thickens(gas: xr.Dataset) -> Finding:
    """The viscosity at the largest shear rate is above the one at the least, by THICKENED."""
    low, high = (_viscosity(gas.isel(velocity=index, r=0, beta=0)) for index in (0, -1))
    ratio = high.value / low.value
    errors = [viscosity.stderr / viscosity.value for viscosity in (low, high)]
    excess = Estimate(ratio - 1.0, ratio * math.hypot(*errors), min(low.dof, high.dof))
    if not excess.is_significant:
        check_power(excess.detectable, THICKENED - 1.0)
    grows = excess.is_significant and ratio > 1.0
    reason = f"The viscosity grows by a factor of {ratio:.3g}; the factor less 1 is {text(excess)}."
    return Finding(
        grade(grows and ratio > THICKENED, grows), reason, (("growth of the viscosity", excess),)
    )


def _viscosity(point: xr.Dataset) -> Estimate:
    """Return -P_xy of the kinetic stress over the velocity of the images, of one point."""
    if np.isnan(steady(point, point.E_trans)):
        raise NotTestedError("a suspension at an end of the sweep is not known to be steady")
    element = {"component": "x", "along": "y"}
    stress, stderr, dof = (
        float(point[f"stress_kinetic{suffix}"].sel(element)) for suffix in ("", "_stderr", "_dof")
    )
    velocity = float(point.velocity)
    return Estimate(-stress / velocity, stderr / velocity, dof)
