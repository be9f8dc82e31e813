"""Statements on the sheared gas (Fig. 2a)."""

import math

import numpy as np
import xarray as xr

from roughgas.claims.evidence import NotTestedError, deviation, unsubtracted_deviation
from roughgas.claims.finding import FAILS, HOLDS, QUALIFIED, Finding, Statement, agreement
from roughgas.claims.statistics import SIGNIFICANT, Estimate

TIMES_OF_PAPER = (5000.0, 2000.0)
"""How long the paper averages, in T: sheared and vibrated."""
LENGTHS = {
    "paper": "at the paper's averaging times",
    "time": "at equal times",
    "collision": "at equal numbers of collisions",
}
"""For runs how long two scatters are compared."""
CONSIDERABLY = 1.5
"""Ratio of two errors from which one is considerably larger."""


def follows_lun(sheared: xr.Dataset) -> Finding:
    """R - Eq. (lun), mean flow and mean spin removed, is as good as zero."""
    return agreement(deviation(sheared), "Eq. (lun)")


def fails_unsubtracted(sheared: xr.Dataset) -> Finding:
    """R - Eq. (lun), nothing removed, is not as good as zero, and worse than after removal."""
    direct, removed = unsubtracted_deviation(sheared), deviation(sheared)
    found = agreement(direct, "Eq. (lun)")
    verdict = {HOLDS: FAILS, QUALIFIED: QUALIFIED, FAILS: HOLDS}[found.verdict]
    if direct.rms() <= removed.rms():
        verdict = FAILS
    reason = f"With nothing removed, {found.reason} The rms difference is {direct.rms():.4f}"
    reason += f" before and {removed.rms():.4f} after removal of the mean flow and the mean spin."
    return found._replace(verdict=verdict, reason=reason)


def noisier_than_vibration(sheared: xr.Dataset, bed: xr.Dataset) -> Finding:
    """The scatter of R between runs as long as the paper's is larger under shear.

    Measured as the mean over common points of ln(scatter sheared / scatter vibrated), each scatter
    brought from the measured time to the paper's by its square root; the error of that mean is
    from its own scatter over the points.
    """
    logs = {name: _log_scatter_ratio(sheared, bed, name) for name in LENGTHS}
    numbers = tuple((f"ln(scatter sheared / vibrated) {LENGTHS[n]}", logs[n]) for n in LENGTHS)
    verdict = FAILS
    if logs["paper"].real and logs["paper"].value > 0:
        verdict = HOLDS if logs["paper"].value >= math.log(CONSIDERABLY) else QUALIFIED
    elif logs["time"].real and logs["time"].value > 0:
        verdict = QUALIFIED
    elif logs["paper"].value + SIGNIFICANT * logs["paper"].error > math.log(CONSIDERABLY):
        raise NotTestedError(f"the ratio of scatters, {_ratio(logs['paper'])}, is too uncertain")
    ratios = (f"{_ratio(logs[name])} {LENGTHS[name]}" for name in LENGTHS)
    reason = (
        f"The scatter between sheared runs is that between vibrated ones times {', '.join(ratios)}"
    )
    reason += f"; the first differs from 1 by {abs(logs['paper'].sigma):.1f} sigma."
    return Finding(verdict, reason, numbers)


def _ratio(log: Estimate) -> str:
    """A logarithm as the ratio that it stands for."""
    ratio = math.exp(log.value)
    return f"{ratio:.2f} ± {ratio * log.error:.2f}"


def _log_scatter_ratio(sheared: xr.Dataset, bed: xr.Dataset, per: str) -> Estimate:
    """Mean of ln(scatter sheared / scatter vibrated) for runs as long as `per` says."""
    one, two = xr.align(_scatter(sheared), _scatter(bed), join="inner")
    logs = np.log(one.scatter / two.scatter)
    if per in ("paper", "time"):
        logs = logs + np.log(one.measured_for / two.measured_for) / 2
    if per == "paper":
        logs = logs - math.log(TIMES_OF_PAPER[0] / TIMES_OF_PAPER[1]) / 2
    if per == "collision":
        logs = logs + np.log(one.per_run / two.per_run) / 2
    logs = logs.values[np.isfinite(logs.values)]
    if logs.size < 3:
        raise NotTestedError("fewer than three common points have several seeds and a steady state")
    error = float(logs.std(ddof=1)) / math.sqrt(logs.size)
    return Estimate(float(logs.mean()), error, logs.size - 1)


def _scatter(data: xr.Dataset) -> xr.Dataset:
    """Standard deviation of R between runs (NaN for one seed), their length and collisions."""
    seeds = data.n_seeds.where((data.n_seeds > 1) & np.isfinite(data.R))
    scatter = data.R_stderr_over_seeds * np.sqrt(seeds)
    per_run = data.collisions / seeds
    return xr.Dataset(
        {
            "scatter": scatter.where(scatter > 0),
            "measured_for": data.measured_for,
            "per_run": per_run.where(per_run > 0),
        }
    )


STATEMENTS = (
    Statement(
        "sheared_follows_lun",
        "if we interpret E_rot and E_trans to be the energy which remains after removing the mean "
        "flow and rotation, the agreement between theory and simulation is good",
        ("sheared",),
        follows_lun,
    ),
    Statement(
        "shear_fails_unsubtracted",
        "A direct application of Eq. (lun) will fail, because the boundary conditions generate "
        "both an average flow and an average rotation",
        ("sheared",),
        fails_unsubtracted,
    ),
    Statement(
        "shear_noisier",
        "Even with longer averaging times (5000T in our simulations), the data is considerable "
        "noisier than in Fig. 1",
        ("sheared", "vibrated"),
        noisier_than_vibration,
    ),
)
