"""The moment of inertia, from a ring (q = 1) towards a point mass in the centre (q = 0)."""

import xarray as xr
from matplotlib.figure import Figure

from roughgas.plotting import (
    INERTIA,
    TWO_WIDE,
    Style,
    content_for_each_beta,
    judged_title,
    ratio_figure,
)

BED, COOLING = "R of a bed over its disks' inertia", "R of a cooling gas over its disks' inertia"
"""Titles where the statements fail."""


def draw(bed: xr.Dataset, cooling: xr.Dataset) -> Figure:
    """Draw the figure from the reduced datasets of disks with several moments of inertia."""
    style: Style = {"legend": {"loc": "upper right", "ncols": 2}, "axis": INERTIA}
    driven: Style = {
        "message": judged_title(__file__, "vibrated_inertia_follows_lun", [bed], BED),
        "theories": "lines: Lun's formula",
    }
    free: Style = {
        "message": judged_title(__file__, "cooling_inertia_follows_k", [cooling], COOLING),
        "theories": "lines: theory of free cooling",
    }
    return ratio_figure(
        content_for_each_beta("Vibrated bed", bed, **driven, **style),
        content_for_each_beta("Cooling gas", cooling, **free, **style),
        width=TWO_WIDE,
    )
