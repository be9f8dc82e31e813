"""Judges of statements on drives that put in rotation."""

import numpy as np
import xarray as xr

from roughgas.judging import (
    AGREE,
    FAILS,
    HOLDS,
    QUALIFIED,
    Estimate,
    Finding,
    NotTestedError,
    Sample,
    agreement,
    averaged,
    combined_finding,
    deviation,
    deviation_at_shares,
    difference,
    over_seeds,
    points,
    spin_shares,
    text,
    worst_verdict,
)

SMOOTH = -1.0
"""Roughness of the reference boundary, which puts no rotation in."""
NO_ROTATION = 0.003
"""Share of rotation up to which a drive puts in translation alone. It changes R by less than AGREE
even at beta = -0.95, r = 0.9, where the response is strong: R - Lun's formula is 6 times the share.
Fixed before its data."""


def without_rotation(heated: xr.Dataset) -> Sample:
    """Return R - theory where a stochastic drive puts in translation alone."""
    if 0.0 not in heated.spin_share:
        raise NotTestedError("the sweep does not hold a drive of translation alone")
    return deviation(heated.sel(spin_share=0.0, drop=True))


def only_rotation_matters(bed: xr.Dataset) -> Finding:
    """R with rough boundaries differs from R with smooth ones where they put in rotation; where
    they do not, the difference is compatible with zero."""
    if SMOOTH not in bed.roughness:
        raise NotTestedError(f"the sweep does not reach roughness = {SMOOTH:g}")
    shares = spin_shares(bed)
    rough = bed.where((bed.roughness > SMOOTH) & np.isfinite(shares))
    spinning = np.abs(shares) >= NO_ROTATION
    smooth = bed.sel(roughness=SMOOTH, drop=True)
    if not np.isfinite(rough.R.where(spinning)).any():
        raise NotTestedError(f"no boundary puts in {NO_ROTATION:g} of rotation")
    shift = difference(rough.where(spinning), smooth)
    largest, location = shift.largest()
    off = int(shift.off(AGREE).sum())
    reason = (
        f"Where the share of rotation is {NO_ROTATION:g} or more in size, R is shifted by more "
        f"than {AGREE:g} at {off} of {points(shift.size)}, by up to {text(largest)} at {location}. "
    )
    elsewhere = _judge_translation_alone(rough.where(~spinning), smooth)
    verdict = worst_verdict(elsewhere.verdict, HOLDS if off else FAILS)
    numbers = (("largest shift where rotation is put in", largest), *elsewhere.numbers)
    return Finding(
        verdict, reason + elsewhere.reason, (*numbers, *_numbers_at_largest_roughness(bed))
    )


def _judge_translation_alone(still: xr.Dataset, smooth: xr.Dataset) -> Finding:
    """Judge rough boundaries that put in translation alone."""
    if not np.isfinite(still.R).any():
        reason = "All rough boundaries put in that much; smooth ones put in none."
        return Finding(QUALIFIED, reason)
    rest = difference(still, smooth)
    largest, location = rest.largest()
    reason = f"Where the share is smaller, by up to {text(largest)} at {location}."
    verdict = agreement(rest, "R with smooth boundaries").verdict
    return Finding(verdict, reason, (("largest shift where none is put in", largest),))


def _numbers_at_largest_roughness(bed: xr.Dataset) -> list[tuple[str, Estimate]]:
    """Return R - Lun's formula, and the share of rotation, at the largest roughness."""
    end = bed.sel(roughness=[bed.roughness.values.max()])
    shares = over_seeds(end, spin_shares(end), "input_spin_share")
    return [
        (f"{size} {name} at roughness = {end.roughness.item():g}", number)
        for name, differences in (
            ("R - Lun's formula", deviation(end)),
            ("share of rotation", shares),
        )
        for size, number in (("largest", differences.largest()[0]), ("mean", differences.mean()))
    ]


def one_curve_for_all_drives(*gases: xr.Dataset) -> Finding:
    """R averaged over collisions - the rate equations, at the measured share of rotation, is
    compatible with zero, whatever drives the gas."""
    theory = "the rate equations at the measured share"
    samples = (deviation_at_shares(averaged(gas, "R_collisional")) for gas in gases)
    pairs = zip(gases, samples, strict=True)
    return combined_finding(
        (gas.attrs["experiment"], agreement(differences, theory)) for gas, differences in pairs
    )
