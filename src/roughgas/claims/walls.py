"""Statements on the vibrated bed between side walls (Fig. 1b)."""

import numpy as np
import xarray as xr

from roughgas.claims.evidence import NotTestedError, difference, sample
from roughgas.claims.finding import (
    AGREE,
    FAILS,
    HOLDS,
    QUALIFIED,
    Finding,
    Statement,
    agreement,
    tendency,
    text,
)
from roughgas.claims.statistics import SIGNIFICANT

BED = "vibrated"
ROUGH = "vibrated_rough_walls"
PARTICLE = "vibrated_particle_walls"
SMOOTH = "vibrated_smooth_walls"


def only_rough_walls_matter(
    bed: xr.Dataset, rough: xr.Dataset, particle: xr.Dataset, smooth: xr.Dataset
) -> Finding:
    """R with rough elastic walls differs from R without walls; with the other walls it does not."""
    shift = difference(rough, bed)
    largest, place = shift.largest()
    reason = f"Rough elastic walls shift R by up to {text(largest)} at {place}"
    numbers = [("largest shift by rough elastic walls", largest)]
    verdict = HOLDS if largest.real and abs(largest.value) > AGREE else FAILS
    for name, data in (("particle-like", particle), ("smooth", smooth)):
        other = difference(data, bed)
        still, where = other.largest()
        reason += f", {name} ones by up to {text(still)} at {where}"
        numbers.append((f"largest shift by {name} walls", still))
        if verdict != FAILS and agreement(other, "R without walls").verdict != HOLDS:
            verdict = QUALIFIED if other.rms() < shift.rms() / 3 else FAILS
    return Finding(verdict, reason + ".", tuple(numbers))


def smooth_walls_change_nothing(bed: xr.Dataset, smooth: xr.Dataset) -> Finding:
    """R with smooth elastic walls - R without walls is as good as zero."""
    return agreement(difference(smooth, bed), "R without walls")


def particle_walls_change_nothing(bed: xr.Dataset, particle: xr.Dataset) -> Finding:
    """R with walls of the particles' own (r, beta) - R without walls is as good as zero."""
    return agreement(difference(particle, bed), "R without walls")


def rough_walls_push_to_half(bed: xr.Dataset, rough: xr.Dataset) -> Finding:
    """Rough elastic walls raise R wherever it is below 1/2 without walls."""
    below = bed.where(bed.R < 0.5 - AGREE)
    shift = difference(rough, below)
    mean = shift.mean()
    down = int(((shift.sigma() <= -SIGNIFICANT) & (shift.value < -AGREE)).sum())
    reason = (
        f"The mean shift of R by the walls is {text(mean)} where R < 1/2 without them; "
        f"R falls at {down} of {shift.size} points."
    )
    verdict = tendency(mean)
    if verdict == HOLDS and down:
        verdict = QUALIFIED
    return Finding(verdict, reason, (("mean shift", mean),))


def above_half_at_smooth_particles(rough: xr.Dataset) -> Finding:
    """At beta = -1 with rough elastic walls, R - 1/2 is positive."""
    if not np.any(rough.beta == -1.0):
        raise NotTestedError("the sweep does not reach beta = -1")
    here = rough.sel(beta=[-1.0])
    mean = sample(here.R - 0.5, here.error, rough.attrs["freedom"]).mean()
    reason = f"R - 1/2 at beta = -1 is {text(mean)}."
    return Finding(tendency(mean), reason, (("R - 1/2 at beta = -1", mean),))


STATEMENTS = (
    Statement(
        "only_rough_walls_matter",
        "only the first type of wall [perfectly rough, r = beta = 1] causes R to deviate "
        "significantly",
        (BED, ROUGH, PARTICLE, SMOOTH),
        only_rough_walls_matter,
    ),
    Statement(
        "rough_walls_push_to_half",
        "The collisions with the wall in case (i) push R towards R(beta=1)=1/2",
        (BED, ROUGH),
        rough_walls_push_to_half,
    ),
    Statement(
        "rough_walls_above_half",
        "At beta_p=-1, R>1/2",
        (ROUGH,),
        above_half_at_smooth_particles,
    ),
    Statement(
        "particle_walls_change_nothing",
        "In case (ii), both types of collisions push R towards the same value",
        (BED, PARTICLE),
        particle_walls_change_nothing,
    ),
    Statement(
        "smooth_walls_change_nothing",
        "in case (iii), the particle-wall collisions do not influence R, so that the results are "
        "not perturbed at all",
        (BED, SMOOTH),
        smooth_walls_change_nothing,
    ),
)
