"""Spheres in three dimensions, in all three scenes, beside theory.

McNamara & Luding (1998) leave this open: "simulations in D = 3 are still needed".
"""

import xarray as xr
from matplotlib.figure import Figure

from roughgas.plotting import ANY_R, TWO_WIDE, content_for_each_r, ratio_figure

COOLING, SHEARED = "Cooling: as theory says", "Shear: r hardly matters"
BED = "Bed: above the formula"


def draw(cooling: xr.Dataset, sheared: xr.Dataset, bed: xr.Dataset) -> Figure:
    """Draw the figure from the reduced datasets of the three scenes in space."""
    free = {"theories": "lines: theory", "legend": {"loc": "upper right"}}
    driven = {"theory": ANY_R}
    return ratio_figure(
        content_for_each_r("Cooling spheres", cooling, message=COOLING, **free),
        content_for_each_r("Sheared spheres", sheared, message=SHEARED, **driven),
        content_for_each_r("Vibrated spheres", bed, message=BED, **driven),
        width=TWO_WIDE,
    )
