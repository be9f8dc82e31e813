"""Disks of many sizes: what spread radii change in the bed of Fig. 1a and the gas of Fig. 2b.

The residuals are those from disks that are all alike, not from theory.
"""

import xarray as xr
from matplotlib.figure import Figure

from roughgas.show.figures.panel import TWO_WIDE, PanelContent, ratio_figure, series
from roughgas.show.style import LOOKS

ALIKE = 0.0
LEGEND = 1.6  # inches beside the panels
MESSAGES = "A bed does not feel a spread of sizes", "A cooling gas does, where R is steep"


def draw(bed: xr.Dataset, cooling: xr.Dataset) -> Figure:
    """Draw the figure from the reduced datasets of polydisperse beds and cooling gases.

    Colours stand for r, symbols for the deviation of the radii.
    """
    parts = (
        _content("Vibrated bed", bed, message=MESSAGES[0], loc="upper left"),
        _content("Cooling gas", cooling, message=MESSAGES[1], loc="outside"),
    )
    figure = ratio_figure(*parts, width=TWO_WIDE + LEGEND)
    figure.axes[len(parts)].set_ylabel("$R$ minus $R$ of\nequal disks")
    return figure


def _content(name: str, data: xr.Dataset, **how: str) -> PanelContent:
    drawn = []
    for r, colours in zip(sorted(data.r.values, reverse=True), LOOKS, strict=False):
        alike = data.R.sel(r=r, deviation=ALIKE)
        for deviation, markers in zip(data.deviation.values, LOOKS, strict=False):
            look = colours._replace(marker=markers.marker)
            label = f"$r = {r:g}$, radii ± {100 * deviation:g} %"
            one = series(data, label, look, r=r, deviation=deviation)
            drawn.append(one._replace(theory=alike.sel(beta=one.at).values))
    return PanelContent(name, [data], drawn, theories="lines: theory", **how)
