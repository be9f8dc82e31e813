"""Fig. 2b of McNamara & Luding (1998): the freely cooling gas for several r, against Eq. (K)."""

import xarray as xr
from matplotlib.figure import Figure

from roughgas.show.figures.panel import Part, ratio_figure, series_for_each


def draw(cooling: xr.Dataset) -> Figure:
    """Draw the figure from the reduced dataset of the cooling gas."""
    drawn = series_for_each(cooling, "r", "r")
    theories = "lines: theory, Eq. (K)"
    return ratio_figure(Part("Cooling gas", [cooling], drawn, theories=theories, loc="upper right"))
