"""The moment of inertia, from a ring (q = 1) towards a point mass in the centre (q = 0)."""

import xarray as xr
from matplotlib.figure import Figure

from roughgas.plotting import INERTIA, TWO_WIDE, Style, content_for_each_beta, ratio_figure

BED: Style = {
    "message": "A bed departs from theory at both ends",
    "theories": "lines: Lun's formula",
}
COOLING: Style = {
    "message": "A cooling gas follows theory at any q",
    "theories": "lines: theory of free cooling",
}


def draw(bed: xr.Dataset, cooling: xr.Dataset) -> Figure:
    """Draw the figure from the reduced datasets of disks with several moments of inertia."""
    how: Style = {"legend": {"loc": "upper right", "ncols": 2}, "axis": INERTIA}
    return ratio_figure(
        content_for_each_beta("Vibrated bed", bed, **BED, **how),
        content_for_each_beta("Cooling gas", cooling, **COOLING, **how),
        width=TWO_WIDE,
    )
