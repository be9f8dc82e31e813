"""Fig. 1a of McNamara & Luding (1998): the vibrated bed for several r, against Eq. (lun)."""

import xarray as xr
from matplotlib.figure import Figure

from roughgas.show.figures import panel


def draw(bed: xr.Dataset) -> Figure:
    """The figure, from the reduced dataset of the vibrated bed."""
    figure, main, residual = panel.ratio_panel()
    drawn = panel.series_of_all_r(bed)
    panel.draw_series(main, residual, drawn)
    panel.draw_theory(main, bed, r=1.0)
    panel.frame_residuals(residual, drawn, drawn)
    panel.legend(main, drawn, "theory, Eq. (lun), any $r$", loc="upper left")
    panel.caption(main, [bed], "Vibrated bed")
    return figure
