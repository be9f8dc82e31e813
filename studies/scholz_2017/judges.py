"""Judge of the tails of the velocities of spinners."""

import math

import numpy as np
import xarray as xr

from roughgas.judging import Finding, check_power, grade, sample, steady, text

BEGIN_OF_TAILS = 3.5
"""Velocity component in root mean squares beyond which its distribution counts as a tail."""
REFUTING = 0.3
"""Share of a Gaussian's tail by which a tail is refuted to be larger."""


def tails_are_overpopulated(gas: xr.Dataset) -> Finding:
    """The share of velocity components in the tails is above that of a Gaussian."""
    excess = _excess_of_tails(gas)
    above = excess.is_significant() & (excess.value > 0.0)
    largest, location = excess.largest()
    reason = (
        f"Tails beyond {BEGIN_OF_TAILS:g} root mean squares are larger than a Gaussian's "
        f"significantly at {int(above.sum())} of {excess.size} points; the largest difference, "
        f"over the Gaussian's, is {text(largest)} at {location}."
    )
    verdict = grade(bool(above.all()), above.mean() > 0.5)
    if not excess.is_significant().any():
        check_power(excess.detectable(), REFUTING)
    return Finding(verdict, reason, (("largest excess of tails", largest),), excess.detectable())


def _excess_of_tails(gas: xr.Dataset):
    """Return the share of components in the tails over a Gaussian's, less 1, at steady points."""
    velocity = gas.reduced_velocity
    width = float(velocity[1] - velocity[0])
    is_tail = abs(velocity) > BEGIN_OF_TAILS
    begin = float(abs(velocity).where(is_tail).min()) - 0.5 * width  # lower side of the first bin
    gaussian = math.erfc(begin / math.sqrt(2.0))
    dims = ("reduced_velocity", "component")
    components = gas.sizes["component"]
    share = gas.velocity_histogram.where(is_tail, 0.0).sum(dims) * width / components
    stderr = (
        np.sqrt((gas.velocity_histogram_stderr.where(is_tail, 0.0) ** 2).sum(dims))
        * width
        / components
    )
    dof = gas.velocity_histogram_dof.where(is_tail).min(dims)
    excess = steady(gas, share / gaussian - 1.0)
    return sample(excess, (stderr / gaussian).values, dof.values)
