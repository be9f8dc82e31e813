"""The moment of inertia, from a ring (q = 1) towards a point mass in the centre (q = 0)."""

from typing import Any

import xarray as xr
from matplotlib.figure import Figure

from roughgas.plotting import INERTIA, TWO_WIDE, content_for_each_beta, ratio_figure

BED: dict[str, Any] = {
    "message": "A bed departs from theory at both ends",
    "theories": "lines: Lun's formula",
}
COOLING: dict[str, Any] = {
    "message": "A cooling gas follows theory at any q",
    "theories": "lines: theory of free cooling",
}


def draw(bed: xr.Dataset, cooling: xr.Dataset) -> Figure:
    """Draw the figure from the reduced datasets of disks with several moments of inertia."""
    how: dict[str, Any] = {"legend": {"loc": "upper right", "ncols": 2}, "axis": INERTIA}
    return ratio_figure(
        content_for_each_beta("Vibrated bed", bed, **BED, **how),
        content_for_each_beta("Cooling gas", cooling, **COOLING, **how),
        width=TWO_WIDE,
    )
