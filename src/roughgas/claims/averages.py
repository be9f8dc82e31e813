"""Judges of Lun's formula as it was derived: for R averaged over collisions."""

import numpy as np
import xarray as xr

from roughgas import theory
from roughgas.claims.evidence import (
    NotTestedError,
    Sample,
    deviation,
    deviation_at_shares,
    sample,
    spin_shares,
)
from roughgas.claims.paper import INTERMEDIATE
from roughgas.claims.verdicts import (
    Finding,
    agreement,
    agreement_in_proportion,
    grade,
    points,
    text,
    worse,
)

MOST = 0.5
"""Share of the excess over Lun's formula that must come from averaging to be most of it. A
convention. Fixed when R of four points at beta = 0 was known."""
WAYS = {
    "R": "for the mean of R(t)",
    "R_ratio_of_means": "for the ratio of the mean energies",
    "R_collisional": "averaged over collisions",
}


def follows_over_collisions(gas: xr.Dataset) -> Finding:
    """R averaged over collisions, minus theory, is compatible with zero at every point, also
    relative to theory."""
    return agreement_in_proportion(averaged(gas, "R_collisional"), "Lun's formula")


def excess_is_of_averaging(bed: xr.Dataset) -> Finding:
    """At intermediate beta and the lowest r the mean of R - Lun's formula is at most half as large
    averaged over collisions as for the mean of R(t); and the rest is the correlation of
    translation and rotation at contacts: R - Lun's formula at that correlation is compatible with
    zero."""
    low = float(bed.r.min())
    strong = bed.sel(r=[low], beta=np.abs(bed.beta) <= INTERMEDIATE)
    means = {name: deviation(averaged(strong, name)).mean() for name in WAYS}
    whole, left = means["R"], means["R_collisional"]
    most = whole.real and left.value <= MOST * whole.value
    beyond = agreement(beyond_correlation(bed), "Lun's formula at the correlation at contacts")
    words = ", ".join(f"{text(means[name])} {way}" for name, way in WAYS.items())
    reason = f"At |beta| <= {INTERMEDIATE:g} and r = {low:g}, R - Lun's formula is {words}. There, "
    numbers = tuple((f"R - Lun's formula {way}", means[name]) for name, way in WAYS.items())
    verdict = worse(grade(bool(most), left.value < whole.value), beyond.verdict)
    return Finding(verdict, reason + beyond.reason, numbers + beyond.numbers)


def follows_its_share(driven: xr.Dataset) -> Finding:
    """R - the rate equations, at the measured share of rotation, is compatible with zero."""
    found = agreement(deviation_at_shares(driven), "the rate equations at the measured share")
    shares = spin_shares(driven)
    low, high, taken = float(shares.min()), float(shares.max()), int((shares < 0).sum())
    found = found.with_note(f"The share is from {low:.3f} to {high:.3f}.")
    return found.with_note(f"At {points(taken)} rotation is taken out.") if taken else found


def averaged(gas: xr.Dataset, name: str) -> xr.Dataset:
    """Return the data with R, in a steady state, averaged in another way."""
    if name not in gas:
        raise NotTestedError(f"the dataset holds no {name}")
    ratio = gas[name].where(np.isfinite(gas.R))
    dof = gas.get(f"{name}_dof", gas.n_seeds - 1.0)
    return gas.assign(R=ratio, R_stderr=gas[f"{name}_stderr"], R_dof=dof)


def beyond_correlation(gas: xr.Dataset) -> Sample:
    """Return R averaged over collisions minus Lun's formula at the correlation at contacts.

    The errors are those of R: of the difference, whose two parts err together, they are bounds.
    """
    found = averaged(gas, "R_collisional")
    beta, correlation = xr.broadcast(gas.beta, gas.contact_correlation.where(np.isfinite(found.R)))
    known = np.nan_to_num(correlation.values)
    expected = theory.correlated_ratio(beta.values, gas.attrs["inertia"], known)
    gap = found.R - correlation.copy(data=expected).transpose(*found.R.dims)
    return sample(gap, found.R_stderr, found.R_dof)
