"""Judges of statements on self-diffusion."""

import numpy as np
import xarray as xr

from roughgas.judging import Finding, Sample, grade, points, text, together

from .coefficients import by_displacement, expected, rough_over_smooth

FULL, PARTLY = 0.01, 0.02
"""Relative difference of a ratio of coefficients up to which it holds, or is qualified. The first
Sonine approximation is 2 % low for smooth elastic spheres; part of that cancels in a ratio."""
CLOSE, NEAR = 0.03, 0.1
"""The same of the coefficients of a driven gas, whose velocities are not Maxwellian."""


def rough_diffuse_less(
    rough_disks: xr.Dataset,
    smooth_disks: xr.Dataset,
    rough_spheres: xr.Dataset,
    smooth_spheres: xr.Dataset,
) -> Finding:
    """D of perfectly rough over smooth elastic particles is as theory has it."""
    disks, spheres = (rough_disks, smooth_disks), (rough_spheres, smooth_spheres)
    return together([("disks", _one_ratio(*disks)), ("spheres", _one_ratio(*spheres))])


def _one_ratio(rough: xr.Dataset, smooth: xr.Dataset) -> Finding:
    found, theory = rough_over_smooth(rough, smooth)
    off = found.scaled(1.0 / theory)
    off = off._replace(value=off.value - 1.0)
    verdict = grade(not (off.real and abs(off.value) > FULL), abs(off.value) <= PARTLY)
    reason = f"{found:.4f} beside {theory:.4f}, a relative difference of {text(off)}."
    return Finding(verdict, reason, (("relative difference", off),))


def driven_gas_diffuses(gas: xr.Dataset) -> Finding:
    """D of a driven gas is that of theory at its temperature."""
    places, values = [], []
    for r in gas.r.values:
        for beta in gas.beta.values:
            one = gas.sel(r=r, beta=beta)
            if np.isfinite(one.R):
                found = by_displacement(one).scaled(1.0 / expected(one))
                values.append(found._replace(value=found.value - 1.0))
                places.append((r, beta))
    r, beta = np.array(places).T
    sample = Sample({"r": r, "beta": beta}, *map(np.array, zip(*values, strict=True)))
    largest, place = sample.largest()
    mean = sample.mean()
    reason = (
        f"{int((~sample.off(CLOSE)).sum())} of {points(sample.size)} within {CLOSE:.0%} of theory; "
        f"the largest difference is {text(largest)} at {place}, the mean {text(mean)}."
    )
    verdict = grade(not sample.off(CLOSE).any(), not sample.off(NEAR).any())
    return Finding(verdict, reason, (("largest relative difference", largest), ("mean", mean)))
