"""Fig. 2a of McNamara & Luding (1998): the sheared gas for several r, against Lun's formula."""

from collections.abc import Sequence
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from roughgas.show.figures.panel import ANY_R, WIDE, Series, content_for_each_r, ratio_figure
from roughgas.show.style import GREY

MESSAGE = "R follows Lun's formula, once the mean flow is removed"
FAINT: dict[str, Any] = {"alpha": 0.5, "markersize": 2.6, "markeredgewidth": 0, "zorder": 0}
POINTED_AT = 0.3
"""The beta of a faint point, from which a line leads to what these are."""


def draw(sheared: xr.Dataset) -> Figure:
    """Draw the figure from the reduced dataset of the sheared gas."""
    how = {"theory": ANY_R, "extra": _draw_unsubtracted, "loc": "half", "message": MESSAGE}
    content = content_for_each_r("Sheared gas", sheared, **how)
    return ratio_figure(content, width=WIDE, averaged=True)


def _draw_unsubtracted(main: Axes, drawn: Sequence[Series]) -> None:
    """Draw R with mean flow and mean spin left in, small and faint, since it is not the result."""
    if "R_unsubtracted" not in drawn[0].data:
        return
    for one in drawn:
        ratio = one.data.R_unsubtracted.values
        main.plot(one.at, ratio, one.look.marker, color=one.look.colour, **FAINT)
    first = drawn[0]
    nearest = int(np.argmin(abs(first.at - POINTED_AT)))
    at = first.at[nearest], first.data.R_unsubtracted.values[nearest]
    arrow = {"arrowstyle": "-", "color": GREY, "linewidth": 0.6, "shrinkB": 3}
    place: dict[str, Any] = {
        "xytext": (6, 12),
        "textcoords": "offset points",
        "ha": "center",
        "va": "bottom",
    }
    text = "faint: mean flow and\nmean spin left in"
    main.annotate(text, at, fontsize=7, color=GREY, arrowprops=arrow, **place)
