"""Disks of many sizes: the effect of spread radii in the bed of Fig. 1a and the gas of Fig. 2b."""

from collections.abc import Sequence

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from roughgas import plotting
from roughgas.plotting import FAINT, LINE_STYLES, THEORY, LineStyle, Style, key

SIZE = (7.0, 5.4)  # inches
EQUAL_RADII = 0.0
DRAWN = "R of disks whose radii are spread"


def draw(bed: xr.Dataset, cooling: xr.Dataset) -> Figure:
    """Draw the figure from the reduced datasets of polydisperse beds and cooling gases.

    Colours stand for r, symbols and lines for the deviation of the radii. Beneath: R minus R of
    equal disks, with lines for the same difference in theory; each gas has its own scale.
    """
    figure = Figure(figsize=SIZE, layout="constrained")
    above, beneath = figure.subplots(2, 2, sharex="col", height_ratios=(1.6, 1))
    values = sorted({*bed.r.values, *cooling.r.values}, reverse=True)
    colours = dict(zip(values, LINE_STYLES, strict=False))
    drawn = []
    message = plotting.judged_title(__file__, "sizes_change_nothing", [bed, cooling], DRAWN)
    for data, title, main, shift in zip(
        (bed, cooling), ("Vibrated bed", "Cooling gas"), above, beneath, strict=True
    ):
        main.axhline(0.5, color=FAINT, linewidth=0.8, linestyle=plotting.DOTS, zorder=0)
        drawn += [
            curve for r in data.r.values for curve in _draw_r(main, shift, data, r, colours[r])
        ]
        main.set_ylim(-0.03, 1.03)
        main.tick_params(labelbottom=False)
        plotting.BETA.prepare(shift)
        plotting.add_title(main, [data], title, message)
    above[0].set_ylabel(plotting.ENERGY_RATIO)
    beneath[0].set_ylabel("$R$ minus $R$ of\nequal disks")
    above[0].legend(handles=_legend_keys(colours, drawn), loc="upper left", title="lines: theory")
    figure.align_ylabels()
    return figure


def _draw_r(
    main: Axes, shift: Axes, data: xr.Dataset, r: float, colour: LineStyle
) -> list[plotting.Series]:
    """Draw R at one r, and its change by the deviation of the radii; return the series."""
    grid, equal = plotting.BETA.grid, data.sel(r=r, deviation=EQUAL_RADII)
    curves, theory_of_equal = [], np.full(grid.shape, np.nan)
    for deviation, form in zip(data.deviation.values, LINE_STYLES, strict=False):
        look = form._replace(colour=colour.colour)
        curve = plotting.series(data, f"{100 * deviation:g} %", look, r=r, deviation=deviation)
        curves.append(curve)
        line: Style = {"color": look.colour, "linestyle": look.line, "linewidth": 0.9, "zorder": 1}
        theory = np.broadcast_to(curve.predict(beta=grid), grid.shape)
        theory_of_equal = theory if deviation == EQUAL_RADII else theory_of_equal
        plotting.draw_points(main, curve, curve.x, curve.data.R.values)
        main.plot(grid, theory, **line)
        if deviation != EQUAL_RADII:
            reference = equal.sel(beta=curve.x)
            error = np.hypot(curve.data.R_stderr, reference.R_stderr)
            shifted = curve._replace(data=curve.data.assign(R_stderr=error))
            plotting.draw_points(shift, shifted, curve.x, (curve.data.R - reference.R).values)
            shift.plot(grid, theory - theory_of_equal, **line)
    return curves


def _legend_keys(colours: dict[float, LineStyle], drawn: Sequence[plotting.Series]) -> list:
    """Return the legend's keys of colours, symbols and lines, and of open symbols if there are
    any."""
    keys = [key(look.colour, f"$r = {r:g}$", "", "-", lw=4) for r, look in colours.items()]
    for label, look in {series.label: series.line_style for series in drawn}.items():
        keys.append(key(THEORY, f"standard deviation of radii {label}", look.marker, look.line))
    keys.append(key(FAINT, "equipartition", "", plotting.DOTS))
    return keys + plotting.keys_of_steadiness(drawn)
