"""Judges of driven gases for several studies: on R averaged over collisions, and on R at the
measured share of rotation in the energy input."""

import numpy as np
import xarray as xr

from roughgas.claims.verdicts import (
    Finding,
    NotTestedError,
    agreement,
    agreement_in_proportion,
    deviation_at_shares,
    points,
    spin_shares,
)


def averaged(gas: xr.Dataset, name: str) -> xr.Dataset:
    """Return a reduced dataset with R replaced by the average `name`, such as R_collisional.

    R = E_rot/(E_rot + E_trans) is a mean over time. Only points with a finite R keep a value. Error
    and degrees of freedom come along. Raises NotTestedError if the dataset lacks the average.
    """
    if name not in gas:
        raise NotTestedError(f"the dataset holds no {name}")
    ratio = gas[name].where(np.isfinite(gas.R))
    dof = gas.get(f"{name}_dof", gas.n_seeds - 1.0)
    return gas.assign(R=ratio, R_stderr=gas[f"{name}_stderr"], R_dof=dof)


def follows_over_collisions(gas: xr.Dataset) -> Finding:
    """Judge that R averaged over collisions follows Lun's formula, absolutely and in proportion.

    The difference from theory must be compatible with zero at every point, and, except at few
    points, also relative to theory. `gas` is a reduced dataset.
    """
    return agreement_in_proportion(averaged(gas, "R_collisional"), "Lun's formula")


def follows_its_share(driven: xr.Dataset) -> Finding:
    """Judge that R is compatible with the rate equations at the measured share of rotation.

    This is the share of rotation in the energy input; `driven` is the reduced dataset of a driven
    gas.
    """
    finding = agreement(deviation_at_shares(driven), "the rate equations at the measured share")
    shares = spin_shares(driven)
    low, high, number_negative = float(shares.min()), float(shares.max()), int((shares < 0).sum())
    finding = finding.with_note(f"The share is from {low:.3f} to {high:.3f}.")
    return (
        finding.with_note(f"At {points(number_negative)} rotation is taken out.")
        if number_negative
        else finding
    )
