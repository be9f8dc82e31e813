"""Fig. 2b of McNamara & Luding (1998): the freely cooling gas for several r, beside its theory."""

import xarray as xr
from matplotlib.figure import Figure

from roughgas.show.figures.panel import content_for_each_r, ratio_figure

MESSAGE = "R depends on r, as the theory of free cooling says"


def draw(cooling: xr.Dataset) -> Figure:
    """Draw the figure from the reduced dataset of the cooling gas."""
    how = {
        "theories": "lines: theory of free cooling",
        "legend": {"loc": "upper right", "ncols": 2},
        "message": MESSAGE,
    }
    return ratio_figure(content_for_each_r("Cooling gas", cooling, **how))
