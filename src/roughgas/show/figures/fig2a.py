"""Fig. 2a of McNamara & Luding (1998): the sheared gas for several r, against Lun's formula."""

from collections.abc import Sequence
from typing import Any

import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from roughgas.show.figures.panel import ANY_R, HALF, Series, content_for_each_r, ratio_figure
from roughgas.show.style import GREY

MESSAGE = "Without its mean flow, R is near Lun's formula"
FAINT: dict[str, Any] = {"alpha": 0.5, "markersize": 2.6, "markeredgewidth": 0, "zorder": 0}


def draw(sheared: xr.Dataset) -> Figure:
    """Draw the figure from the reduced dataset of the sheared gas."""
    how = {
        "theory": ANY_R,
        "extra": _draw_unsubtracted,
        "room": 0.1,
        "legend": HALF,
        "message": MESSAGE,
    }
    content = content_for_each_r("Sheared gas", sheared, **how)
    return ratio_figure(content)


def _draw_unsubtracted(main: Axes, drawn: Sequence[Series]) -> None:
    """Draw R with mean flow and mean spin left in, small and faint, since it is not the result."""
    if "R_unsubtracted" not in drawn[0].data:
        return
    for one in drawn:
        ratio = one.data.R_unsubtracted.values
        main.plot(one.at, ratio, one.look.marker, color=one.look.colour, **FAINT)
    text = "small, faint: mean flow and mean spin left in"
    main.text(0.98, 0.03, text, transform=main.transAxes, fontsize=7.5, color=GREY, ha="right")
