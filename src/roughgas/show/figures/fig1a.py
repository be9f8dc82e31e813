"""Fig. 1a of McNamara & Luding (1998): the vibrated bed for several r, against Lun's formula."""

import xarray as xr
from matplotlib.figure import Figure

from roughgas.show.figures.panel import ANY_R, HALF, averages_of, content_for_each_r, ratio_figure


def draw(bed: xr.Dataset) -> Figure:
    """Draw the figure from the reduced dataset of the vibrated bed."""
    message = "The mean of R(t) lies above Lun's formula"
    content = content_for_each_r("Vibrated bed", bed, theory=ANY_R, legend=HALF, message=message)
    return ratio_figure(content, averages=averages_of(bed))
