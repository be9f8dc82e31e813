"""Judges of statements on transport coefficients."""

from collections.abc import Callable

import numpy as np
import xarray as xr

from roughgas.judging import Estimate, Finding, Sample, grade, points, text, together

from .coefficients import (
    REMEMBERED,
    between_walls,
    by_displacement,
    expected,
    in_equilibrium,
    in_shear,
    point,
    rough_over_smooth,
)

FULL, PARTLY = 0.01, 0.02
"""Relative difference of a ratio of coefficients up to which it holds, or is qualified. The first
Sonine approximation is 2 % low for smooth elastic spheres; part of that cancels in a ratio."""
CLOSE, NEAR = 0.03, 0.1
"""The same of the coefficients themselves; velocities of a driven gas are not Maxwellian."""


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
    return _at_all_points(gas, lambda one: by_displacement(one).scaled(1.0 / expected(one)))


def driven_gas_is_viscous(gas: xr.Dataset) -> Finding:
    """Viscosity of a driven gas in a slow shear is that of theory at its temperatures."""
    return _at_all_points(gas, lambda one: in_shear(one)[-1])


def elastic_gases_carry(*gases: xr.Dataset) -> Finding:
    """Viscosity and conductivity of elastic gases in equilibrium are those of theory."""
    return together(
        (f"{name} of {gas.attrs['experiment']}", _one(in_equilibrium(point(gas), name)[-1]))
        for gas in gases
        for name in REMEMBERED
    )


def heat_flows_between_walls(*gases: xr.Dataset) -> Finding:
    """Conductivity of elastic gases between thermal walls is that of theory."""
    return together((gas.attrs["experiment"], _one(between_walls(point(gas)))) for gas in gases)


def walls_do_not_matter(*gases: xr.Dataset) -> Finding:
    """Conductivity is the same between walls twice as far apart, of gases in pairs."""
    found = []
    for gas, longer in zip(gases[::2], gases[1::2], strict=True):
        near, far = (between_walls(point(one)) for one in (gas, longer))
        change = far.minus(near).scaled(1.0 / near.value)
        found.append((gas.attrs["experiment"], _one(change._replace(value=1.0 + change.value))))
    return together(found)


def _one(over_theory: Estimate) -> Finding:
    off = over_theory._replace(value=over_theory.value - 1.0)
    verdict = grade(
        not (off.real and abs(off.value) > CLOSE), not (off.real and abs(off.value) > NEAR)
    )
    reason = f"a relative difference of {text(off)}."
    return Finding(verdict, reason, (("relative difference", off),))


def _at_all_points(gas: xr.Dataset, over_theory: Callable[[xr.Dataset], Estimate]) -> Finding:
    places, values = [], []
    for r in gas.r.values:
        for beta in gas.beta.values:
            one = gas.sel(r=r, beta=beta)
            if np.isfinite(one.R).all():
                found = over_theory(one)
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
