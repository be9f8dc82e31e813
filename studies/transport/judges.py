"""Judges of statements on transport coefficients."""

from collections.abc import Callable

import numpy as np
import xarray as xr

from roughgas.judging import (
    Estimate,
    Finding,
    NotTestedError,
    Sample,
    combined_finding,
    grade,
    points,
    text,
)

from . import dilute
from .coefficients import (
    MEMORY_LENGTHS,
    between_walls,
    by_displacement,
    expected,
    in_shear,
    point,
    rough_over_smooth,
)

RATIO_HOLDS, RATIO_QUALIFIED = 0.01, 0.02
"""Relative difference of a ratio of coefficients up to which it holds, or is qualified. The first
Sonine approximation is 2 % low for smooth elastic spheres; part of that cancels in a ratio."""
HOLDS_WITHIN, QUALIFIED_WITHIN = 0.03, 0.1
"""The same for the coefficients themselves; velocities of a driven gas are not Maxwellian."""


def rough_diffuse_less(
    rough_disks: xr.Dataset,
    smooth_disks: xr.Dataset,
    rough_spheres: xr.Dataset,
    smooth_spheres: xr.Dataset,
) -> Finding:
    """D of perfectly rough over smooth elastic particles agrees with theory."""
    disks, spheres = (rough_disks, smooth_disks), (rough_spheres, smooth_spheres)
    return combined_finding([("disks", _judge_ratio(*disks)), ("spheres", _judge_ratio(*spheres))])


def _judge_ratio(rough: xr.Dataset, smooth: xr.Dataset) -> Finding:
    ratio, theory = rough_over_smooth(rough, smooth)
    off = ratio.scaled(1.0 / theory)
    off = off._replace(value=off.value - 1.0)
    verdict = grade(
        not (off.is_significant and abs(off.value) > RATIO_HOLDS), abs(off.value) <= RATIO_QUALIFIED
    )
    reason = f"{ratio:.4f} beside {theory:.4f}, a relative difference of {text(off)}."
    return Finding(verdict, reason, (("relative difference", off),))


def driven_gas_diffuses(data: xr.Dataset) -> Finding:
    """D of driven disks without positions agrees with theory at its temperature at each point."""
    coefficients = dilute.driven(dilute.rows_of(data))
    findings = []
    for (r, beta), estimate in coefficients.items():
        off = difference(estimate, 1.0, 0.005)
        verdict = grade(abs(off.value) <= HOLDS_WITHIN, abs(off.value) <= 0.05)
        name = f"r = {r:g}, β = {beta:g}"
        findings.append((name, Finding(verdict, f"{text(off)}.", (("relative difference", off),))))
    return combined_finding(findings)


def events_diffuse_as_dsmc(gas: xr.Dataset, data: xr.Dataset) -> Finding:
    """D of driven disks by events is on average the same as without positions."""
    coefficients = dilute.driven(dilute.rows_of(data))
    changes = []
    for (r, beta), without_positions in coefficients.items():
        gas_at_point = gas.sel(r=r, beta=beta)
        if np.isfinite(gas_at_point.R):
            by_events = by_displacement(gas_at_point).scaled(1.0 / expected(gas_at_point))
            changes.append(by_events.minus(without_positions))
    value, stderr, dof = np.array(changes).T
    error = float(np.sqrt((stderr**2).sum()) / len(changes))
    mean = Estimate(float(value.mean()), error, float(dof.sum()))
    off = difference(mean, 0.0, 0.005)
    verdict = grade(abs(off.value) <= 0.01, abs(off.value) <= 0.02)
    reason = f"the mean difference at {points(len(changes))} is {text(off)}."
    return Finding(verdict, reason, (("mean difference", off),))


def difference(estimate: Estimate, expected: float, largest_error: float) -> Estimate:
    """Return `estimate` - `expected`. Raises NotTestedError for an error above `largest_error`."""
    if not estimate.stderr <= largest_error:
        reason = (
            f"an error is {estimate.stderr:.2%}, above the {largest_error:.1%} of the criterion"
        )
        raise NotTestedError(reason)
    return estimate._replace(value=estimate.value - expected)


def _within(off: Estimate, holds: float, qualified: float, or_not_significant: bool) -> Finding:
    """Return the finding on a difference that is at most `holds`, or at most `qualified`.

    With `or_not_significant` a larger difference that is not significant holds, too.
    """
    lenient = or_not_significant and not off.is_significant
    verdict = grade(lenient or abs(off.value) <= holds, abs(off.value) <= qualified)
    return Finding(verdict, f"{text(off)}.", (("relative difference", off),))


def driven_gas_is_viscous(gas: xr.Dataset) -> Finding:
    """Viscosity of a driven gas in a slow shear agrees with theory at its temperatures."""
    return _judge_all_points(gas, lambda point: in_shear(point)[-1])


def smooth_spheres_carry(data: xr.Dataset) -> Finding:
    """Viscosity and conductivity of smooth spheres have the published values."""
    return _smooth_gas_carries(data, "spheres")


def smooth_disks_carry(data: xr.Dataset) -> Finding:
    """Viscosity and conductivity of smooth disks have the published values."""
    return _smooth_gas_carries(data, "disks")


def _smooth_gas_carries(data, kind):
    rows, findings = dilute.rows_of(data), []
    for quantity in MEMORY_LENGTHS:
        estimate = dilute.limits(rows, quantity, kind, "equilibrium")[0.0]
        off = difference(estimate, dilute.PUBLISHED[quantity, kind], 0.005)
        findings.append((quantity, _within(off, 0.005, 0.015, True)))
    return combined_finding(findings)


def rough_gases_carry(data: xr.Dataset) -> Finding:
    """Viscosity and conductivity of rough gases have Pidduck's values."""
    rows, findings = dilute.rows_of(data), []
    for quantity, kind in dilute.PUBLISHED:
        for q, estimate in dilute.limits(rows, quantity, kind, "equilibrium").items():
            if q > 0.0:
                off = difference(estimate, 1.0, 0.01)
                name = f"{quantity} of {dilute.name_of(kind, q)}"
                findings.append((name, _within(off, HOLDS_WITHIN, 0.05, False)))
    return combined_finding(findings)


def correlated_spins_carry(data: xr.Dataset) -> Finding:
    """Correlated spins explain the coefficients of rough gases where isotropic ones do not."""
    rows, findings = dilute.rows_of(data), []
    for quantity, kind in dilute.PUBLISHED:
        for q, estimate in dilute.limits(rows, quantity, kind, "equilibrium").items():
            if q > 0.0 and abs(difference(estimate, 1.0, 0.01).value) > HOLDS_WITHIN:
                factor = dilute.corrected(quantity, kind, q)
                off = difference(estimate.scaled(1.0 / factor), 1.0, 0.01)
                name = f"{quantity} of {dilute.name_of(kind, q)}"
                findings.append((name, _within(off, HOLDS_WITHIN, 0.05, False)))
    if not findings:
        raise NotTestedError("Pidduck's approximation is within 3 % everywhere")
    return combined_finding(findings)


def methods_agree_on_viscosity(data: xr.Dataset) -> Finding:
    """Green-Kubo formulae and a small shear give the same viscosity."""
    return _methods_agree(data, "viscosity")


def methods_agree_on_conductivity(data: xr.Dataset) -> Finding:
    """Green-Kubo formulae and a small heat force give the same conductivity."""
    return _methods_agree(data, "conductivity")


def _methods_agree(data, quantity):
    pairs = dilute.pairs_of_methods(dilute.rows_of(data), quantity)
    return combined_finding(
        (name, _within(difference(forced.minus(memory), 0.0, 0.015), 0.01, 0.03, True))
        for name, memory, forced in pairs
    )


def events_carry_as_dsmc(data: xr.Dataset, *gases: xr.Dataset) -> Finding:
    """Event-driven rough spheres have the coefficients over theory of the gas without positions."""
    rows, findings = dilute.rows_of(data), []
    for quantity in MEMORY_LENGTHS:
        without_positions = dilute.limits(rows, quantity, "spheres", "equilibrium")[0.4]
        by_events = dilute.events_by_state(rows, quantity)
        by_events = by_events or dilute.events_by_state([*dilute.event_rows(*gases)], quantity)
        for state, estimate in by_events.items():
            off = difference(estimate.minus(without_positions), 0.0, 0.02)
            findings.append((f"{quantity} at {state}", _within(off, 0.02, 0.05, True)))
    return combined_finding(findings)


def heat_flows_between_walls(*gases: xr.Dataset) -> Finding:
    """Conductivity of elastic gases between thermal walls agrees with theory."""
    return combined_finding(
        (gas.attrs["experiment"], _judge_coefficient(between_walls(point(gas)))) for gas in gases
    )


def walls_do_not_matter(*gases: xr.Dataset) -> Finding:
    """Conductivity is the same between walls twice as far apart, of gases in pairs."""
    findings = []
    for gas, longer in zip(gases[::2], gases[1::2], strict=True):
        near, far = (between_walls(point(data)) for data in (gas, longer))
        change = far.minus(near).scaled(1.0 / near.value)
        findings.append(
            (gas.attrs["experiment"], _judge_coefficient(change._replace(value=1.0 + change.value)))
        )
    return combined_finding(findings)


def _judge_coefficient(over_theory: Estimate) -> Finding:
    off = difference(over_theory, 1.0, HOLDS_WITHIN / 2.0)
    verdict = grade(
        not (off.is_significant and abs(off.value) > HOLDS_WITHIN),
        not (off.is_significant and abs(off.value) > QUALIFIED_WITHIN),
    )
    reason = f"a relative difference of {text(off)}."
    return Finding(verdict, reason, (("relative difference", off),))


def _judge_all_points(gas: xr.Dataset, over_theory: Callable[[xr.Dataset], Estimate]) -> Finding:
    states, values = [], []
    for r in gas.r.values:
        for beta in gas.beta.values:
            gas_at_point = gas.sel(r=r, beta=beta)
            if np.isfinite(gas_at_point.R).all():
                estimate = over_theory(gas_at_point)
                values.append(estimate._replace(value=estimate.value - 1.0))
                states.append((r, beta))
    r, beta = np.array(states).T
    sample = Sample({"r": r, "beta": beta}, *map(np.array, zip(*values, strict=True)))
    largest, location = sample.largest()
    mean = sample.mean()
    reason = (
        f"{int((~sample.off(HOLDS_WITHIN)).sum())} of {points(sample.size)} within "
        f"{HOLDS_WITHIN:.0%} of theory; the largest difference is {text(largest)} at {location}, "
        f"the mean {text(mean)}."
    )
    verdict = grade(not sample.off(HOLDS_WITHIN).any(), not sample.off(QUALIFIED_WITHIN).any())
    return Finding(verdict, reason, (("largest relative difference", largest), ("mean", mean)))
