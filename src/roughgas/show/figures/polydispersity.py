"""Disks of many sizes: what spread radii change in the bed of Fig. 1a and the gas of Fig. 2b.

The residuals are those from disks that are all alike, not from theory.
"""

import xarray as xr
from matplotlib.figure import Figure

from roughgas.show.figures import panel
from roughgas.show.style import LOOKS

ALIKE = 0.0
LEGEND = 1.6  # inches beside the panels
MESSAGES = "A bed does not feel a spread of sizes", "A cooling gas does, where R is steep"


def draw(bed: xr.Dataset, cooling: xr.Dataset) -> Figure:
    """Draw the figure from the reduced datasets of polydisperse beds and cooling gases.

    Colours stand for r, symbols for the deviation of the radii.
    """
    figure, panels = panel.ratio_panels([panel.BETA] * 2, panel.TWO_WIDE + LEGEND)
    both = (bed, "Vibrated bed", "upper left"), (cooling, "Cooling gas", "outside")
    series_of = [_series(data) for data, _, _ in both]
    every = [one for drawn in series_of for one in drawn]
    for one, drawn, (data, title, loc), message in zip(
        panels, series_of, both, MESSAGES, strict=True
    ):
        panel.draw_series(one, drawn)  # not apart: a step aside would take points off steep lines
        panel.draw_theory(one, drawn)
        panel.add_legend(one.main, drawn, title="lines: theory", loc=loc)
        panel.add_title(one.main, [data], title, message)
        panel.frame_rows(one, drawn, every, ["R"])
    figure.axes[len(panels)].set_ylabel("$R$ minus $R$ of\nequal disks")
    return figure


def _series(data: xr.Dataset) -> list[panel.Series]:
    drawn = []
    for r, colours in zip(sorted(data.r.values, reverse=True), LOOKS, strict=False):
        alike = data.R.sel(r=r, deviation=ALIKE)
        for deviation, markers in zip(data.deviation.values, LOOKS, strict=False):
            look = colours._replace(marker=markers.marker)
            label = f"$r = {r:g}$, radii ± {100 * deviation:g} %"
            one = panel.series(data, label, look, r=r, deviation=deviation)
            drawn.append(one._replace(theory=alike.sel(beta=one.at).values))
    return drawn
