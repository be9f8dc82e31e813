"""Judges of statements on mixtures: R and temperatures by species, and radii that are spread."""

import numpy as np
import xarray as xr

from roughgas.judging import (
    AGREE_RELATIVE,
    DISAGREE_RELATIVE,
    EXCEPTIONS,
    FAILS,
    Finding,
    NotTestedError,
    Sample,
    agreement,
    check_power,
    combined_finding,
    difference,
    grade,
    sample,
    species_at,
    text,
    third_axis,
    worst_verdict,
)

EQUAL_RADII = 0.0
"""Deviation of radii of a gas of equal disks."""


def species_follow_lun(*beds: xr.Dataset) -> Finding:
    """R of each species - Lun's formula for mixtures, from the measured translational temperatures
    of the species, is compatible with zero."""
    return combined_finding(
        (bed.attrs["experiment"], _judge_ratios(bed, "Lun's formula")) for bed in beds
    )


def species_follow_cooling_theory(*gases: xr.Dataset) -> Finding:
    """R of each species - the theory of free cooling of mixtures is compatible with zero; and
    T_2/T_1 of the two species is within 10 % of theory's at nine points of ten or more."""
    return combined_finding((gas.attrs["experiment"], _judge_cooling(gas)) for gas in gases)


def spread_changes_nothing(*gases: xr.Dataset) -> Finding:
    """R of disks with spread radii - R of disks that are alike is compatible with zero.

    Deviations are compared one by one, since the errors of equal disks are common to them.
    """
    findings = []
    for gas in gases:
        if EQUAL_RADII not in gas.deviation or gas.deviation.size < 2:
            raise NotTestedError("the sweep does not hold disks that are alike and others")
        alike = gas.sel(deviation=EQUAL_RADII)
        for spread in (x for x in gas.deviation.values if x != EQUAL_RADII):
            name = f"{gas.attrs['experiment']}, radii spread by {spread:.0%}"
            shift = difference(gas.sel(deviation=spread), alike)
            findings.append((name, agreement(shift, "R of equal disks")))
    return combined_finding(findings)


def temperature_ratio(gas: xr.Dataset) -> Sample:
    """Return T_2/T_1 of two species over its value in theory, minus 1."""
    T_tr = _theory_of_species(gas, "T_tr")
    expected = T_tr / T_tr.isel(species=0)
    second = [gas[f"T_ratio_species{end}"] / expected for end in ("", "_stderr")]
    relative, error = (
        values.where(np.isfinite(gas.R)).isel(species=1, drop=True) for values in second
    )
    return sample(relative - 1, error, gas.n_seeds - 1.0)


def _judge_cooling(gas: xr.Dataset) -> Finding:
    ratios, relative = (
        _judge_ratios(gas, "the theory of free cooling of mixtures"),
        temperature_ratio(gas),
    )
    off, vague = relative.off(AGREE_RELATIVE), relative.vague(AGREE_RELATIVE)
    far = relative.off(DISAGREE_RELATIVE)
    verdict = grade(
        off.mean() <= EXCEPTIONS and vague.mean() <= EXCEPTIONS, far.mean() <= EXCEPTIONS
    )
    largest, location = relative.largest()
    reason = (
        f"T_2/T_1 is within {AGREE_RELATIVE:.0%} of theory at {int((~off).sum())} of "
        f"{relative.size} points; "
        f"the largest difference is {text(largest)} of it at {location}."
    )
    finding = ratios.with_note(reason)
    numbers = (*finding.numbers, ("largest difference of T_2/T_1 over theory", largest))
    verdict = worst_verdict(finding.verdict, verdict)
    if verdict != FAILS:
        check_power(relative.detectable(), DISAGREE_RELATIVE)
    return Finding(verdict, finding.reason, numbers, finding.detectable)


def _judge_ratios(gas: xr.Dataset, theory: str) -> Finding:
    """Judge R of each species against theory."""
    expected = _theory_of_species(gas, "R")
    gap = (gas.R_species - expected).where(np.isfinite(gas.R))
    dof = (gas.n_seeds - 1.0).broadcast_like(gap).transpose(*gap.dims)
    return agreement(sample(gap, gas.R_species_stderr, dof), theory)


def _theory_of_species(gas: xr.Dataset, name: str) -> xr.DataArray:
    """Return a temperature of all species, or their R, from theory, in the shape of R_species."""
    if "R_species" not in gas:
        raise NotTestedError("the dataset holds no species")
    swept = third_axis(gas.attrs)
    template = gas.R_species.transpose(..., "species")
    values = np.empty(template.shape)
    for index in np.ndindex(template.shape[:-1]):
        indices = dict(zip(template.dims[:-1], index, strict=True))
        point = gas.isel(indices)
        parameters = {
            axis: float(point[axis]) for axis in ("r", "beta", *([swept] if swept else []))
        }
        state = species_at(gas.attrs, parameters, 2 * point.E_trans_species.values)
        values[index] = getattr(state, name)
    return template.copy(data=values).transpose(*gas.R_species.dims)
