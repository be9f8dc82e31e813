"""Figure of coverage: shares of intervals that hold the truth."""

from collections.abc import Sequence

import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from roughgas.show.style import FAINT, GREY, LINE_STYLES, TWO_WIDE, Style
from roughgas.tasks import point_title, slices_along

from .corners import in_order

ACCEPTED_COVERAGE = (0.92, 0.98)
"""Range of the share of 95 % intervals that hold the truth."""
COLOURS = {"vibrated": LINE_STYLES[0], "sheared": LINE_STYLES[1], "cooling": LINE_STYLES[2]}
CORNER_BARS: Style = {"ls": "none", "capsize": 1.5, "elinewidth": 0.8, "mew": 0.9}
SHIFT = 0.17  # of the two kinds of intervals, off their corner's row


def draw(data: xr.Dataset) -> Figure:
    """Draw the coverage at each corner, of intervals at 68 and 95 %."""
    corners = slices_along(in_order(data), "corner")
    rows = len(corners)
    figure = Figure(figsize=(TWO_WIDE, 1.2 + 0.3 * rows), layout="constrained")
    left, right = figure.subplots(1, 2, sharey=True)
    for axes, level in ((left, 0.68), (right, 0.95)):
        _draw_corners(axes, corners, level)
        axes.tick_params(axis="y", which="both", left=False, right=False)
    right.axvspan(*ACCEPTED_COVERAGE, color=FAINT, alpha=0.15, lw=0, label="accepted")
    left.set_yticks(range(rows), map(point_title, corners), fontsize=8)
    left.set_ylim(rows - 0.5, -0.5)
    for way, fill in zip(data.way.values, (GREY, "white"), strict=True):
        left.plot([], [], "o", color=GREY, mfc=fill, label=str(way))
    left.plot([], [], color=GREY, lw=0.8, ls="--", label="nominal")
    figure.legend(loc="outside upper center", ncols=4)
    figure.supxlabel("share of intervals that hold the truth", fontsize="medium")
    return figure


def _draw_corners(axes: Axes, corners: Sequence[xr.Dataset], level: float) -> None:
    """Draw the coverage of intervals at `level`, one row per corner: of one run, of seeds
    pooled."""
    axes.axvline(level, color=GREY, lw=0.8, ls="--", zorder=0)
    for row, corner in enumerate(data.sel(level=level) for data in corners):
        look = COLOURS.get(str(corner.experiment.values), LINE_STYLES[3])
        style: Style = CORNER_BARS | {"color": look.colour, "marker": look.marker}
        for way, (shift, fill) in enumerate(((-SHIFT, look.colour), (SHIFT, "white"))):
            share, stderr = corner.coverage[way], corner.coverage_stderr[way]
            axes.errorbar(share, row + shift, xerr=stderr, mfc=fill, **style)
    axes.set_xlabel(f"{100 * level:.0f} % intervals")
