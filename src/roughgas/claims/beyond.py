"""Statements that need experiments other than those of the paper's figures."""

import xarray as xr

from roughgas.claims.evidence import deviation, difference
from roughgas.claims.finding import Finding, Statement, agreement


def spheres_follow_goldshtein(spheres: xr.Dataset) -> Finding:
    """R of cooling spheres - Eq. (K) for D = 3, which is Eq. (Goldshtein), is as good as zero."""
    return agreement(deviation(spheres), "Eq. (Goldshtein)")


def wave_form_changes_nothing(sine: xr.Dataset, bed: xr.Dataset) -> Finding:
    """R over a floor that moves as a sine - R over the sawtooth is as good as zero."""
    return agreement(difference(sine, bed), "R over the sawtooth")


STATEMENTS = (
    Statement(
        "wave_form_changes_nothing",
        "changing the wave form does not significantly change R",
        ("vibrated_sine", "vibrated"),
        wave_form_changes_nothing,
    ),
    Statement(
        "spheres_follow_goldshtein",
        "simulations in D=3 are still needed to check the analytical expressions",
        ("cooling_spheres",),
        spheres_follow_goldshtein,
    ),
)
