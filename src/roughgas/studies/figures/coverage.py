"""The figure of how often stated intervals hold the truth."""

from collections.abc import Sequence
from typing import Any

import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from roughgas.show.style import FAINT, GREY, LOOKS
from roughgas.studies.tables import in_order
from roughgas.tasks import along, label

LEGAL = (0.92, 0.98)
"""What share of the 95 % intervals has to hold the truth."""

WIDTH = 7.4  # inches
COLOURS = {"vibrated": LOOKS[0], "sheared": LOOKS[1], "cooling": LOOKS[2]}
BARS = {"ls": "none", "capsize": 1.5, "elinewidth": 0.8, "mew": 0.9}
SHIFT = 0.17  # of the two ways off their corner's row


def draw_figure(data: xr.Dataset) -> Figure:
    """Return coverage at each corner, of intervals at 68 and 95 %, from group `coverage`."""
    corners = along(in_order(data), "corner")
    rows = len(corners)
    figure = Figure(figsize=(WIDTH, 1.2 + 0.3 * rows), layout="constrained")
    left, right = figure.subplots(1, 2, sharey=True)
    for axes, level in ((left, 0.68), (right, 0.95)):
        _panel(axes, corners, level)
        axes.tick_params(axis="y", which="both", left=False, right=False)
    right.axvspan(*LEGAL, color=FAINT, alpha=0.15, lw=0)
    left.set_yticks(range(rows), map(label, corners))
    left.set_ylim(rows - 0.5, -0.5)
    for way, fill in zip(data.way.values, (GREY, "white"), strict=True):
        left.plot([], [], "o", color=GREY, mfc=fill, label=str(way))
    figure.legend(loc="outside upper center", ncols=2)
    figure.supxlabel("share of intervals that hold the truth", fontsize="medium")
    return figure


def _panel(axes: Axes, corners: Sequence[xr.Dataset], level: float) -> None:
    """Draw coverage of the intervals at `level`, a row a corner: of one run, of seeds pooled."""
    axes.axvline(level, color=GREY, lw=0.8, ls="--", zorder=0)
    for row, corner in enumerate(one.sel(level=level) for one in corners):
        look = COLOURS.get(str(corner.experiment.values), LOOKS[3])
        about: dict[str, Any] = BARS | {"color": look.colour, "marker": look.marker}
        for way, (shift, fill) in enumerate(((-SHIFT, look.colour), (SHIFT, "white"))):
            share, stderr = corner.coverage[way], corner.coverage_stderr[way]
            axes.errorbar(share, row + shift, xerr=stderr, mfc=fill, **about)
    axes.set_xlabel(f"{100 * level:.0f} % intervals")
