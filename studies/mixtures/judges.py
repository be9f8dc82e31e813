"""Judges of statements on mixtures: R and temperatures by species, and radii that are spread."""

import numpy as np
import xarray as xr

from roughgas.judging import (
    FAR,
    FEW,
    NEAR,
    Finding,
    NotTestedError,
    Sample,
    agreement,
    difference,
    grade,
    sample,
    species_at,
    text,
    third_axis,
    together,
    worse,
)

ALIKE = 0.0
"""Deviation of the radii of disks that are all alike."""


def species_follow_lun(*beds: xr.Dataset) -> Finding:
    """R of each species - Lun's formula for mixtures, from the measured translational temperatures
    of the species, is compatible with zero."""
    return together((bed.attrs["experiment"], _ratios(bed, "Lun's formula")) for bed in beds)


def species_follow_cooling_theory(*gases: xr.Dataset) -> Finding:
    """R of each species - the theory of free cooling of mixtures is compatible with zero; and
    T_2/T_1 of the two species is within 10 % of theory's at nine points of ten or more."""
    return together((gas.attrs["experiment"], _cooling(gas)) for gas in gases)


def spread_changes_nothing(*gases: xr.Dataset) -> Finding:
    """R of disks with spread radii - R of disks that are alike is compatible with zero.

    Deviations are compared one by one, since the errors of equal disks are common to them.
    """
    found = []
    for gas in gases:
        if ALIKE not in gas.deviation or gas.deviation.size < 2:
            raise NotTestedError("the sweep does not hold disks that are alike and others")
        alike = gas.sel(deviation=ALIKE)
        for spread in (x for x in gas.deviation.values if x != ALIKE):
            name = f"{gas.attrs['experiment']}, radii spread by {spread:.0%}"
            shift = difference(gas.sel(deviation=spread), alike)
            found.append((name, agreement(shift, "R of equal disks")))
    return together(found)


def temperature_ratio(gas: xr.Dataset) -> Sample:
    """Return T_2/T_1 of two species over that of theory, minus 1."""
    T_tr = _of_theory(gas, "T_tr")
    expected = T_tr / T_tr.isel(species=0)
    second = [gas[f"T_ratio_species{end}"] / expected for end in ("", "_stderr")]
    relative, error = (one.where(np.isfinite(gas.R)).isel(species=1, drop=True) for one in second)
    return sample(relative - 1, error, gas.n_seeds - 1.0)


def _cooling(gas: xr.Dataset) -> Finding:
    ratios, relative = (
        _ratios(gas, "the theory of free cooling of mixtures"),
        temperature_ratio(gas),
    )
    off, vague = relative.off(NEAR), relative.vague(NEAR)
    far = relative.off(FAR)
    verdict = grade(off.mean() <= FEW and vague.mean() <= FEW, far.mean() <= FEW)
    largest, place = relative.largest()
    reason = (
        f"T_2/T_1 is within {NEAR:.0%} of theory at {int((~off).sum())} of {relative.size} points; "
        f"the largest difference is {text(largest)} of it at {place}."
    )
    found = ratios.with_note(reason)
    numbers = (*found.numbers, ("largest difference of T_2/T_1 over theory", largest))
    return Finding(worse(found.verdict, verdict), found.reason, numbers)


def _ratios(gas: xr.Dataset, theory: str) -> Finding:
    """Judge R of each species beside theory."""
    expected = _of_theory(gas, "R")
    gap = (gas.R_species - expected).where(np.isfinite(gas.R))
    dof = (gas.n_seeds - 1.0).broadcast_like(gap).transpose(*gap.dims)
    return agreement(sample(gap, gas.R_species_stderr, dof), theory)


def _of_theory(gas: xr.Dataset, name: str) -> xr.DataArray:
    """Return a temperature of all species, or their R, as theory has it, like R_species."""
    if "R_species" not in gas:
        raise NotTestedError("the dataset holds no species")
    swept = third_axis(gas.attrs)
    like = gas.R_species.transpose(..., "species")
    found = np.empty(like.shape)
    for index in np.ndindex(like.shape[:-1]):
        place = dict(zip(like.dims[:-1], index, strict=True))
        here = gas.isel(place)
        at = {one: float(here[one]) for one in ("r", "beta", *([swept] if swept else []))}
        state = species_at(gas.attrs, at, 2 * here.E_trans_species.values)
        found[index] = getattr(state, name)
    return like.copy(data=found).transpose(*gas.R_species.dims)
