"""Agreement where R spans decades: a small R must follow theory in proportion, too."""

import numpy as np
import xarray as xr

from roughgas.claims.evidence import deviation, sample
from roughgas.claims.finding import (
    FAILS,
    FEW,
    HOLDS,
    QUALIFIED,
    Finding,
    agreement,
    points,
    text,
    worse,
)
from roughgas.claims.statistics import SIGNIFICANT, Sample

NEAR = 0.1
"""Fraction of R up to which a value agrees with theory in proportion."""
FAR = 0.5
"""Fraction beyond which it disagrees; between the two, agreement is qualified."""


def agreement_in_proportion(gas: xr.Dataset, theory: str) -> Finding:
    """Whether R - theory is as good as zero, and so it is over theory, but at a few points."""
    gap = deviation(gas)
    found = agreement(gap, theory)
    expected = sample(gas.theory.where(np.isfinite(gas.R)), gas.error, gap.freedom).value
    relative = Sample(gap.places, gap.value / expected, gap.error / expected, gap.freedom)
    size, real = np.abs(relative.value), np.abs(relative.sigma()) >= SIGNIFICANT
    off, far, vague = real & (size > NEAR), real & (size > FAR), ~real & (size > NEAR)
    verdict = QUALIFIED if off.mean() > FEW or vague.mean() > FEW else HOLDS
    verdict = FAILS if far.mean() > FEW else verdict
    reason = f"{found.reason} In proportion, {int((size <= NEAR).sum())} of {gap.size} points are "
    reason += f"within {NEAR:.0%}"
    numbers = found.numbers
    if off.any():
        largest, place = relative.where(off).largest()
        reason += f"; the largest significant difference is {text(largest)} of {theory} at {place}"
        numbers += ((f"largest significant difference over {theory}", largest),)
    if vague.any():
        reason += f"; at {vague.sum()} {points(vague.sum())} the errors are too large to tell"
    return Finding(worse(found.verdict, verdict), f"{reason}.", numbers)
