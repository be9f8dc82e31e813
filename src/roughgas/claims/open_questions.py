"""Judges of the statements in open_questions.yaml: drives that put in rotation, wave forms, and
Coulomb friction."""

import numpy as np
import xarray as xr

from roughgas.claims.evidence import (
    NotTestedError,
    Sample,
    deviation,
    deviation_at_shares,
    difference,
    of_ratio,
    over_seeds,
    sample,
    spin_shares,
)
from roughgas.claims.verdicts import (
    AGREE,
    FAILS,
    HOLDS,
    LIMIT,
    QUALIFIED,
    Finding,
    agreement,
    agreement_in_proportion,
    points,
    text,
    together,
    worse,
)
from roughgas.statistics.errors import Estimate, sum_error

SMOOTH = -1.0
"""Roughness of a boundary that puts no rotation in: the bed that the others are compared with."""
NO_ROTATION = 0.003
"""Share of rotation up to which a drive puts in translation alone. It changes R by less than AGREE
even at beta = -0.95, r = 0.9, where the response is strong: R - Lun's formula is 6 times the share.
Fixed before its data."""
REFERENCE = "sawtooth"
SPIN_ALONE = 1 - 1e-6
"""R of theory from which spin outlives translation: it is 1 but for rounding."""


def without_rotation(heated: xr.Dataset) -> Sample:
    """Return R - theory where a stochastic drive puts in translation alone."""
    if 0.0 not in heated.spin_share:
        raise NotTestedError("the sweep does not hold a drive of translation alone")
    return deviation(heated.sel(spin_share=0.0, drop=True))


def follows_its_share(driven: xr.Dataset) -> Finding:
    """R - the rate equations, at the measured share of rotation, is compatible with zero."""
    found = agreement(deviation_at_shares(driven), "the rate equations at the measured share")
    shares = spin_shares(driven)
    low, high, taken = float(shares.min()), float(shares.max()), int((shares < 0).sum())
    found = found.noting(f"The share is from {low:.3f} to {high:.3f}.")
    return found.noting(f"At {points(taken)} rotation is taken out.") if taken else found


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
    largest, place = shift.largest()
    off = int(shift.off(AGREE).sum())
    reason = (
        f"Where the share of rotation is {NO_ROTATION:g} or more in size, R is shifted by more "
        f"than {AGREE:g} at {off} of {points(shift.size)}, by up to {text(largest)} at {place}. "
    )
    elsewhere = _elsewhere(rough.where(~spinning), smooth)
    verdict = worse(elsewhere.verdict, HOLDS if off else FAILS)
    numbers = (("largest shift where rotation is put in", largest), *elsewhere.numbers)
    return Finding(verdict, reason + elsewhere.reason, (*numbers, *_roughest(bed)))


def _elsewhere(still: xr.Dataset, smooth: xr.Dataset) -> Finding:
    """Judge rough boundaries that put in translation alone."""
    if not np.isfinite(still.R).any():
        reason = "All rough boundaries put in that much; smooth ones put in none."
        return Finding(QUALIFIED, reason)
    rest = difference(still, smooth)
    largest, place = rest.largest()
    reason = f"Where the share is smaller, by up to {text(largest)} at {place}."
    verdict = agreement(rest, "R with smooth boundaries").verdict
    return Finding(verdict, reason, (("largest shift where none is put in", largest),))


def _roughest(bed: xr.Dataset) -> list[tuple[str, Estimate]]:
    """Return R - Lun's formula, and the share of rotation, at the largest roughness."""
    end = bed.sel(roughness=[bed.roughness.values.max()])
    shares = over_seeds(end, spin_shares(end), "input_spin_share")
    return [
        (f"{size} {name} at roughness = {end.roughness.item():g}", number)
        for name, found in (("R - Lun's formula", deviation(end)), ("share of rotation", shares))
        for size, number in (("largest", found.largest()[0]), ("mean", found.mean()))
    ]


def wave_form_changes_nothing(waves: xr.Dataset) -> Finding:
    """R over a floor that moves in any other wave - R over the sawtooth is compatible with zero.

    Waves are compared one by one, since the errors of the sawtooth are common to them.
    """
    others = [str(wave) for wave in waves.wave.values if wave != REFERENCE]
    if not others or REFERENCE not in waves.wave:
        raise NotTestedError(f"the sweep does not hold the wave {REFERENCE} and another")
    sawtooth = waves.sel(wave=REFERENCE)
    return together(
        (wave, agreement(difference(waves.sel(wave=wave), sawtooth), "R over the sawtooth"))
        for wave in others
    )


def follows_rates(gas: xr.Dataset) -> Finding:
    """R - the rate equations with friction is compatible with zero, also relative to theory."""
    held = gas.sel(mu=gas.mu > 0.0)  # at mu = 0 spin is decoupled: R keeps its initial value
    found = agreement_in_proportion(held, "the rate equations")
    measured, expected = _rough_from(held.R), _rough_from(held.theory)
    at = "; ".join(
        f"beta = {beta:g}: {measured[beta]} (rate equations {expected[beta]})" for beta in measured
    )
    largest = held.mu.values[-1]
    return found.noting(
        f"Smallest mu from which R stays within {AGREE:g} of R at the largest, mu = {largest:g}: "
        f"{at}."
    )


def _rough_from(ratio: xr.DataArray) -> dict[float, str]:
    """Return for each beta the smallest mu from which R at every r stays within AGREE of R at the
    largest mu; "none" where R at the largest is unknown."""
    far = ~(abs(ratio - ratio.isel(mu=-1)) <= AGREE).all("r")
    smallest = {}
    for beta in ratio.beta.values:
        beyond = ratio.mu[np.flatnonzero(np.append([True], far.sel(beta=beta)))[-1] :]
        smallest[float(beta)] = f"{float(beyond[0]):g}" if beyond.size else "none"
    return smallest


def keeps_spin_when_weak(cooling: xr.Dataset) -> Finding:
    """Where theory has R = 1, R - 1 is compatible with zero; beyond the last such mu, R jumps
    down."""
    held = cooling.sel(mu=cooling.mu > 0.0)
    alone = held.theory > SPIN_ALONE
    if not alone.any():
        raise NotTestedError("no mu > 0 of the sweep has R = 1 in theory")
    found = agreement(of_ratio(held, (held.R - 1).where(alone)), "1")
    after = held[["R", "R_stderr", "R_dof", "theory"]].shift(mu=-1)
    errors = sum_error([held.R_stderr, after.R_stderr], [held.R_dof, after.R_dof])
    fall = (held.R - after.R).where(alone & (after.theory <= SPIN_ALONE))
    jump = sample(fall, *errors)
    expected = sample((held.theory - after.theory).where(np.isfinite(fall)), *errors)
    largest, place = jump.largest()
    by = expected.value[int(np.argmax(np.abs(jump.value)))]
    reason = f"Where theory has R = 1, {found.reason} From there to the next mu of the sweep, R "
    reason += f"falls by up to {text(largest)} at {place}, in theory by {by:.4f}."
    verdict = found.verdict if largest.real and largest.value > LIMIT else FAILS
    return Finding(verdict, reason, (*found.numbers[:2], ("largest fall of R", largest)))
