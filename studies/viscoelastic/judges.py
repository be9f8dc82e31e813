"""Judges of statements on viscoelastic gases."""

import numpy as np
import xarray as xr

from roughgas.judging import (
    Finding,
    NotTestedError,
    Sample,
    agreement,
    grade,
    of_ratio,
    over_seeds,
    text,
)
from roughgas.theory import viscoelastic_ratio

FIVE_THIRDS = 5 / 3
LOSSLESS = (-1.0, 1.0)
"""Roughness at which contacts lose energy along the normal alone."""
CLOSE = 0.1
"""By how much an exponent of time may be off where a statement holds. Fixed before its data."""
ROUGHLY = 0.3
"""By how much where it holds with a qualification. Fixed before its data."""


def viscoelastic_exponent(gas: xr.Dataset) -> Finding:
    """-d ln E_trans/d ln t is 5/3 for smooth and for perfectly rough particles."""
    if "decay_exponent" not in gas:
        raise NotTestedError("the dataset does not say how the energy falls with time")
    there = gas.beta.isin(LOSSLESS) & np.isfinite(gas.decay_exponent)
    found = over_seeds(gas, (gas.decay_exponent - FIVE_THIRDS).where(there), "decay_exponent")
    largest, place = found.largest()
    reason = (
        f"The exponent is from {found.value.min() + FIVE_THIRDS:.3f} to "
        f"{found.value.max() + FIVE_THIRDS:.3f}; farthest from 5/3, by {text(largest)}, at {place}."
    )
    verdict = grade(not found.off(CLOSE).any(), not found.off(ROUGHLY).any())
    return Finding(verdict, reason, (("largest deviation from 5/3", largest),))


def follows_present_restitution(gas: xr.Dataset) -> Finding:
    """R - the theory of free cooling at the restitution of the present temperature, averaged over
    the plateau, is compatible with zero."""
    return agreement(beside_present_theory(gas), "the theory of free cooling at the present r")


def beside_present_theory(gas: xr.Dataset) -> Sample:
    """Return R minus what theory has at the temperatures of the measured window."""
    if "time_series" not in gas:
        raise NotTestedError("the dataset does not say how the energy falls with time")
    at = gas.collisions_per_particle
    inside = (at >= gas.measured_from) & (at <= gas.plateau_end)
    measured = gas.R_series.where(inside).mean("sample")
    r, beta, series = xr.broadcast(gas.r, gas.beta, gas.E_trans_series.fillna(0.0))
    about = gas.attrs["r_at_speed"], gas.attrs["dimension"], gas.attrs["inertia"]
    # the gas begins at 1 m a^2/T^2
    expected = series.copy(data=viscoelastic_ratio(series.values, r.values, beta.values, *about))
    expected = expected.where(inside).mean("sample")
    return of_ratio(gas, (measured - expected).where(gas.beta > -1.0))
