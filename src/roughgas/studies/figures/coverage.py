"""The figure of how often stated intervals hold the truth."""

from pathlib import Path

import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from roughgas.show.style import FAINT, GREY, LOOKS
from roughgas.studies.accuracy.files import read_study
from roughgas.studies.accuracy.tables import in_order, label

LEGAL = (0.92, 0.98)
"""What share of the 95 % intervals has to hold the truth."""

WIDTH = 7.4  # inches
COLOURS = {"vibrated": LOOKS[0], "sheared": LOOKS[1], "cooling": LOOKS[2]}
SHIFT = 0.17  # of the two ways off their corner's row


def draw(path: str | Path) -> Figure:
    """The figure, from the combined dataset of the study at `path`."""
    return draw_figure(read_study(path, "coverage"))


def draw_figure(data: xr.Dataset) -> Figure:
    """Coverage at each corner, of intervals at 68 and 95 %, from group `coverage`."""
    data = in_order(data)
    rows = data.sizes["corner"]
    figure = Figure(figsize=(WIDTH, 1.2 + 0.3 * rows), layout="constrained")
    left, right = figure.subplots(1, 2, sharey=True)
    for axes, level in ((left, 0.68), (right, 0.95)):
        _panel(axes, data, level)
        axes.tick_params(axis="y", which="both", left=False, right=False)
    right.axvspan(*LEGAL, color=FAINT, alpha=0.15, lw=0)
    left.set_yticks(range(rows), [label(data, k) for k in range(rows)])
    left.set_ylim(rows - 0.5, -0.5)
    for way, fill in zip(data.way.values, (GREY, "white"), strict=True):
        left.plot([], [], "o", color=GREY, mfc=fill, label=str(way))
    figure.legend(loc="outside upper center", ncols=2)
    figure.supxlabel("share of intervals that hold the truth", fontsize="medium")
    return figure


def _panel(axes: Axes, data: xr.Dataset, level: float) -> None:
    """Coverage of the intervals at `level`, one row a corner: of one run, and of seeds pooled."""
    axes.axvline(level, color=GREY, lw=0.8, ls="--", zorder=0)
    for row in range(data.sizes["corner"]):
        corner = data.isel(corner=row).sel(level=level)
        look = COLOURS.get(str(corner.experiment.values), LOOKS[3])
        for way, (shift, fill) in enumerate(((-SHIFT, look.colour), (SHIFT, "white"))):
            axes.errorbar(
                *(corner.coverage[way], row + shift),
                xerr=corner.coverage_stderr[way],
                **{"color": look.colour, "marker": look.marker, "mfc": fill, "ls": "none"},
                **{"capsize": 1.5, "elinewidth": 0.8, "mew": 0.9},
            )
    axes.set_xlabel(f"{100 * level:.0f} % intervals")
