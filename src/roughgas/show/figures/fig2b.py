"""Fig. 2b of McNamara & Luding (1998): the freely cooling gas for several r, against Eq. (K)."""

import xarray as xr
from matplotlib.figure import Figure

from roughgas.show.figures import panel


def draw(cooling: xr.Dataset) -> Figure:
    """The figure, from the reduced dataset of the cooling gas."""
    figure, main, residual = panel.ratio_panel()
    drawn = panel.series_of_all_r(cooling)
    panel.draw_series(main, residual, drawn)
    for r, one in zip(sorted(cooling.r.values, reverse=True), drawn, strict=True):
        panel.draw_theory(main, cooling, one.look, r=r)
    panel.frame_residuals(residual, drawn, drawn)
    panel.legend(main, drawn, "", title="lines: theory, Eq. (K)", loc="upper right")
    panel.caption(main, [cooling], "Cooling gas")
    return figure
