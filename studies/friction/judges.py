"""Judges of statements on Coulomb friction."""

import numpy as np
import xarray as xr

from roughgas.judging import (
    AGREE,
    FAILS,
    LIMIT,
    Finding,
    NotTestedError,
    agreement,
    agreement_in_proportion,
    of_ratio,
    sample,
    sum_error,
    text,
)

SPIN_ALONE = 1 - 1e-6
"""R of theory from which spin outlives translation: it is 1 but for rounding."""


def follows_rates(gas: xr.Dataset) -> Finding:
    """R - the rate equations with friction is compatible with zero, also relative to theory."""
    held = gas.sel(mu=gas.mu > 0.0)  # at mu = 0 spin is decoupled: R keeps its initial value
    found = agreement_in_proportion(held, "the rate equations")
    measured, expected = _rough_from(held.R), _rough_from(held.theory)
    at = "; ".join(
        f"beta = {beta:g}: {measured[beta]} (rate equations {expected[beta]})" for beta in measured
    )
    largest = held.mu.values[-1]
    return found.with_note(
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
