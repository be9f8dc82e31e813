"""Statements on the vibrated bed with periodic sides (Fig. 1a)."""

import numpy as np
import xarray as xr

from roughgas.claims.evidence import NotTestedError, deviation, effect_of_restitution, sample
from roughgas.claims.finding import HOLDS, QUALIFIED, Finding, Statement, agreement, tendency, text
from roughgas.claims.statistics import Estimate, Sample

INTERMEDIATE = 0.5
"""|beta| up to which tangential dissipation, which goes like 1 - beta^2, is strong."""


def follows_lun(bed: xr.Dataset) -> Finding:
    """R - Eq. (lun) at every point is as good as zero."""
    return agreement(deviation(bed), "Eq. (lun)")


def independent_of_restitution(bed: xr.Dataset) -> Finding:
    """R at the lowest r - R at the highest is as good as zero at every beta."""
    return agreement(effect_of_restitution(bed), "no dependence on r")


def theory_underestimates(bed: xr.Dataset) -> Finding:
    """The mean of R - Eq. (lun) at intermediate beta is positive at the lowest r, and larger there
    than at the highest r."""
    means = _mean_deviations(bed)
    (low, strong), (high, weak) = means[0], means[-1]
    growth = strong.minus(weak)
    numbers = tuple((f"mean R - Eq. (lun) at r = {r:g}", mean) for r, mean in means)
    reason = f"At |beta| <= {INTERMEDIATE:g}, R - Eq. (lun) is {text(strong)} at r = {low:g}"
    if low == high:
        grows = False
        reason += "; no other r to compare with."
    else:
        grows = growth.real and growth.value > 0
        reason += f" and {text(weak)} at r = {high:g}; the difference is {text(growth)}."
        numbers += (("growth from the highest r to the lowest", growth),)
    verdict = tendency(strong)
    verdict = QUALIFIED if verdict == HOLDS and not grows else verdict
    return Finding(verdict, reason, numbers)


def equipartition_when_rough(bed: xr.Dataset, sheared: xr.Dataset) -> Finding:
    """At beta = 1 the forced gases have R = 1/2."""
    both = _beyond_half(bed).joined(_beyond_half(sheared))
    return agreement(both, "1/2 at beta = 1")


def _beyond_half(data: xr.Dataset) -> Sample:
    """R - 1/2 at beta = 1."""
    rough = data.where(data.beta == 1.0)
    return sample(rough.R - 0.5, rough.error, data.attrs["freedom"])


def _mean_deviations(bed: xr.Dataset) -> list[tuple[float, Estimate]]:
    """Mean R - Eq. (lun) over intermediate beta, for each r that has data, in ascending r."""
    means = []
    for r in bed.r.values:
        here = bed.sel(r=[r], beta=np.abs(bed.beta) <= INTERMEDIATE)
        if np.isfinite(here.deviation).any():
            means.append((float(r), deviation(here).mean()))
    if not means:
        raise NotTestedError(f"no point with |beta| <= {INTERMEDIATE:g} in a steady state")
    return means


STATEMENTS = (
    Statement(
        "vibrated_follows_lun",
        "we expect that the results will satisfy Eq. (lun). Fig. 1(a) confirms that this is "
        "indeed the case",
        ("vibrated",),
        follows_lun,
    ),
    Statement(
        "vibrated_independent_of_r",
        "a function independent of r [...] Both of these processes depend only on beta and q but "
        "not on r",
        ("vibrated",),
        independent_of_restitution,
    ),
    Statement(
        "theory_underestimates",
        "besides some systematic underestimation of R by the theory when the dissipation is strong",
        ("vibrated",),
        theory_underestimates,
    ),
    Statement(
        "forced_equipartition",
        "R(beta=1)=1/2, i.e. equipartition holds",
        ("vibrated", "sheared"),
        equipartition_when_rough,
    ),
)
