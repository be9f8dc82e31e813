"""Fig. 1a of McNamara & Luding (1998): the vibrated bed for several r, against Eq. (lun)."""

import xarray as xr
from matplotlib.figure import Figure

from roughgas.show.figures.panel import Part, ratio_figure, series_for_each


def draw(bed: xr.Dataset) -> Figure:
    """Draw the figure from the reduced dataset of the vibrated bed."""
    drawn = series_for_each(bed, "r", "r")
    return ratio_figure(Part("Vibrated bed", [bed], drawn, theory="theory, Eq. (lun), any $r$"))
