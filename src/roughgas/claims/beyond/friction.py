"""Coulomb friction: R against its coefficient mu, in a driven gas and in a cooling one."""

import numpy as np
import xarray as xr

from roughgas import theory
from roughgas.claims.beyond.proportion import agreement_in_proportion
from roughgas.claims.evidence import NotTestedError, sample
from roughgas.claims.finding import AGREE, Finding, Statement, agreement, text

QUOTE = (
    "calculating R for the more realistic interaction model that accounts also for Coulomb-friction"
)
SPIN_ALONE = 1 - 1e-6
"""R of theory from which spin outlives translation: it is 1 but for rounding."""


def follows_rates_when_strong(cooling: xr.Dataset) -> Finding:
    """R of a cooling gas - the rate equations is as good as zero, where friction is too strong for
    spin to outlive translation."""
    strong = cooling.mu > float(theory.critical_friction(cooling.r.values.min()))
    if not strong.any():
        raise NotTestedError("no mu of the sweep is beyond the critical one")
    found = follows_rates(cooling.sel(mu=strong))
    least = float(cooling.mu[strong][0])
    return found._replace(reason=f"For mu >= {least:g}: {found.reason}")


def follows_rates(gas: xr.Dataset) -> Finding:
    """R - the rate equations with friction is as good as zero."""
    held = _with_friction(gas)
    found = agreement_in_proportion(held, "the rate equations")
    measured, expected = rough_from(held.R), rough_from(held.theory)
    at = "; ".join(
        f"beta = {beta:g}: {_or_none(measured[beta])} (rate equations {_or_none(expected[beta])})"
        for beta in measured
    )
    note = f" Smallest mu from which R stays within {AGREE:g} of R at the largest, "
    return found._replace(reason=f"{found.reason}{note}mu = {held.mu.values[-1]:g}: {at}.")


def keeps_spin_when_weak(cooling: xr.Dataset) -> Finding:
    """Where theory has R = 1 alone, R - 1 is as good as zero.

    Between there and the critical mu theory has two stable states, and the one at R = 1 is reached
    through the other: how far R is from that is told, and does not decide.
    """
    held = _with_friction(cooling)
    alone = held.theory > SPIN_ALONE
    if not alone.any():
        raise NotTestedError("no mu > 0 of the sweep has R = 1 in theory")
    found = agreement(sample((held.R - 1).where(alone), held.error, held.attrs["freedom"]), "1")
    reason = f"Where theory has R = 1 alone, {found.reason}"
    numbers = found.numbers[:2]
    between = ~alone & (held.mu <= theory.critical_friction(held.r))
    if (between & np.isfinite(held.R)).any():
        above = sample(held.deviation.where(between), held.error, held.attrs["freedom"])
        largest, place = above.largest()
        kept = int((above.value > AGREE).sum())
        reason += f" Where theory has a second stable state, R is above it at {kept} of "
        reason += f"{above.size} points, by up to {text(largest)} at {place}."
        numbers = (*numbers, ("largest R - the second stable state", largest))
    return Finding(found.verdict, reason, numbers)


def rough_from(ratio: xr.DataArray) -> dict[float, float]:
    """For each beta, the smallest mu from which on R at every r is within AGREE of R at the largest
    mu; NaN where there is none, R being unknown at the largest."""
    near = np.abs(ratio - ratio.isel(mu=-1)) <= AGREE
    near = near.all("r")
    smallest = {}
    for beta in ratio.beta.values:
        far = np.flatnonzero(~near.sel(beta=beta).values)
        first = far[-1] + 1 if far.size else 0
        smallest[float(beta)] = float(ratio.mu[first]) if first < ratio.mu.size else np.nan
    return smallest


def _or_none(mu: float) -> str:
    return f"{mu:g}" if np.isfinite(mu) else "none"


def _with_friction(gas: xr.Dataset) -> xr.Dataset:
    """The part with mu > 0: without friction spin is decoupled, and R what it was at first."""
    return gas.sel(mu=gas.mu > 0.0)


STATEMENTS = (
    Statement(
        "vibrated_friction_follows_rates",
        f"{QUOTE} [in a vibrated bed]",
        ("vibrated_friction",),
        follows_rates,
    ),
    Statement(
        "cooling_friction_follows_rates",
        f"{QUOTE} [in a cooling gas, where it is strong]",
        ("cooling_friction",),
        follows_rates_when_strong,
    ),
    Statement(
        "weak_friction_keeps_spin",
        "If rotational energy dominates, then R -> 1 [as it does in a cooling gas with weak "
        "friction]",
        ("cooling_friction",),
        keeps_spin_when_weak,
    ),
)
