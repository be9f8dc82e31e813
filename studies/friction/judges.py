"""Judges of statements on Coulomb friction."""

import numpy as np
import xarray as xr

from roughgas.judging import (
    AGREE,
    DISAGREE,
    FAILS,
    Finding,
    NotTestedError,
    agreement,
    agreement_in_proportion,
    ratio_sample,
    sample,
    sum_error,
    text,
)

SPIN_ALONE = 1 - 1e-6
"""R of theory beyond which spin outlives translation: 1, up to rounding."""


def follows_rates(gas: xr.Dataset) -> Finding:
    """R - the rate equations with friction is compatible with zero, also relative to theory."""
    held = gas.sel(mu=gas.mu > 0.0)  # at mu = 0 spin is decoupled: R keeps its initial value
    finding = agreement_in_proportion(held, "the rate equations")
    measured, expected = _rough_from(held.R), _rough_from(held.theory)
    thresholds = "; ".join(
        f"beta = {beta:g}: {measured[beta]} (rate equations {expected[beta]})" for beta in measured
    )
    largest = held.mu.values[-1]
    return finding.with_note(
        f"Smallest mu from which R stays within {AGREE:g} of R at the largest, mu = {largest:g}: "
        f"{thresholds}."
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
    finding = agreement(ratio_sample(held, (held.R - 1).where(alone)), "1")
    next_mu = held[["R", "R_stderr", "R_dof", "theory"]].shift(mu=-1)
    errors = sum_error([held.R_stderr, next_mu.R_stderr], [held.R_dof, next_mu.R_dof])
    fall = (held.R - next_mu.R).where(alone & (next_mu.theory <= SPIN_ALONE))
    jump = sample(fall, *errors)
    expected = sample((held.theory - next_mu.theory).where(np.isfinite(fall)), *errors)
    largest, location = jump.largest()
    theory_fall = expected.value[int(np.argmax(np.abs(jump.value)))]
    reason = f"Where theory has R = 1, {finding.reason} From there to the next mu of the sweep, R "
    reason += f"falls by up to {text(largest)} at {location}, in theory by {theory_fall:.4f}."
    verdict = finding.verdict if largest.is_significant and largest.value > DISAGREE else FAILS
    numbers = (*finding.numbers[:2], ("largest fall of R", largest))
    return Finding(verdict, reason, numbers, finding.detectable)
