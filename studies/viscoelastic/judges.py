"""Judges of statements on viscoelastic gases."""

import numpy as np
import xarray as xr

from roughgas.judging import (
    FAILS,
    Finding,
    NotTestedError,
    Sample,
    agreement,
    check_power,
    grade,
    over_seeds,
    ratio_sample,
    text,
)
from roughgas.theory import viscoelastic_ratio

FIVE_THIRDS = 5 / 3
LOSSLESS = (-1.0, 1.0)
"""Roughness at which contacts lose energy along the normal alone."""
CLOSE = 0.1
"""Error of an exponent of time up to which a statement holds. Fixed before its data."""
ROUGHLY = 0.3
"""Error of an exponent up to which it holds with a qualification. Fixed before its data."""


def viscoelastic_exponent(gas: xr.Dataset) -> Finding:
    """-d ln E_trans/d ln t is 5/3 for smooth and for perfectly rough particles."""
    if "decay_exponent" not in gas:
        raise NotTestedError("the dataset does not say how the energy falls with time")
    lossless = gas.beta.isin(LOSSLESS) & np.isfinite(gas.decay_exponent)
    excess = over_seeds(gas, (gas.decay_exponent - FIVE_THIRDS).where(lossless), "decay_exponent")
    largest, location = excess.largest()
    reason = (
        f"The exponent is from {excess.value.min() + FIVE_THIRDS:.3f} to "
        f"{excess.value.max() + FIVE_THIRDS:.3f}; farthest from 5/3, by {text(largest)}, "
        f"at {location}."
    )
    verdict = grade(not excess.off(CLOSE).any(), not excess.off(ROUGHLY).any())
    if verdict != FAILS:
        check_power(excess.detectable(), ROUGHLY)
    numbers = (("largest deviation from 5/3", largest),)
    return Finding(verdict, reason, numbers, excess.detectable())


def follows_present_restitution(gas: xr.Dataset) -> Finding:
    """R - the theory of free cooling at the restitution of the present temperature, averaged over
    the plateau, is compatible with zero."""
    return agreement(deviation_at_present_r(gas), "the theory of free cooling at the present r")


def deviation_at_present_r(gas: xr.Dataset) -> Sample:
    """Return R minus theory at the temperatures of the measured window."""
    if "time_series" not in gas:
        raise NotTestedError("the dataset does not say how the energy falls with time")
    passed = gas.collisions_per_particle
    inside = (passed >= gas.measured_from) & (passed <= gas.plateau_end)
    measured = gas.R_series.where(inside).mean("sample")
    r, beta, series = xr.broadcast(gas.r, gas.beta, gas.E_trans_series.fillna(0.0))
    parameters = gas.attrs["r_at_speed"], gas.attrs["dimension"], gas.attrs["inertia"]
    # the gas begins at 1 m a^2/T^2
    expected = series.copy(
        data=viscoelastic_ratio(series.values, r.values, beta.values, *parameters)
    )
    expected = expected.where(inside).mean("sample")
    return ratio_sample(gas, (measured - expected).where(gas.beta > -1.0))
