"""Fig. 3: spheres in three dimensions, in all three scenes, beside theory.

McNamara & Luding (1998) leave this open: "simulations in D = 3 are still needed".
"""

import xarray as xr
from matplotlib.figure import Figure

from roughgas.show.figures.panel import ANY_R, content_for_each_r, ratio_figure


def draw(cooling: xr.Dataset, sheared: xr.Dataset, bed: xr.Dataset) -> Figure:
    """Draw the figure from the reduced datasets of the three scenes in space."""
    free = {"theories": "lines: theory of free cooling", "loc": "upper right"}
    return ratio_figure(
        content_for_each_r("Cooling spheres", cooling, **free),
        content_for_each_r("Sheared spheres", sheared, theory=ANY_R),
        content_for_each_r("Vibrated spheres", bed, theory=ANY_R),
        width=10.4,
        averaged=True,
    )
