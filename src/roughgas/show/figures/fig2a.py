"""Fig. 2a of McNamara & Luding (1998): the sheared gas for several r, against Eq. (lun)."""

import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from roughgas.show.figures import panel
from roughgas.show.style import GREY, LOOKS


def draw(sheared: xr.Dataset) -> Figure:
    """The figure, from the reduced dataset of the sheared gas."""
    figure, main, residual = panel.ratio_panel()
    drawn = panel.series_of_all_r(sheared)
    panel.draw_series(main, residual, drawn)
    panel.draw_theory(main, sheared, r=1.0)
    _draw_unsubtracted(main, sheared)
    panel.frame_residuals(residual, drawn, drawn)
    panel.legend(main, drawn, "theory, Eq. (lun), any $r$", loc="upper left")
    panel.caption(main, [sheared], "Sheared gas")
    return figure


def _draw_unsubtracted(main: Axes, sheared: xr.Dataset) -> None:
    """R with the mean flow and the mean spin left in: small and faint, as it is not the result."""
    if "R_unsubtracted" not in sheared:
        return
    style = {"alpha": 0.5, "markersize": 2.6, "markeredgewidth": 0, "zorder": 0}
    for r, look in zip(sorted(sheared.r.values, reverse=True), LOOKS, strict=False):
        ratio = sheared.R_unsubtracted.sel(r=r).values
        main.plot(sheared.beta, ratio, look.marker, color=look.colour, **style)
    main.plot([], [], "o", color=GREY, label="small: mean flow and spin not removed", **style)
