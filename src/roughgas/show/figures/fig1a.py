"""Fig. 1a of McNamara & Luding (1998): the vibrated bed for several r, against Lun's formula."""

import xarray as xr
from matplotlib.figure import Figure

from roughgas.show.figures.panel import ANY_R, WIDE, content_for_each_r, ratio_figure


def draw(bed: xr.Dataset) -> Figure:
    """Draw the figure from the reduced dataset of the vibrated bed."""
    message = "Averaged over collisions, R follows Lun's formula"
    content = content_for_each_r("Vibrated bed", bed, theory=ANY_R, loc="half", message=message)
    return ratio_figure(content, width=WIDE, averaged=True)
