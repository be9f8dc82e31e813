"""Spheres in three dimensions: whether the analytical expressions hold for them."""

import xarray as xr

from roughgas.claims import shear, vibration
from roughgas.claims.evidence import deviation
from roughgas.claims.finding import Finding, Statement, agreement

QUOTE = "simulations in D=3 are still needed to check the analytical expressions"


def follows_goldshtein(spheres: xr.Dataset) -> Finding:
    """R - Eq. (K) for D = 3, which is Eq. (Goldshtein), is as good as zero."""
    return agreement(deviation(spheres), "Eq. (Goldshtein)")


STATEMENTS = (
    Statement(
        "cooling_spheres_follow_goldshtein",
        f"{QUOTE} [Eq. (Goldshtein), of a cooling gas]",
        ("cooling_spheres",),
        follows_goldshtein,
    ),
    Statement(
        "sheared_spheres_follow_lun",
        f"{QUOTE} [Eq. (lun), of a sheared gas]",
        ("sheared_spheres",),
        shear.follows_lun,
    ),
    Statement(
        "vibrated_spheres_follow_lun",
        f"{QUOTE} [Eq. (lun), of a vibrated bed]",
        ("vibrated_spheres",),
        vibration.follows_lun,
    ),
)
