"""What floors and walls are made of: R leaves Eq. (lun) where they put in rotation, only there."""

import numpy as np
import xarray as xr

from roughgas.claims.evidence import NotTestedError, deviation, difference, sample, spin_shares
from roughgas.claims.finding import (
    AGREE,
    FAILS,
    HOLDS,
    QUALIFIED,
    Finding,
    Statement,
    agreement,
    points,
    text,
    worse,
)
from roughgas.claims.statistics import SIGNIFICANT, Estimate

SMOOTH = -1.0
"""Roughness of a boundary that puts no rotation in: the bed that the others are compared with."""
NO_ROTATION = 0.003
"""Share of rotation up to which a drive puts in translation alone: less than AGREE of R even where
beta = -0.95, r = 0.9, which responds strongly, R - Eq. (lun) being 6 times the share."""


def only_rotation_matters(bed: xr.Dataset) -> Finding:
    """R with rough boundaries differs from R with smooth ones where they put in rotation; where
    they do not, the difference is as good as zero."""
    if SMOOTH not in bed.roughness:
        raise NotTestedError(f"the sweep does not reach roughness = {SMOOTH:g}")
    shares, _ = spin_shares(bed)
    rough = (bed.roughness > SMOOTH) & np.isfinite(shares)
    spinning = np.abs(shares) >= NO_ROTATION
    smooth = bed.sel(roughness=SMOOTH, drop=True)
    if not (rough & spinning).any():
        raise NotTestedError(f"no boundary puts in {NO_ROTATION:g} of rotation")
    shift = difference(bed.where(rough & spinning), smooth)
    largest, place = shift.largest()
    off = int(((np.abs(shift.sigma()) >= SIGNIFICANT) & (np.abs(shift.value) > AGREE)).sum())
    reason = (
        f"Where the share of rotation is {NO_ROTATION:g} or more in size, R is shifted by more "
        f"than {AGREE:g} at {off} of {shift.size} {points(shift.size)}, by up to {text(largest)} "
        f"at {place}. "
    )
    verdict, rest, number = _elsewhere(bed.where(rough & ~spinning), smooth)
    verdict = worse(verdict, HOLDS if off else FAILS)
    numbers = [("largest shift where rotation is put in", largest), *number, *_roughest(bed)]
    return Finding(verdict, reason + rest, tuple(numbers))


def _elsewhere(
    still: xr.Dataset, smooth: xr.Dataset
) -> tuple[str, str, list[tuple[str, Estimate]]]:
    """Verdict, reason and number of rough boundaries that put in translation alone."""
    if not np.isfinite(still.R).any():
        return QUALIFIED, "All rough boundaries put in that much; smooth ones put in none.", []
    rest = difference(still, smooth)
    largest, place = rest.largest()
    reason = f"Where the share is smaller, by up to {text(largest)} at {place}."
    verdict = agreement(rest, "R with smooth boundaries").verdict
    return verdict, reason, [("largest shift where none is put in", largest)]


def _roughest(bed: xr.Dataset) -> list[tuple[str, Estimate]]:
    """R - Eq. (lun), and the share of rotation, at the largest roughness."""
    end = bed.sel(roughness=[bed.roughness.values.max()])
    gap = deviation(end)
    shares = sample(*spin_shares(end), max(float(end.n_seeds.max()) - 1, 1))
    name = f"at roughness = {end.roughness.item():g}"
    return [
        (f"largest R - Eq. (lun) {name}", gap.largest()[0]),
        (f"mean R - Eq. (lun) {name}", gap.mean()),
        (f"largest share of rotation {name}", shares.largest()[0]),
        (f"mean share of rotation {name}", shares.mean()),
    ]


STATEMENTS = (
    Statement(
        "only_spinning_floors_matter",
        "Eq. (lun) will apply whenever the forcing adds only translational energy [and only then: "
        "floors of any roughness]",
        ("floor_materials",),
        only_rotation_matters,
    ),
    Statement(
        "only_spinning_walls_matter",
        "only the first type of wall [perfectly rough] causes R to deviate significantly [walls "
        "of any roughness]",
        ("wall_materials",),
        only_rotation_matters,
    ),
)
