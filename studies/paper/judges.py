"""Judges of the statements in claims.yaml, by subject: bed (Fig. 1a), walls (1b), shear (2a), and
cooling (2b).

Judges of Lun's formula as it was derived: for R averaged over collisions.
"""

import math

import numpy as np
import xarray as xr

from roughgas import theory
from roughgas.judging import (
    AGREE,
    AGREE_RELATIVE,
    DISAGREE,
    DISAGREE_RELATIVE,
    EXCEPTIONS,
    FAILS,
    HOLDS,
    QUALIFIED,
    SIGNIFICANCE,
    Estimate,
    Finding,
    NotTestedError,
    Sample,
    agreement,
    averaged,
    deviation,
    deviation_in_proportion,
    difference,
    effect_of_restitution,
    grade,
    is_large,
    mean_by_scatter,
    over_seeds,
    predicted_ratio,
    ratio_sample,
    sample,
    sum_error,
    t_quantile,
    tendency,
    text,
    worst_verdict,
)

INTERMEDIATE = 0.5
"""Size of beta up to which tangential dissipation, which is proportional to 1 - beta^2, is strong,
three quarters of its most. Fixed before any data."""
TIMES_OF_PAPER = (5000.0, 2000.0)
"""The paper's averaging times, in T: sheared and vibrated."""
CONSIDERABLY = math.log(1.5)
"""Logarithm of the ratio of two errors from which one is considerably larger. A convention. Fixed
before any data."""
NEAR_COOLING = 0.08
"""Fraction of R within which points are counted as near the theory of free cooling; no verdict
depends on it."""


def theory_underestimates(bed: xr.Dataset) -> Finding:
    """The mean of R - Lun's formula at intermediate beta is positive at the lowest r, and larger
    there than at the highest r."""
    middle = bed.sel(beta=np.abs(bed.beta) <= INTERMEDIATE)
    present = [float(r) for r in bed.r.values if np.isfinite(middle.R.sel(r=r)).any()]
    if not present:
        raise NotTestedError(f"no point with |beta| <= {INTERMEDIATE:g} in a steady state")
    means = [(r, deviation(middle.sel(r=[r])).mean()) for r in present]
    (low, strong), (high, weak) = means[0], means[-1]
    numbers = tuple((f"mean R - Lun's formula at r = {r:g}", mean) for r, mean in means)
    reason = f"At |beta| <= {INTERMEDIATE:g}, R - Lun's formula is {text(strong)} at r = {low:g}"
    growth = strong.minus(weak)
    if low == high:
        reason += "; no other r to compare with."
    else:
        reason += f" and {text(weak)} at r = {high:g}; the difference is {text(growth)}."
        numbers += (("growth from the highest r to the lowest", growth),)
    grows = low < high and growth.is_significant and growth.value > 0
    return Finding(worst_verdict(tendency(strong), HOLDS if grows else QUALIFIED), reason, numbers)


def beyond_half(*gases: xr.Dataset) -> Sample:
    """Return R - 1/2 at beta = 1 of two gases."""
    first, second = (ratio_sample(gas, (gas.R - 0.5).where(gas.beta == 1.0)) for gas in gases)
    return first.joined(second)


def shift(bed: xr.Dataset, walls: xr.Dataset) -> Sample:
    """Return R between walls minus R without."""
    return difference(walls, bed)


def only_rough_walls_matter(
    bed: xr.Dataset, rough: xr.Dataset, particle: xr.Dataset, smooth: xr.Dataset
) -> Finding:
    """R with rough elastic walls differs from R without walls; with the other walls it does not."""
    moved = shift(bed, rough)
    largest, location = moved.largest()
    reason = f"Rough elastic walls shift R by up to {text(largest)} at {location}"
    numbers = [("largest shift by rough elastic walls", largest)]
    verdict = HOLDS if is_large(largest, AGREE) else FAILS
    for name, data in (("particle-like", particle), ("smooth", smooth)):
        shift_by_walls = shift(bed, data)
        still, other_location = shift_by_walls.largest()
        reason += f", {name} ones by up to {text(still)} at {other_location}"
        numbers.append((f"largest shift by {name} walls", still))
        if verdict != FAILS and agreement(shift_by_walls, "R without walls").verdict != HOLDS:
            verdict = QUALIFIED if shift_by_walls.rms() < moved.rms() / 3 else FAILS
    return Finding(verdict, reason + ".", tuple(numbers))


def rough_walls_push_to_half(bed: xr.Dataset, rough: xr.Dataset) -> Finding:
    """Rough elastic walls raise R wherever it is below 1/2 without walls."""
    moved = shift(bed.where(bed.R < 0.5 - AGREE), rough)
    mean, down = moved.mean(), int((moved.off(AGREE) & (moved.value < 0)).sum())
    reason = (
        f"The mean shift of R by the walls is {text(mean)} where R < 1/2 without them; "
        f"R falls at {down} of {moved.size} points."
    )
    verdict = worst_verdict(tendency(mean), QUALIFIED if down else HOLDS)
    return Finding(verdict, reason, (("mean shift", mean),))


def above_half_at_smooth_particles(rough: xr.Dataset) -> Finding:
    """At beta = -1 with rough elastic walls, R - 1/2 is positive."""
    if not np.any(rough.beta == -1.0):
        raise NotTestedError("the sweep does not reach beta = -1")
    mean = ratio_sample(rough, (rough.R - 0.5).where(rough.beta == -1.0)).mean()
    reason = f"R - 1/2 at beta = -1 is {text(mean)}."
    return Finding(tendency(mean), reason, (("R - 1/2 at beta = -1", mean),))


def spins_have_the_vertical_energy(rough: xr.Dataset) -> Finding:
    """At beta = -1 with rough elastic walls, E_vertical/(E_vertical + E_horizontal) - 1/2 is
    positive, and spins have the vertical energy: (E_rot - E_vertical)/(E_vertical - E_horizontal),
    which is -1/2 where R = 1/2, is compatible with zero.

    The reason holds where the latter is at most AGREE_RELATIVE, and with a qualification up to
    DISAGREE_RELATIVE: below it spins have more than the mean energy of translation. Raises
    NotTestedError for errors that cannot tell this mean from the vertical energy.
    """
    if "vertical_share" not in rough:
        raise NotTestedError("the dataset holds no vertical energy")
    if not np.any(rough.beta == -1.0):
        raise NotTestedError("the sweep does not reach beta = -1")
    gas = rough.sel(beta=[-1.0])
    share = vertical_excess(gas).mean()
    vertical, spin = 2 * float(gas.vertical_share.mean()), float((gas.E_rot / gas.E_trans).mean())
    reason = (
        f"At beta = -1 E_vertical : E_rot : E_horizontal is {vertical:.3f} : {spin:.3f} : "
        f"{2 - vertical:.3f}; E_vertical/(E_vertical + E_horizontal) - 1/2 is {text(share)}"
    )
    lead = ("E_vertical/(E_vertical + E_horizontal) - 1/2", share)
    direction = tendency(share)
    if direction == FAILS:  # without anisotropy the energy of spins says nothing
        return Finding(FAILS, f"{reason}.", (lead,))
    gap = spin_gap(gas).mean()
    if not t_quantile(SIGNIFICANCE, gap.dof) * gap.stderr < DISAGREE_RELATIVE:
        raise NotTestedError(f"the errors are too large to tell the energy of spins: {text(gap)}")
    size = abs(gap.value)
    equal = grade(size <= AGREE_RELATIVE, size <= DISAGREE_RELATIVE or not gap.is_significant)
    label = "(E_rot - E_vertical)/(E_vertical - E_horizontal)"
    reason += f", {label} is {text(gap)}."
    return Finding(worst_verdict(direction, equal), reason, ((label, gap), lead), gap.detectable)


def vertical_excess(bed: xr.Dataset) -> Sample:
    """Return E_vertical/(E_vertical + E_horizontal) - 1/2 of a bed of disks in a steady state."""
    excess = (bed.vertical_share - 0.5).where(np.isfinite(bed.R))
    return sample(excess, bed.vertical_share_stderr, bed.vertical_share_dof)


def spin_gap(bed: xr.Dataset) -> Sample:
    """Return (E_rot - E_vertical)/(E_vertical - E_horizontal) of a bed of disks in a steady state.

    It is 0 where spins have the vertical energy, -1 where they have the horizontal one, and -1/2
    where R = 1/2. Its errors are the errors of R, of which E_rot/E_trans = R/(1 - R) is a function,
    and of the vertical share, as if these were independent.
    """
    spin, lean = bed.E_rot / bed.E_trans, 2.0 * bed.vertical_share - 1.0
    gap = ((spin / 2.0 - bed.vertical_share) / lean).where(np.isfinite(bed.R))
    of_spin = (1.0 + spin) ** 2 * bed.R_stderr / (2.0 * np.abs(lean))
    of_share = np.abs(1.0 - spin) / lean**2 * bed.vertical_share_stderr
    return sample(gap, *sum_error([of_spin, of_share], [bed.R_dof, bed.vertical_share_dof]))


def fails_unsubtracted(sheared: xr.Dataset) -> Finding:
    """R - Lun's formula, nothing removed, is not compatible with zero, and worse than after
    removal."""
    if "R_unsubtracted" not in sheared:
        raise NotTestedError("the dataset holds no un-subtracted R")
    gap = (sheared.R_unsubtracted - sheared.theory).where(np.isfinite(sheared.R))
    direct, removed = over_seeds(sheared, gap, "R_unsubtracted"), deviation(sheared)
    finding = agreement(direct, "Lun's formula")
    verdict = {HOLDS: FAILS, QUALIFIED: QUALIFIED, FAILS: HOLDS}[finding.verdict]
    if direct.rms() <= removed.rms():
        verdict = FAILS
    reason = f"With nothing removed, {finding.reason} The rms difference is {direct.rms():.4f}"
    reason += f" before and {removed.rms():.4f} after removal of the mean flow and the mean spin."
    return finding._replace(verdict=verdict, reason=reason)


def noisier_than_vibration(sheared: xr.Dataset, bed: xr.Dataset) -> Finding:
    """The scatter of R between runs as long as the paper's is larger under shear.

    Measured as the mean over common points of ln(scatter sheared / scatter vibrated), each scatter
    scaled from the measured time to the paper's by its square root; the error of that mean is from
    its own scatter over the points.
    """
    shear, vibration = xr.align(_scatter(sheared), _scatter(bed), join="inner")
    times = shear.measured_for / vibration.measured_for
    lengths = {
        "at the paper's averaging times": times / (TIMES_OF_PAPER[0] / TIMES_OF_PAPER[1]),
        "at equal times": times,
        "at equal numbers of collisions": shear.per_run / vibration.per_run,
    }
    ratio = shear.scatter / vibration.scatter
    logs = {name: _mean_log(ratio * np.sqrt(length)) for name, length in lengths.items()}
    paper, time, _ = logs.values()
    verdict = FAILS
    if paper.is_significant and paper.value > 0:
        verdict = HOLDS if paper.value >= CONSIDERABLY else QUALIFIED
    elif time.is_significant and time.value > 0:
        verdict = QUALIFIED
    elif not paper.detectable <= CONSIDERABLY:
        raise NotTestedError(f"the ratio of scatters, {_ratio(paper)}, is too uncertain")
    ratios = ", ".join(f"{_ratio(log)} {length}" for length, log in logs.items())
    reason = f"The scatter between sheared runs is that between vibrated ones times {ratios}"
    reason += f"; the first differs from 1 by {abs(paper.sigma):.1f} sigma."
    numbers = ((f"ln(scatter sheared / vibrated) {length}", log) for length, log in logs.items())
    return Finding(verdict, reason, tuple(numbers))


def _scatter(data: xr.Dataset) -> xr.Dataset:
    """Return the standard deviation of R between runs (NaN for one seed), and the length and
    collisions of a run."""
    seeds = data.n_seeds.where((data.n_seeds > 1) & np.isfinite(data.R))
    scatter = data.R_stderr_over_seeds * np.sqrt(seeds)
    lengths = {"measured_for": data.measured_for, "per_run": data.collisions / seeds}
    return xr.Dataset(lengths | {"scatter": scatter.where(scatter > 0)})


def _mean_log(ratios: xr.DataArray) -> Estimate:
    logs = np.log(ratios.values[np.isfinite(ratios.values)])
    if logs.size < 3:
        raise NotTestedError("fewer than three common points have several seeds and a steady state")
    return mean_by_scatter(logs)


def _ratio(log: Estimate) -> str:
    """Return the text of the ratio whose logarithm is given."""
    ratio = math.exp(log.value)
    return f"{Estimate(ratio, ratio * log.stderr):.2f}"


def follows_k(cooling: xr.Dataset) -> Finding:
    """R - the theory of free cooling at every point is compatible with zero."""
    finding = agreement(deviation(cooling), "the theory of free cooling")
    relative = deviation_in_proportion(cooling)
    near = int((np.abs(relative.value) <= NEAR_COOLING).sum())
    largest, location = relative.largest()
    return finding.with_note(
        f"Relative to the theory of free cooling, {near} of {relative.size} points are within "
        f"{NEAR_COOLING:.0%}; the largest difference is {100 * largest.value:+.1f} % at {location}."
    )


def reaches_a_constant(cooling: xr.Dataset) -> Finding:
    """R has a plateau, and does not move from its first half to its second."""
    if "R_drift" not in cooling:
        raise NotTestedError("the dataset holds no time series of R")
    steady = cooling.R_drift.where(np.isfinite(cooling.R))
    finding = agreement(over_seeds(cooling, steady, "R_drift"), "no drift on the plateau")
    total = cooling.attrs["points"]
    plateaus = total - cooling.attrs["set_aside"]
    share = 1 - plateaus / total
    reason = f"A plateau was found at {plateaus} of {total} points. There, {finding.reason}"
    verdict = worst_verdict(finding.verdict, grade(share <= EXCEPTIONS, share <= 0.5))
    return finding._replace(verdict=verdict, reason=reason)


def depends_on_restitution(cooling: xr.Dataset) -> Finding:
    """R at the lowest r - R at the highest is large at some beta."""
    effect = effect_of_restitution(cooling)
    largest, _ = effect.largest()
    considerable, large = is_large(largest, AGREE), is_large(largest, DISAGREE)
    low, high = cooling.r.values[[0, -1]]
    beta = effect.coordinates["beta"][np.argmax(np.abs(effect.value))]
    at_low, at_high = (predicted_ratio(cooling.attrs, r, beta) for r in (low, high))
    reason = (
        f"R at r = {low:g} differs from R at r = {high:g} by up to {text(largest)} at "
        f"beta = {beta:g}, where the theory of free cooling expects {at_low - at_high:+.4f}."
    )
    numbers = (("largest difference", largest), ("mean difference", effect.mean()))
    return Finding(grade(large, considerable), reason, numbers)


def forcing_decides(cooling: xr.Dataset, bed: xr.Dataset) -> Finding:
    """R cooling - R vibrated is large and is what the theory of free cooling minus
    Lun's formula says."""
    change, expected = (
        difference(*(gas.assign(R=gas[name].where(np.isfinite(gas.R))) for gas in (cooling, bed)))
        for name in ("R", "theory")
    )
    rest = change._replace(value=change.value - expected.value)
    finding = agreement(rest, "the difference of the two theories")
    largest, location = change.largest()
    if not is_large(largest, DISAGREE):
        finding = finding._replace(verdict=FAILS)
    elif finding.verdict == FAILS and rest.rms() < change.rms() / 3:
        finding = finding._replace(verdict=QUALIFIED)
    reason = f"R cooling - R vibrated is up to {text(largest)} at {location}. {finding.reason}"
    numbers = (("largest R cooling - R vibrated", largest), *finding.numbers)
    return finding._replace(reason=reason, numbers=numbers)


def restitution_matters_when_cooling(cooling: xr.Dataset, bed: xr.Dataset) -> Finding:
    """The effect of r on R is several times larger in the cooling gas than in the vibrated one."""
    r = np.intersect1d(cooling.r, bed.r)
    effects = [effect_of_restitution(gas.sel(r=r)) for gas in (cooling, bed)]
    (largest, _), (forced, _) = (effect.largest() for effect in effects)
    beyond_noise = (np.mean(effect.value**2 - effect.stderr**2) for effect in effects)
    free, driven = (float(np.sqrt(max(square, 0.0))) for square in beyond_noise)
    ratio = free / max(driven, 1e-12)
    matters = is_large(largest, AGREE)
    times = f"{ratio:.1f} times as large" if ratio < 100 else "more than 100 times as large"
    reason = (
        f"From the highest r to the lowest, R changes by up to {text(largest)} when cooling, by up "
        f"to {text(forced)} when vibrated; the rms change, noise removed, is {times}."
    )
    numbers = (("largest effect of r, cooling", largest), ("largest effect, vibrated", forced))
    return Finding(grade(matters and ratio >= 3, matters and ratio > 1.5), reason, numbers)


SHARE_FROM_AVERAGING = 0.5
"""Share of the excess over Lun's formula that must come from averaging to be most of it. A
convention. Fixed when R of four points at beta = 0 was known."""
AVERAGES = {
    "R": "for the mean of R(t)",
    "R_ratio_of_means": "for the ratio of the mean energies",
    "R_collisional": "averaged over collisions",
}


def excess_is_of_averaging(bed: xr.Dataset) -> Finding:
    """At intermediate beta and the lowest r the mean of R - Lun's formula is at most half as large
    averaged over collisions as for the mean of R(t); and the rest is the correlation of
    translation and rotation at contacts: R - Lun's formula at that correlation is compatible with
    zero."""
    low = float(bed.r.min())
    strong = bed.sel(r=[low], beta=np.abs(bed.beta) <= INTERMEDIATE)
    means = {name: deviation(averaged(strong, name)).mean() for name in AVERAGES}
    excess, remainder = means["R"], means["R_collisional"]
    mostly_averaging = (
        excess.is_significant and remainder.value <= SHARE_FROM_AVERAGING * excess.value
    )
    beyond = agreement(beyond_correlation(bed), "Lun's formula at the correlation at contacts")
    words = ", ".join(f"{text(means[name])} {average}" for name, average in AVERAGES.items())
    reason = f"At |beta| <= {INTERMEDIATE:g} and r = {low:g}, R - Lun's formula is {words}. There, "
    numbers = tuple(
        (f"R - Lun's formula {average}", means[name]) for name, average in AVERAGES.items()
    )
    verdict = worst_verdict(
        grade(bool(mostly_averaging), remainder.value < excess.value), beyond.verdict
    )
    return Finding(verdict, reason + beyond.reason, numbers + beyond.numbers)


def beyond_correlation(gas: xr.Dataset) -> Sample:
    """Return R averaged over collisions minus Lun's formula at the correlation at contacts.

    The errors are the errors of R. They are upper bounds, as both terms of the difference err
    together.
    """
    averages = averaged(gas, "R_collisional")
    beta, correlation = xr.broadcast(
        gas.beta, gas.contact_correlation.where(np.isfinite(averages.R))
    )
    correlation_values = np.nan_to_num(correlation.values)
    expected = theory.correlated_ratio(beta.values, gas.attrs["inertia"], correlation_values)
    gap = averages.R - correlation.copy(data=expected).transpose(*averages.R.dims)
    return sample(gap, averages.R_stderr, averages.R_dof)
