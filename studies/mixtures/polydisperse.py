"""Disks of many sizes: what spread radii change in the bed of Fig. 1a and the gas of Fig. 2b."""

from collections.abc import Sequence

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from roughgas import plotting
from roughgas.plotting import FAINT, LOOKS, THEORY, Look, Style, key

SIZE = (7.0, 5.4)  # inches
ALIKE = 0.0
MESSAGES = "A bed hardly feels a spread of sizes", "A cooling gas does, where R is steep"


def draw(bed: xr.Dataset, cooling: xr.Dataset) -> Figure:
    """Draw the figure from the reduced datasets of polydisperse beds and cooling gases.

    Colours stand for r, symbols and lines for the deviation of the radii. Beneath: R minus R of
    disks that are all alike, lines: the same of theory; each gas has a scale of its own.
    """
    figure = Figure(figsize=SIZE, layout="constrained")
    above, beneath = figure.subplots(2, 2, sharex="col", height_ratios=(1.6, 1))
    values = sorted({*bed.r.values, *cooling.r.values}, reverse=True)
    colours = dict(zip(values, LOOKS, strict=False))
    drawn = []
    for data, title, message, main, shift in zip(
        (bed, cooling), ("Vibrated bed", "Cooling gas"), MESSAGES, above, beneath, strict=True
    ):
        main.axhline(0.5, color=FAINT, linewidth=0.8, linestyle=plotting.DOTS, zorder=0)
        drawn += [one for r in data.r.values for one in _draw_r(main, shift, data, r, colours[r])]
        main.set_ylim(-0.03, 1.03)
        main.tick_params(labelbottom=False)
        plotting.BETA.prepare(shift)
        plotting.add_title(main, [data], title, message)
    above[0].set_ylabel(plotting.ENERGY_RATIO)
    beneath[0].set_ylabel("$R$ minus $R$ of\nequal disks")
    above[0].legend(handles=_keys(colours, drawn), loc="upper left", title="lines: theory")
    figure.align_ylabels()
    return figure


def _draw_r(
    main: Axes, shift: Axes, data: xr.Dataset, r: float, colour: Look
) -> list[plotting.Series]:
    """Draw R at one r, and what the deviation of the radii changes; return the series."""
    grid, equal = plotting.BETA.grid, data.sel(r=r, deviation=ALIKE)
    every, of_equal = [], np.full(grid.shape, np.nan)
    for deviation, form in zip(data.deviation.values, LOOKS, strict=False):
        look = form._replace(colour=colour.colour)
        one = plotting.series(data, f"{100 * deviation:g} %", look, r=r, deviation=deviation)
        every.append(one)
        line: Style = {"color": look.colour, "linestyle": look.line, "linewidth": 0.9, "zorder": 1}
        theory = np.broadcast_to(one.predict(beta=grid), grid.shape)
        of_equal = theory if deviation == ALIKE else of_equal
        plotting.draw_points(main, one, one.at, one.data.R.values)
        main.plot(grid, theory, **line)
        if deviation != ALIKE:
            alike = equal.sel(beta=one.at)
            error = np.hypot(one.data.R_stderr, alike.R_stderr)
            apart = one._replace(data=one.data.assign(R_stderr=error))
            plotting.draw_points(shift, apart, one.at, (one.data.R - alike.R).values)
            shift.plot(grid, theory - of_equal, **line)
    return every


def _keys(colours: dict[float, Look], drawn: Sequence[plotting.Series]) -> list:
    """Return what colours, symbols and lines are, and open symbols if there are any."""
    keys = [key(look.colour, f"$r = {r:g}$", "s") for r, look in colours.items()]
    for label, look in {one.label: one.look for one in drawn}.items():
        keys.append(key(THEORY, f"standard deviation of radii {label}", look.marker, look.line))
    return keys + plotting.keys_of_steadiness(drawn)
