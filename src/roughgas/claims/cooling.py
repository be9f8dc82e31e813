"""Statements on the freely cooling gas (Fig. 2b), and on what forcing changes."""

import numpy as np
import xarray as xr

from roughgas.claims.evidence import (
    NotTestedError,
    deviation,
    difference,
    effect_of_restitution,
    sample,
)
from roughgas.claims.finding import (
    AGREE,
    FAILS,
    FEW,
    HOLDS,
    LIMIT,
    QUALIFIED,
    Finding,
    Statement,
    agreement,
    text,
    worse,
)
from roughgas.claims.statistics import Sample
from roughgas.theory.prediction import predicted_ratio

NEAR = 0.08
"""Fraction of R by which points are counted as near Eq. (K)."""


def follows_k(cooling: xr.Dataset) -> Finding:
    """R - Eq. (K) at every point is as good as zero."""
    gap = deviation(cooling)
    theory = sample(cooling.theory.where(np.isfinite(cooling.R)), cooling.error, np.inf).value
    relative = gap.value / theory
    index = int(np.argmax(np.abs(relative)))
    found = agreement(gap, "Eq. (K)")
    place = gap.place(index)
    near = int((np.abs(relative) <= NEAR).sum())
    note = f" Relative to Eq. (K), {near} of {gap.size} points are within {NEAR:.0%}; the largest "
    note += f"difference is {100 * relative[index]:+.1f} % at {place}."
    return found._replace(reason=found.reason + note)


def reaches_a_constant(cooling: xr.Dataset) -> Finding:
    """R has a plateau, and does not move from its first half to its second."""
    if "R_drift" not in cooling:
        raise NotTestedError("the dataset holds no time series of R")
    steady = cooling.R_drift.where(np.isfinite(cooling.R))
    freedom = float(max(cooling.n_seeds.max() - 1, 1))
    found = agreement(sample(steady, cooling.R_drift_stderr, freedom), "no drift on the plateau")
    total = cooling.attrs["points"]
    plateaus = total - cooling.attrs["set_aside"]
    share = 1 - plateaus / total
    reason = f"A plateau was found at {plateaus} of {total} points. There, {found.reason}"
    missing = HOLDS if share <= FEW else QUALIFIED if share <= 0.5 else FAILS
    return found._replace(verdict=worse(found.verdict, missing), reason=reason)


def depends_on_restitution(cooling: xr.Dataset) -> Finding:
    """R at the lowest r - R at the highest is far from zero at some beta."""
    effect = effect_of_restitution(cooling)
    largest, _ = effect.largest()
    verdict = FAILS
    if largest.real and abs(largest.value) > AGREE:
        verdict = HOLDS if abs(largest.value) > LIMIT else QUALIFIED
    low, high = cooling.r.values[[0, -1]]
    beta = effect.places["beta"]
    curves = [predicted_ratio(cooling.attrs, r, beta) for r in (low, high)]
    expected = curves[0] - curves[1]
    at = int(np.argmax(np.abs(effect.value)))
    reason = (
        f"R at r = {low:g} differs from R at r = {high:g} by up to {text(largest)} at "
        f"beta = {beta[at]:g}, where Eq. (K) expects {expected[at]:+.4f}."
    )
    numbers = (("largest difference", largest), ("mean difference", effect.mean()))
    return Finding(verdict, reason, numbers)


def forcing_decides(cooling: xr.Dataset, bed: xr.Dataset) -> Finding:
    """R cooling - R vibrated is far from zero and is what Eq. (K) - Eq. (lun) says."""
    change = difference(cooling, bed)
    one, two = xr.align(cooling, bed, join="inner")
    expected = sample((one.theory - two.theory).where(np.isfinite(one.R - two.R)), one.error, 1)
    rest = change._replace(value=change.value - expected.value)
    found = agreement(rest, "the difference of the two theories")
    largest, place = change.largest()
    if not (largest.real and abs(largest.value) > LIMIT):
        found = found._replace(verdict=FAILS)
    elif found.verdict == FAILS and rest.rms() < change.rms() / 3:
        found = found._replace(verdict=QUALIFIED)
    reason = f"R cooling - R vibrated is up to {text(largest)} at {place}. {found.reason}"
    numbers = (("largest R cooling - R vibrated", largest), *found.numbers)
    return found._replace(reason=reason, numbers=numbers)


def restitution_matters_when_cooling(cooling: xr.Dataset, bed: xr.Dataset) -> Finding:
    """The effect of r on R is several times larger in the cooling gas than in the vibrated one."""
    r = np.intersect1d(cooling.r, bed.r)
    effects = [effect_of_restitution(data.sel(r=r)) for data in (cooling, bed)]
    largest, _ = effects[0].largest()
    forced, _ = effects[1].largest()
    ratio = _rms_beyond_noise(effects[0]) / max(_rms_beyond_noise(effects[1]), 1e-12)
    verdict = FAILS
    if largest.real and abs(largest.value) > AGREE and ratio > 1.5:
        verdict = HOLDS if ratio >= 3 else QUALIFIED
    times = f"{ratio:.1f} times as large" if ratio < 100 else "more than 100 times as large"
    reason = (
        f"From the highest r to the lowest, R changes by up to {text(largest)} when cooling, by up "
        f"to {text(forced)} when vibrated; the rms change, noise removed, is {times}."
    )
    numbers = (("largest effect of r, cooling", largest), ("largest effect, vibrated", forced))
    return Finding(verdict, reason, numbers)


def _rms_beyond_noise(effect: Sample) -> float:
    """Root mean square of the values, the part that their errors explain taken out."""
    return float(np.sqrt(max(np.mean(effect.value**2 - effect.error**2), 0.0)))


STATEMENTS = (
    Statement(
        "cooling_reaches_a_constant",
        "Although the energy decreases with every collision, R approaches the constant value shown "
        "in the graph",
        ("cooling",),
        reaches_a_constant,
    ),
    Statement(
        "cooling_follows_k",
        "The theoretical curves are the solutions of Eq. (K) [...] the agreement between theory "
        "and simulations is encouraging",
        ("cooling",),
        follows_k,
    ),
    Statement(
        "cooling_depends_on_r",
        "As soon as the dissipation of E_trans starts to play a role in determining R, then r will "
        "appear",
        ("cooling",),
        depends_on_restitution,
    ),
    Statement(
        "forcing_decides",
        "the differences between Eqs. (lun) and (Goldshtein) arise from the boundary conditions, "
        "i.e. from the existence of external forcing",
        ("cooling", "vibrated"),
        forcing_decides,
    ),
    Statement(
        "restitution_matters_when_cooling",
        "In stationary flows, this ratio depends mainly on the particle roughness, but in "
        "[...] freely cooling granular media, it also depends strongly on the normal dissipation",
        ("cooling", "vibrated"),
        restitution_matters_when_cooling,
    ),
)
