"""Moments of inertia other than those of uniform disks and spheres."""

import xarray as xr

from roughgas.claims.beyond.proportion import agreement_in_proportion
from roughgas.claims.finding import Finding, Statement


def follows_lun(bed: xr.Dataset) -> Finding:
    """R - Eq. (lun) at every inertia is as good as zero."""
    return agreement_in_proportion(bed, "Eq. (lun)")


def follows_k(cooling: xr.Dataset) -> Finding:
    """R - Eq. (K) at every inertia is as good as zero."""
    return agreement_in_proportion(cooling, "Eq. (K)")


STATEMENTS = (
    Statement(
        "vibrated_inertia_follows_lun",
        "Both of these processes depend only on beta and q but not on r [q is the dimensionless "
        "moment of inertia]",
        ("vibrated_inertia",),
        follows_lun,
    ),
    Statement(
        "cooling_inertia_follows_k",
        "q is the dimensionless moment of inertia; q=1/2 for disks, and q=2/5 for spheres [a "
        "parameter of Eq. (K)]",
        ("cooling_inertia",),
        follows_k,
    ),
)
